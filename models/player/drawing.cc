#include "models/player/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "models/player/quantise.h"

namespace gestus::player {
namespace {

using outputs::Figure;
using outputs::Motion;

constexpr double kShoulder = 167;  // of pose/normalize, where a figure has none
constexpr double kHeadRadius = 0.34;

Ink SideOf(const std::string& name) {
  if (name == "Neck" || name == "Nose" || name.ends_with("Eye") || name.ends_with("Shoulder"))
    return Ink::kBody;
  return name.starts_with("R") ? Ink::kRight : name.starts_with("L") ? Ink::kLeft : Ink::kBody;
}

bool OfHead(const std::string& name) { return name == "Nose" || name.ends_with("Eye"); }

double WidthOf(const std::string& name) {
  if (name.find("Hand") != std::string::npos && !name.ends_with("HandRoot")) return 0.035;
  return name.ends_with("HandRoot") ? 0.08 : name.ends_with("Wrist") ? 0.11 : 0.13;
}

Vec2 Middle(Vec2 a, Vec2 b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }

Shape Disc(Vec2 centre, double radius, Ink ink) {
  return {Shape::Kind::kDisc, ink, {centre}, radius, 1};
}

Shape Line(std::vector<Vec2> points, double width, Ink ink) {
  return {Shape::Kind::kLine, ink, std::move(points), width, 1};
}

/// An outlined area.
void AddOutlined(std::vector<Vec2> points, double width, Ink fill, Drawing* out) {
  out->push_back({Shape::Kind::kArea, fill, points, 0, 1});
  points.push_back(points.front());
  out->push_back(Line(std::move(points), width, Ink::kBody));
}

std::vector<Vec2> Ellipse(Vec2 centre, double rx, double ry, double angle, int corners) {
  std::vector<Vec2> points;
  for (int i = 0; i < corners; ++i) {
    const double at = 2 * 3.14159265358979 * i / corners;
    const double x = rx * std::cos(at), y = ry * std::sin(at);
    points.push_back({centre.x + x * std::cos(angle) - y * std::sin(angle),
                      centre.y + x * std::sin(angle) + y * std::cos(angle)});
  }
  return points;
}

double Percentile(std::vector<double>* values, double share) {
  if (values->empty()) return 0;
  const auto at = values->begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(values->size() - 1));
  std::nth_element(values->begin(), at, values->end());
  return *at;
}

}  // namespace

std::vector<Vec2> Smooth(std::span<const Vec2> points, int pieces, bool closed) {
  // Catmull-Rom: through every point, its direction that of its neighbours.
  const auto n = static_cast<std::int64_t>(points.size());
  if (n < 3) return {points.begin(), points.end()};
  const auto at = [&](std::int64_t i) {
    return points[static_cast<std::size_t>(closed ? (i + n) % n
                                                  : std::clamp<std::int64_t>(i, 0, n - 1))];
  };
  std::vector<Vec2> out;
  for (std::int64_t i = 0; i < (closed ? n : n - 1); ++i) {
    const Vec2 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    for (int piece = 0; piece < pieces; ++piece) {
      const double t = static_cast<double>(piece) / pieces;
      const auto blend = [t](double p, double q, double r, double s) {
        return q + t / 2 * (r - p + t * (2 * p - 5 * q + 4 * r - s + t * (3 * (q - r) + s - p)));
      };
      out.push_back({blend(a.x, b.x, c.x, d.x), blend(a.y, b.y, c.y, d.y)});
    }
  }
  if (!closed) out.push_back(points.back());
  return out;
}

BodyDrawing::BodyDrawing(const Motion& motion) : motion_(motion) {
  body_ = DrawnValues(*motion.body, true);
  if (motion.face) face_ = DrawnValues(*motion.face, false);
  unit_ = kShoulder;
  const std::int64_t shoulder = Find("RShoulder");
  if (shoulder < 0) return;
  std::vector<double> lengths;
  const auto count = motion.body->points.size(), point = static_cast<std::size_t>(shoulder);
  for (std::size_t row = 0; row < body_.size(); row += 2 * count)
    lengths.push_back(std::hypot(body_[row + point], body_[row + count + point]));
  const double usual = Percentile(&lengths, 0.5);
  if (usual > 1e-3) unit_ = usual;
}

std::int64_t BodyDrawing::Find(const char* name) const {
  const auto& points = motion_.body->points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].name == name) return static_cast<std::int64_t>(i);
  }
  return -1;
}

