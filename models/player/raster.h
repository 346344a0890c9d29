// Pictures of pixels: lines, areas and discs with smooth edges, and plain capital letters.  A
// private header of models/player.
#ifndef GESTUS_MODELS_PLAYER_RASTER_H_
#define GESTUS_MODELS_PLAYER_RASTER_H_

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "models/player/drawing.h"

namespace gestus::player {

struct Colour {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Colour&) const = default;
};

/// Every shape is laid over what is there in one go, so that a half transparent line that crosses
/// itself is no darker there.  What lies outside is left out; coordinates that are not finite draw
/// nothing.
class Raster {
 public:
  Raster(int width, int height, Colour ground);

  int width() const { return width_; }
  int height() const { return height_; }
  Colour at(int x, int y) const;
  /// (height, width, 3) bytes.
  std::span<const std::uint8_t> bytes() const { return pixels_; }

  void Clear(Colour colour);
  /// Round at its ends and corners.
  void Line(std::span<const Vec2> points, double width, Colour colour, double opacity = 1);
  /// Inside of a closed line, by the even-odd rule.
  void Area(std::span<const Vec2> corners, Colour colour, double opacity = 1);
  void Disc(Vec2 centre, double radius, Colour colour, double opacity = 1);
  /// Letters of English, digits and :.-/ between the base line at `at` and `height` above it; small
  /// letters are drawn as capitals.  Returns the width.
  double Text(Vec2 at, double height, std::string_view text, Colour colour);

 private:
  struct Box {
    int left, top, right, bottom;
  };
  Box Around(std::span<const Vec2> points, double reach) const;
  void Blend(const Box& box, Colour colour, double opacity);

  int width_, height_;
  std::vector<std::uint8_t> pixels_;
  std::vector<float> cover_;  // of the shape that is being drawn
};

/// Width of the text that Text() would draw.
double TextWidth(double height, std::string_view text);

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_RASTER_H_
