// Figures as lines and shapes, for pictures and videos.  The page has its own, richer drawings
// (models/player/page/figure.js and head.js); angles and action units mean the same in both.  A
// private header of models/player.
#ifndef GESTUS_MODELS_PLAYER_DRAWING_H_
#define GESTUS_MODELS_PLAYER_DRAWING_H_

#include <span>
#include <vector>

#include "models/outputs/motion.h"

namespace gestus::player {

/// x to the right, y down.
struct Vec2 {
  double x = 0, y = 0;
};

enum class Ink { kBody, kRight, kLeft, kTorso, kSkin, kBrow, kCheek, kEye, kPupil };

struct Shape {
  enum class Kind { kLine, kArea, kDisc };
  Kind kind = Kind::kLine;
  Ink ink = Ink::kBody;
  std::vector<Vec2> points;  ///< kDisc: its centre
  double width = 0;          ///< kLine: of the stroke; kDisc: radius
  double opacity = 1;
};

/// Later shapes lie upon earlier ones.
using Drawing = std::vector<Shape>;

/// A body and its face at a time in seconds, between frames interpolated.  The unit is a shoulder
/// (neck to right shoulder), the neck is at 0.
class BodyDrawing {
 public:
  /// `motion` has a body and must outlive this.
  explicit BodyDrawing(const outputs::Motion& motion);

  /// `trail` seconds of the path that each wrist has come are drawn too.
  Drawing At(double time, double trail) const;

  struct Extent {
    double left = 0, top = 0, right = 0, bottom = 0;
  };
  /// What holds the figure in all frames but the wildest.
  Extent extent() const;

 private:
  std::vector<Vec2> PointsAt(const std::vector<float>& values, std::size_t count,
                             double time) const;
  void AddTorso(const std::vector<Vec2>& points, Drawing* out) const;
  void AddHead(const std::vector<Vec2>& points, double time, Drawing* out) const;
  void AddFace(double time, Drawing* out) const;
  std::int64_t Find(const char* name) const;

  const outputs::Motion& motion_;
  std::vector<float> body_, face_;  // finite, the neck at 0
  double unit_ = 1;
};

/// A schematic face that action units move and head angles turn, at 0; 1 is half its height.
Drawing HeadAt(const outputs::Motion& motion, double time);

/// A smooth line through `points`, `pieces` to each stretch.
std::vector<Vec2> Smooth(std::span<const Vec2> points, int pieces, bool closed = false);

/// A motion in a box: moved and enlarged alike.
struct Placement {
  double scale = 1, x = 0, y = 0;
  Vec2 operator()(Vec2 p) const { return {x + scale * p.x, y + scale * p.y}; }
};

/// A motion as it is drawn: its body, or else the head that its curves move.
class TakeDrawing {
 public:
  explicit TakeDrawing(const outputs::Motion& motion);
  Drawing At(double time, double trail) const;
  BodyDrawing::Extent extent() const;

 private:
  const outputs::Motion& motion_;
  std::vector<BodyDrawing> body_;  // one or none
};

/// Where to put drawings that need `extent` so that they fill the box in the middle.
Placement Fit(const BodyDrawing::Extent& extent, double x, double y, double width, double height);
BodyDrawing::Extent Join(const BodyDrawing::Extent& a, const BodyDrawing::Extent& b);

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_DRAWING_H_