std::vector<Vec2> BodyDrawing::PointsAt(const std::vector<float>& values, std::size_t count,
                                        double time) const {
  const double last = static_cast<double>(motion_.frames - 1);
  const double at = std::clamp(time * motion_.frame_rate, 0.0, last);
  const double before = std::floor(at), share = at - before;
  const std::size_t a = static_cast<std::size_t>(before) * 2 * count;
  const std::size_t b = static_cast<std::size_t>(std::min(before + 1, last)) * 2 * count;
  std::vector<Vec2> points;
  for (std::size_t p = 0; p < count; ++p) {
    const auto blend = [&](std::size_t column) {
      return (values[a + column] + share * (values[b + column] - values[a + column])) / unit_;
    };
    points.push_back({blend(p), blend(count + p)});
  }
  return points;
}

Drawing BodyDrawing::At(double time, double trail) const {
  Drawing out;
  const auto& joints = motion_.body->points;
  const std::vector<Vec2> points = PointsAt(body_, joints.size(), time);
  AddTorso(points, &out);
  const double begin = std::max(0.0, time - trail);
  for (const char* name : {"RWrist", "LWrist"}) {
    const std::int64_t wrist = Find(name);
    if (wrist < 0 || time <= begin) continue;
    Shape path = Line({}, 0.035, SideOf(name));
    path.opacity = 0.5;
    const int pieces = 8;
    for (int i = 0; i <= pieces; ++i)
      path.points.push_back(
          PointsAt(body_, joints.size(),
                   begin + (time - begin) * i / pieces)[static_cast<std::size_t>(wrist)]);
    out.push_back(std::move(path));
  }
  AddHead(points, time, &out);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].parent < 0 || OfHead(joints[i].name)) continue;
    out.push_back(Line({points[static_cast<std::size_t>(joints[i].parent)], points[i]},
                       WidthOf(joints[i].name), SideOf(joints[i].name)));
  }
  return out;
}

// Below the shoulders: what carries the arms, though no network makes it.
void BodyDrawing::AddTorso(const std::vector<Vec2>& points, Drawing* out) const {
  const std::int64_t r = Find("RShoulder"), l = Find("LShoulder");
  if (r < 0 || l < 0) return;
  const Vec2 right = points[static_cast<std::size_t>(r)],
             left = points[static_cast<std::size_t>(l)];
  const double side = right.x < left.x ? 1 : -1, middle = (right.x + left.x) / 2;
  out->push_back({Shape::Kind::kArea,
                  Ink::kTorso,
                  {right, left, {middle + side * 0.66, 1.9}, {middle - side * 0.66, 1.9}},
                  0,
                  0.5});
}

void BodyDrawing::AddHead(const std::vector<Vec2>& points, double time, Drawing* out) const {
  const std::int64_t n = Find("Nose"), r = Find("REye"), l = Find("LEye");
  if (n < 0 && (r < 0 || l < 0) && !motion_.face) return;
  const auto at = [&](std::int64_t i) { return points[static_cast<std::size_t>(i)]; };
  Vec2 centre{0, -0.9};
  if (r >= 0 && l >= 0) centre = Middle(at(r), at(l));
  if (n >= 0) centre = r >= 0 && l >= 0 ? Middle(centre, at(n)) : at(n);
  const double length = std::hypot(centre.x, centre.y), chin = std::max(length - 0.42, 0.0);
  if (length > 0)
    out->push_back(
        Line({{0, 0}, {centre.x * chin / length, centre.y * chin / length}}, 0.16, Ink::kBody));
  if (motion_.face) return AddFace(time, out);
  AddOutlined(Ellipse(centre, kHeadRadius, 0.4, 0, 24), 0.05, Ink::kSkin, out);
  for (const std::int64_t eye : {r, l})
    if (eye >= 0) out->push_back(Disc(at(eye), 0.034, Ink::kBody));
  if (n >= 0) out->push_back(Disc(at(n), 0.028, Ink::kBody));
}

