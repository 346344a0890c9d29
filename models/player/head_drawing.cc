// The schematic face of Model 1 and Model 2, as models/player/page/head.js draws it, with less
// ornament.  It lies on an ellipsoid of height 2: x to the right of the picture, y down, z away
// from who looks.  Angles are OpenFace's pose_Rx, Ry and Rz, R = Rx Ry Rz, so that Rx > 0 looks
// down.
#include <algorithm>
#include <array>
#include <cmath>

#include "models/player/drawing.h"

namespace gestus::player {
namespace {

using outputs::Motion;

constexpr std::array<double, 3> kAxes = {0.76, 1, 0.86};  // half axes of the head
using Matrix = std::array<std::array<double, 3>, 3>;

Matrix Rotation(double rx, double ry, double rz) {
  const double s1 = std::sin(rx), s2 = std::sin(ry), s3 = std::sin(rz);
  const double c1 = std::cos(rx), c2 = std::cos(ry), c3 = std::cos(rz);
  return {{{c2 * c3, -c2 * s3, s2},
           {c1 * s3 + c3 * s1 * s2, c1 * c3 - s1 * s2 * s3, -c2 * s1},
           {s1 * s3 - c1 * c3 * s2, c3 * s1 + c1 * s2 * s3, c1 * c2}}};
}

class Head {
 public:
  Head(const Motion& motion, double time) : motion_(motion) {
    const double last = static_cast<double>(motion.frames - 1);
    const double at = std::clamp(time * motion.frame_rate, 0.0, last);
    before_ = static_cast<std::int64_t>(at);
    after_ = std::min(before_ + 1, motion.frames - 1);
    share_ = at - static_cast<double>(before_);
    matrix_ = Rotation(Value("Rx"), Value("Ry"), Value("Rz"));
  }

  Drawing Draw() {
    AddSkull();
    for (const double side : {-1.0, 1.0}) {
      AddCheek(side);
      AddEye(side);
      AddBrow(side);
    }
    AddNoseAndMouth();
    return std::move(out_);
  }

 private:
  double Value(const char* name) const {
    const auto& curves = motion_.curves->curves;
    for (std::size_t n = 0; n < curves.size(); ++n) {
      if (curves[n].name != name) continue;
      const double a = motion_.curves->at(before_, n), b = motion_.curves->at(after_, n);
      const double value = a + share_ * (b - a);
      return std::isfinite(value) ? value : 0;
    }
    return 0;
  }

  /// An action unit's intensity, 0 to 1.
  double Unit(const char* name) const { return std::clamp(Value(name) / 5, 0.0, 1.0); }

  Vec2 Project(double x, double y, double z) const {
    const auto row = [&](std::size_t i) {
      return matrix_[i][0] * x + matrix_[i][1] * y + matrix_[i][2] * z;
    };
    const double near = 1 / (1 + 0.12 * row(2));
    return {row(0) * near, row(1) * near};
  }

  /// The point of the face that is seen at x, y from the front, `out` in front of the surface.
  Vec2 Surface(double x, double y, double out = 0) const {
    const double rest = 1 - std::pow(x / kAxes[0], 2) - std::pow(y / kAxes[1], 2);
    return Project(x, y, -kAxes[2] * std::sqrt(std::max(rest, 0.0)) - out);
  }

  void Add(std::vector<Vec2> points, double width, Ink ink = Ink::kBody) {
    out_.push_back({Shape::Kind::kLine, ink, std::move(points), width, 1});
  }

  void AddArea(std::vector<Vec2> points, Ink ink, double opacity = 1) {
    out_.push_back({Shape::Kind::kArea, ink, std::move(points), 0, opacity});
  }

