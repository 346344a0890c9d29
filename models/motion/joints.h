// The points that figures are made of: PATS' joints, and where OpenPose has them.
#ifndef GESTUS_MODELS_MOTION_JOINTS_H_
#define GESTUS_MODELS_MOTION_JOINTS_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace gestus::motion {

/// PATS: neck, arms, nose and eyes, then the root of each hand with its 20 finger joints.
constexpr std::int64_t kPatsJoints = 52;
constexpr std::int64_t kBodyJoints = 10;  ///< those before the hands
enum PatsJoint : std::int64_t {
  kNeck = 0,
  kRShoulder = 1,
  kRWrist = 3,
  kLWrist = 6,
  kLHandRoot = 10,
  kRHandRoot = 31,
};
constexpr std::int64_t kHandPoints = 21;

/// OpenPose's face: contour, brows, nose, eyes, lips, pupils.
constexpr std::int64_t kFacePoints = 70;

/// "Neck", "RShoulder" and so on to "RHandLittle4", as PATS names them.
std::vector<std::string> PatsJointNames();
/// "Face0" to "Face69".
std::vector<std::string> FacePointNames();

/// Where PATS' body joints stand in OpenPose's models.
constexpr std::array<std::size_t, kBodyJoints> kBody25 = {1, 2, 3, 4, 5, 6, 7, 0, 15, 16};
constexpr std::array<std::size_t, kBodyJoints> kCoco18 = {1, 2, 3, 4, 5, 6, 7, 0, 14, 15};
constexpr std::size_t kBody25Points = 25;
constexpr std::size_t kCoco18Points = 18;

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_JOINTS_H_
