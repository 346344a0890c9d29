// From the pixels of a video to the columns that a network takes, and back.
//
//   Result<Stances> stances = FindStances(body);                  // body: cleaned, 15 fps
//   Result<std::vector<float>> pose = PoseColumns(body, layout, stances->frames);
//   ... a network makes other poses of it ...
//   Result<std::vector<float>> pixels = PosePixels(made, layout, stances->frames);
//
// Columns lie as in PATS: x of every joint, then y of every joint.  Joints are relative to the
// neck, whose own columns keep its position in the picture.
#ifndef GESTUS_MODELS_MOTION_SELECT_H_
#define GESTUS_MODELS_MOTION_SELECT_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/motion/clip.h"

namespace gestus::motion {

/// Which of PATS' arrays a network was trained on.
enum class PoseSource {
  kNormalize,  ///< pose/normalize: each frame scaled by 167 / |RShoulder - Neck|
  kData,       ///< pose/data: pixels
};

/// What |RShoulder - Neck| is scaled to.
constexpr float kShoulder = 167.0f;

enum class NeckColumns {
  kPosition,  ///< as in PATS: pixels in the picture, whatever the source
  kZero,      ///< its distance to itself
};

/// What the weights file says of poses.
struct PoseLayout {
  std::vector<std::int32_t> joints = {};  ///< PATS' joint, 0 to 51, of each joint of the network
  PoseSource source = PoseSource::kNormalize;
  NeckColumns neck = NeckColumns::kPosition;
};

/// Where a figure stands in a frame and how large it is, in pixels.
struct Stance {
  float neck_x = 0, neck_y = 0;
  float shoulder = kShoulder;  ///< |RShoulder - Neck|, above 0
};

struct Stances {
  std::vector<Stance> frames;
  std::vector<std::string> notes;
};

/// Of every frame of `body`, PATS' 52 joints.  Where the shoulder is not a tenth as long as it
/// mostly is, its length is interpolated from the frames around; PATS would scale such a frame up
/// tenfold and more.
/// Errors: a neck or right shoulder that was never seen, or that are at one place in most frames.
Result<Stances> FindStances(const Track& body);

/// (frames, 2 * joints) of `body`; a stance a frame.
/// Errors: a joint out of range, or never seen.
Result<std::vector<float>> PoseColumns(const Track& body, const PoseLayout& layout,
                                       std::span<const Stance> stances);

/// (frames, 2 * landmarks) of `face`, OpenPose's 70 points: relative to the neck and scaled as the
/// joints are, one figure with them (docs/features/motion.md says why); a stance a frame.
/// Errors: a landmark out of range, or never seen.
Result<std::vector<float>> FaceColumns(const Track& face,
                                       const std::vector<std::int32_t>& landmarks,
                                       PoseSource source, std::span<const Stance> stances);

/// Undoes PoseColumns: pixels (frames, 2 * joints) of `columns`, with one stance a frame, or one
/// for all.  The neck is put where the stance says; what its columns hold is not used. Errors:
/// sizes that do not fit each other, a joint out of range.
Result<std::vector<float>> PosePixels(std::span<const float> columns, const PoseLayout& layout,
                                      std::span<const Stance> stances);

/// Undoes FaceColumns, for `landmarks` many of them.
Result<std::vector<float>> FacePixels(std::span<const float> columns, std::int64_t landmarks,
                                      PoseSource source, std::span<const Stance> stances);

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_SELECT_H_