  /// The outline of a turned ellipsoid is an ellipse: that of the matrix R diag(axes^2) R'.
  void AddSkull() {
    const auto entry = [&](std::size_t i, std::size_t j) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += matrix_[i][k] * matrix_[j][k] * kAxes[k] * kAxes[k];
      return sum;
    };
    const double xx = entry(0, 0), xy = entry(0, 1), yy = entry(1, 1);
    // Its lower triangular root turns a circle into the ellipse.
    const double a = std::sqrt(xx), b = xy / a, c = std::sqrt(std::max(yy - b * b, 0.0));
    for (const double side : {-1.0, 1.0}) {
      const Vec2 ear = Project(side * kAxes[0], -0.02, 0.1);
      out_.push_back({Shape::Kind::kDisc, Ink::kBody, {ear}, 0.1, 1});
    }
    std::vector<Vec2> outline;
    for (int i = 0; i < 60; ++i) {
      const double angle = 2 * 3.14159265358979 * i / 60;
      outline.push_back({a * std::cos(angle), b * std::cos(angle) + c * std::sin(angle)});
    }
    AddArea(outline, Ink::kSkin);
    outline.push_back(outline.front());
    Add(std::move(outline), 0.05);
  }

  void AddCheek(double side) {
    const double raised = Unit("AU06");
    std::vector<Vec2> rim;
    for (int i = 0; i < 14; ++i) {
      const double angle = 2 * 3.14159265358979 * i / 14;
      rim.push_back(Surface(side * 0.4 + 0.15 * std::cos(angle),
                            0.26 - 0.08 * raised + 0.1 * std::sin(angle)));
    }
    AddArea(std::move(rim), Ink::kCheek, 0.1 + 0.6 * raised);
  }

  void AddEye(double side) {
    const double y = -0.12;
    const double up = 0.085 + 0.075 * Unit("AU05") - 0.045 * Unit("AU07");
    const double down = std::max(0.06 - 0.045 * Unit("AU06") - 0.03 * Unit("AU07"), 0.004);
    std::vector<Vec2> upper, lower;
    for (int i = -4; i <= 4; ++i) {
      const double x = i / 4.0;
      upper.push_back(Surface(side * 0.3 + 0.155 * x, y - std::max(up, 0.02) * (1 - x * x)));
      lower.push_back(Surface(side * 0.3 - 0.155 * x, y + down * (1 - x * x)));
    }
    std::vector<Vec2> whole = upper;
    whole.insert(whole.end(), lower.begin(), lower.end());
    AddArea(std::move(whole), Ink::kEye);
    out_.push_back({Shape::Kind::kDisc,
                    Ink::kPupil,
                    {Surface(side * 0.3, y + (down - up) / 2)},
                    std::min(0.07, 0.5 * (up + down)),
                    1});
    Add(std::move(upper), 0.04);
    Add(std::move(lower), 0.02);
  }

  void AddBrow(double side) {
    const double inner = Unit("AU01"), outer = Unit("AU02"), lowered = Unit("AU04");
    std::vector<Vec2> line;
    for (int i = 0; i < 6; ++i) {
      const double share = i / 5.0;  // 0 inside, 1 outside
      const double lift = 0.2 * inner * std::pow(1 - share, 1.5) +
                          0.17 * outer * std::pow(share, 1.2) * (1.5 - 0.5 * share);
      const double arch = -0.055 * std::sin(3.14159265358979 * std::min(share * 1.15, 1.0));
      line.push_back(Surface(side * (0.15 + 0.34 * share - 0.06 * lowered * (1 - share)),
                             -0.33 + arch - lift + 0.13 * lowered * (1 - 0.55 * share)));
    }
    Add(Smooth(line, 3), 0.075, Ink::kBrow);
  }

  void AddNoseAndMouth() {
    const std::array<Vec2, 4> nose = {Surface(0, -0.06, 0.05), Surface(-0.015, 0.12, 0.16),
                                      Surface(-0.01, 0.22, 0.2), Surface(0.07, 0.26, 0.08)};
    Add(Smooth(nose, 4), 0.035);
    std::vector<Vec2> mouth;
    for (int i = -3; i <= 3; ++i)
      mouth.push_back(Surface(0.075 * i, 0.53 - (0.03 * Unit("AU06") + 0.012) * i * i / 9.0));
    Add(std::move(mouth), 0.04);
  }

  const Motion& motion_;
  std::int64_t before_ = 0, after_ = 0;
  double share_ = 0;
  Matrix matrix_;
  Drawing out_;
};

}  // namespace

Drawing HeadAt(const Motion& motion, double time) { return Head(motion, time).Draw(); }

}  // namespace gestus::player
