#include "models/outputs/rotations.h"

#include <algorithm>
#include <cmath>

namespace gestus::outputs {

double Dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vector3 Cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double Length(const Vector3& a) { return std::sqrt(Dot(a, a)); }

Quaternion Product(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Quaternion Inverse(const Quaternion& q) { return {-q.x, -q.y, -q.z, q.w}; }

Vector3 Turned(const Quaternion& q, const Vector3& v) {
  const Vector3 axis = {q.x, q.y, q.z};
  const Vector3 once = Cross(axis, v), twice = Cross(axis, once);
  return {v.x + 2 * (q.w * once.x + twice.x), v.y + 2 * (q.w * once.y + twice.y),
          v.z + 2 * (q.w * once.z + twice.z)};
}

Quaternion AboutAxis(int axis, double angle) {
  const double s = std::sin(angle / 2);
  return {axis == 0 ? s : 0, axis == 1 ? s : 0, axis == 2 ? s : 0, std::cos(angle / 2)};
}

Quaternion Between(const Vector3& from, const Vector3& to) {
  const Vector3 axis = Cross(from, to);
  const double w = 1 + Dot(from, to);
  const double norm = std::sqrt(Dot(axis, axis) + w * w);
  if (norm < 1e-9) return AboutAxis(2, kPi);
  return {axis.x / norm, axis.y / norm, axis.z / norm, w / norm};
}

double Nearest(double angle, double last) {
  return angle + 2 * kPi * std::round((last - angle) / (2 * kPi));
}

std::array<double, 3> AnglesZxy(const Quaternion& q, const std::array<double, 3>& last) {
  // Of the matrix of q = Rz Rx Ry: r21 = sin x, r01 / r11 = -tan z, r20 / r22 = -tan y.
  const double r21 = 2 * (q.y * q.z + q.w * q.x);
  const double r01 = 2 * (q.x * q.y - q.w * q.z), r11 = 1 - 2 * (q.x * q.x + q.z * q.z);
  const double r20 = 2 * (q.x * q.z - q.w * q.y), r22 = 1 - 2 * (q.x * q.x + q.y * q.y);
  const double x = std::asin(std::clamp(r21, -1.0, 1.0));
  std::array<double, 3> first;
  if (std::fabs(r21) < 1 - 1e-12) {
    first = {std::atan2(-r01, r11), x, std::atan2(-r20, r22)};
  } else {
    // Only the sum or the difference of z and y is given; z stays what it was.
    const double r10 = 2 * (q.x * q.y + q.w * q.z), r00 = 1 - 2 * (q.y * q.y + q.z * q.z);
    const double both = std::atan2(r10, r00);
    first = {last[0], x, r21 > 0 ? both - last[0] : last[0] - both};
  }
  std::array<double, 3> second = {first[0] + kPi, kPi - first[1], first[2] + kPi};
  const auto near = [&](std::array<double, 3>& angles) {
    double distance = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      angles[i] = Nearest(angles[i], last[i]);
      distance += std::fabs(angles[i] - last[i]);
    }
    return distance;
  };
  const double d1 = near(first), d2 = near(second);
  return d1 <= d2 ? first : second;
}

std::array<double, 3> AnglesXyz(const Vector3& x, const Vector3& y, const Vector3& z) {
  // The vectors are the columns of Rz Ry Rx, whose last row is (-sin y, cos y sin x, cos y cos x).
  const double about_y = std::asin(std::clamp(-x.z, -1.0, 1.0));
  if (std::fabs(x.z) < 1 - 1e-12) return {std::atan2(y.z, z.z), about_y, std::atan2(x.y, x.x)};
  // Only the difference or the sum of x and z is given.
  return {x.z < 0 ? std::atan2(y.x, y.y) : std::atan2(-y.x, y.y), about_y, 0};
}

}  // namespace gestus::outputs
