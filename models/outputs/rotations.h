// The little of rotations in space that the file formats need.  A private header of the writers.
#ifndef GESTUS_MODELS_OUTPUTS_ROTATIONS_H_
#define GESTUS_MODELS_OUTPUTS_ROTATIONS_H_

#include <array>

namespace gestus::outputs {

inline constexpr double kPi = 3.14159265358979323846;

struct Vector3 {
  double x = 0, y = 0, z = 0;
};

double Dot(const Vector3& a, const Vector3& b);
Vector3 Cross(const Vector3& a, const Vector3& b);
double Length(const Vector3& a);

/// A unit quaternion; turns vectors, right-handed.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};

Quaternion Product(const Quaternion& a, const Quaternion& b);  ///< b is applied first
Quaternion Inverse(const Quaternion& q);
Vector3 Turned(const Quaternion& q, const Vector3& v);
/// By `angle` (rad) about the axis 0 (x), 1 (y) or 2 (z).
Quaternion AboutAxis(int axis, double angle);
/// The shortest turn from one unit vector to another; about z when they are opposite.
Quaternion Between(const Vector3& from, const Vector3& to);

/// Angles z, x, y (rad) with q = turn about z * turn about x * turn about y, the order of BVH's
/// channels; of the two solutions and all full turns the one nearest to `last`.
std::array<double, 3> AnglesZxy(const Quaternion& q, const std::array<double, 3>& last);
/// Angles about x, y, z (rad) of the turn that takes the axes to the unit vectors `x`, `y`, `z`:
/// about z * about y * about x, the order of Greta's joints.  That about y is within a quarter
/// turn; where it is one, that about z is 0.
std::array<double, 3> AnglesXyz(const Vector3& x, const Vector3& y, const Vector3& z);
/// `angle` and whole turns, nearest to `last`.
double Nearest(double angle, double last);

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_ROTATIONS_H_
