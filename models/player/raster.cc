// A pixel's cover is taken from the distance of its middle to the edge of a shape: half a pixel
// inside it is covered whole, half a pixel outside not at all.
#include "models/player/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/player/letters.h"

namespace gestus::player {
namespace {

/// The square of the distance from `p` to the line from `a` to `b`.
double Squared(Vec2 p, Vec2 a, Vec2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
  const double along =
      squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0;
  const double x = p.x - a.x - along * dx, y = p.y - a.y - along * dy;
  return x * x + y * y;
}

bool AllFinite(std::span<const Vec2> points) {
  return std::all_of(points.begin(), points.end(),
                     [](Vec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); });
}

float Cover(double inside) { return static_cast<float>(std::clamp(inside + 0.5, 0.0, 1.0)); }

constexpr double kAdvance = 0.85, kLetter = 0.6;  // of the height

}  // namespace

Raster::Raster(int width, int height, Colour ground) : width_(width), height_(height) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  pixels_.resize(3 * pixels);
  cover_.resize(pixels);
  Clear(ground);
}

void Raster::Clear(Colour colour) {
  for (std::size_t i = 0; i < pixels_.size(); i += 3) {
    pixels_[i] = colour.r;
    pixels_[i + 1] = colour.g;
    pixels_[i + 2] = colour.b;
  }
}

Colour Raster::at(int x, int y) const {
  const std::size_t i = 3 * static_cast<std::size_t>(y * width_ + x);
  return {pixels_[i], pixels_[i + 1], pixels_[i + 2]};
}

/// The pixels that a shape within `reach` of `points` may touch, and their cover set to 0.
Raster::Box Raster::Around(std::span<const Vec2> points, double reach) const {
  double left = width_, top = height_, right = 0, bottom = 0;
  for (const Vec2 p : points) {
    left = std::min(left, p.x - reach - 1);
    right = std::max(right, p.x + reach + 1);
    top = std::min(top, p.y - reach - 1);
    bottom = std::max(bottom, p.y + reach + 1);
  }
  const auto within = [](double value, int most) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  return {within(std::floor(left), width_), within(std::floor(top), height_),
          within(std::ceil(right), width_), within(std::ceil(bottom), height_)};
}

void Raster::Blend(const Box& box, Colour colour, double opacity) {
  const float most = static_cast<float>(std::clamp(opacity, 0.0, 1.0));
  const float parts[3] = {static_cast<float>(colour.r), static_cast<float>(colour.g),
                          static_cast<float>(colour.b)};
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const auto i = static_cast<std::size_t>(y * width_ + x);
      const float share = most * cover_[i];
      cover_[i] = 0;
      for (std::size_t part = 0; share > 0 && part < 3; ++part) {
        const float old = pixels_[3 * i + part];
        pixels_[3 * i + part] =
            static_cast<std::uint8_t>(std::lround(old + share * (parts[part] - old)));
      }
    }
  }
}

void Raster::Line(std::span<const Vec2> points, double width, Colour colour, double opacity) {
  if (points.empty() || !AllFinite(points)) return;
  const double radius = width / 2;
  for (std::size_t i = 0; i + 1 < std::max<std::size_t>(points.size(), 2); ++i) {
    const Vec2 ends[2] = {points[i], points[std::min(i + 1, points.size() - 1)]};
    const Box box = Around(ends, radius);
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) {
        float& cover = cover_[static_cast<std::size_t>(y * width_ + x)];
        if (cover < 1)
          cover = std::max(
              cover, Cover(radius - std::sqrt(Squared({x + 0.5, y + 0.5}, ends[0], ends[1]))));
      }
    }
  }
  Blend(Around(points, radius), colour, opacity);
}

void Raster::Area(std::span<const Vec2> corners, Colour colour, double opacity) {
  if (corners.size() < 3 || !AllFinite(corners)) return;
  const Box box = Around(corners, 0);
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const Vec2 p = {x + 0.5, y + 0.5};
      double edge = std::numeric_limits<double>::max();
      bool inside = false;
      for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
        const Vec2 a = corners[i], b = corners[j];
        edge = std::min(edge, Squared(p, a, b));
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
          inside = !inside;
      }
      cover_[static_cast<std::size_t>(y * width_ + x)] =
          Cover(inside ? std::sqrt(edge) : -std::sqrt(edge));
    }
  }
  Blend(box, colour, opacity);
}

void Raster::Disc(Vec2 centre, double radius, Colour colour, double opacity) {
  const Vec2 twice[2] = {centre, centre};
  Line(twice, 2 * radius, colour, opacity);
}

double Raster::Text(Vec2 at, double height, std::string_view text, Colour colour) {
  const double begin = at.x;
  for (const char c : text) {
    for (const std::vector<Vec2>& stroke : StrokesOf(c)) {
      std::vector<Vec2> points;
      for (const Vec2 p : stroke)
        points.push_back({at.x + p.x * height * kLetter, at.y - height + p.y * height});
      Line(points, height * 0.13, colour);
    }
    at.x += kAdvance * height;
  }
  return at.x - begin;
}

double TextWidth(double height, std::string_view text) {
  return kAdvance * height * static_cast<double>(text.size());
}

}  // namespace gestus::player