void BodyDrawing::AddFace(double time, Drawing* out) const {
  // Parts of OpenPose's face: first and last point, and whether the line is closed.
  struct Part {
    std::int64_t first, last;
    bool closed, brow;
  };
  constexpr std::array<Part, 9> kParts = {{{0, 16, false, false},
                                           {17, 21, false, true},
                                           {22, 26, false, true},
                                           {27, 30, false, false},
                                           {31, 35, false, false},
                                           {36, 41, true, false},
                                           {42, 47, true, false},
                                           {48, 59, true, false},
                                           {60, 67, true, false}}};
  const auto& landmarks = motion_.face->points;
  const std::vector<Vec2> points = PointsAt(face_, landmarks.size(), time);
  for (const Part& part : kParts) {
    std::vector<Vec2> line;
    for (std::int64_t source = part.first; source <= part.last; ++source) {
      for (std::size_t i = 0; i < landmarks.size(); ++i)
        if (landmarks[i].source == source) line.push_back(points[i]);
    }
    if (line.empty()) continue;
    if (part.first == 0 && line.size() >= 3) {  // closed over the forehead
      const Vec2 a = line.back(), b = line.front(), half = {(b.x - a.x) / 2, (b.y - a.y) / 2};
      const double up = b.x > a.x ? 0.95 : -0.95;
      for (const double angle : {0.5236, 1.0472, 1.5708, 2.0944, 2.618}) {
        const double along = 1 - std::cos(angle), lift = up * std::sin(angle);
        line.push_back(
            {a.x + along * half.x + lift * half.y, a.y + along * half.y - lift * half.x});
      }
      AddOutlined(Smooth(line, 3, true), 0.05, Ink::kSkin, out);
    } else if (part.closed && line.size() < 4) {  // an eye of which only the lids are known
      const Vec2 upper = line.front(), lower = line.back();
      const double height = std::hypot(lower.x - upper.x, lower.y - upper.y) / 2;
      AddOutlined(Ellipse(Middle(upper, lower), 0.08, std::clamp(height, 0.012, 0.09), 0, 12),
                  0.022, Ink::kEye, out);
      out->push_back(Disc(Middle(upper, lower), std::clamp(height, 0.012, 0.034), Ink::kPupil));
    } else {
      std::vector<Vec2> smooth = Smooth(line, 3, part.closed);
      if (part.closed) smooth.push_back(smooth.front());
      out->push_back(
          Line(std::move(smooth), part.brow ? 0.045 : 0.03, part.brow ? Ink::kBrow : Ink::kBody));
    }
  }
}

BodyDrawing::Extent BodyDrawing::extent() const {
  std::vector<double> xs, ys;
  const auto add = [&](const std::vector<float>& values, std::size_t count) {
    const std::size_t step =
        2 * count * std::max<std::size_t>(1, values.size() / (2 * count) / 500);
    for (std::size_t row = 0; row < values.size(); row += step) {
      for (std::size_t p = 0; p < count; ++p) {
        xs.push_back(values[row + p] / unit_);
        ys.push_back(values[row + count + p] / unit_);
      }
    }
  };
  add(body_, motion_.body->points.size());
  if (motion_.face) add(face_, motion_.face->points.size());
  constexpr double kMargin = 0.12;
  return {std::clamp(Percentile(&xs, 0.01) - kMargin, -3.5, -1.2),
          std::clamp(Percentile(&ys, 0.01) - kMargin - 0.2, -3.0, -1.4),
          std::clamp(Percentile(&xs, 0.99) + kMargin, 1.2, 3.5),
          std::clamp(Percentile(&ys, 0.99) + kMargin, 1.9, 4.0)};
}

TakeDrawing::TakeDrawing(const Motion& motion) : motion_(motion) {
  if (motion.body) body_.emplace_back(motion);
}

Drawing TakeDrawing::At(double time, double trail) const {
  if (!body_.empty()) return body_.front().At(time, trail);
  return motion_.curves ? HeadAt(motion_, time) : Drawing();
}

BodyDrawing::Extent TakeDrawing::extent() const {
  return body_.empty() ? BodyDrawing::Extent{-1.2, -1.2, 1.2, 1.2} : body_.front().extent();
}

Placement Fit(const BodyDrawing::Extent& extent, double x, double y, double width, double height) {
  const double scale =
      std::min(width / (extent.right - extent.left), height / (extent.bottom - extent.top));
  return {scale, x + width / 2 - scale * (extent.left + extent.right) / 2,
          y + height / 2 - scale * (extent.top + extent.bottom) / 2};
}

BodyDrawing::Extent Join(const BodyDrawing::Extent& a, const BodyDrawing::Extent& b) {
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right),
          std::max(a.bottom, b.bottom)};
}

}  // namespace gestus::player
