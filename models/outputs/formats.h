// Motion in the files of other programs (docs/outputs.md: order, units, axes, rest pose of each).
//
//   Result<Format> format = FormatOf("bvh");
//   Status status = WriteMotion(motion, *format, "wave.bvh");
#ifndef GESTUS_MODELS_OUTPUTS_FORMATS_H_
#define GESTUS_MODELS_OUTPUTS_FORMATS_H_

#include <string>
#include <string_view>
#include <vector>

#include "engine/status.h"
#include "models/motion/select.h"
#include "models/outputs/motion.h"

namespace gestus::outputs {

enum class Format {
  kOpenPose,   ///< "openpose": a folder with one JSON file a frame, BODY_25 and 70 face points
  kOpenFace,   ///< "openface": CSV with the header of the thesis' author
  kOpenFace2,  ///< "openface2": the same after OpenFace 2's first columns (frame, success, ...)
  kCsv,        ///< "csv": every value as it is, one row a frame
  kBvh,        ///< "bvh": a skeleton in the plane of the picture
  kBvh3d,      ///< "bvh3d": arms bent out of that plane, by a guess
  kArkit,      ///< "arkit": CSV of Live Link Face, 52 blendshapes and rotations
  kVrm,        ///< "vrm": JSON, weights of expressions and the rotation of the head
  kVrma,       ///< "vrma": VRM Animation, binary glTF: arms, head and expressions
  kFap,        ///< "fap": MPEG-4 face animation of Greta
  kBap,        ///< "bap": MPEG-4 body animation of Greta: head and arms
};

/// The formats' names, in the order above.
std::vector<std::string> FormatNames();
/// Errors: no such format; the message lists those that are.
Result<Format> FormatOf(std::string_view name);
std::string NameOf(Format format);

/// Where a figure stands in the picture when nobody says: OpenPose's pictures are taken to be
/// 1280 x 720 pixels.
inline constexpr motion::Stance kCentreStance = {640, 360, 100};
/// From the neck to the right shoulder in BVH, in cm.
inline constexpr double kShoulderCm = 18;

struct FormatOptions {
  /// Where the figure stands in the picture (OpenPose; BVH takes the length of the shoulder): none
  /// for kCentreStance, one, or one a frame.
  std::vector<motion::Stance> stances = {};
  /// OpenFace: halves what the network made, as the author did before animating (after all
  /// metrics).
  bool halve = false;
  /// In OpenPose's file names and Greta's first line; empty: that of the path.
  std::string name = {};
};

/// An error unless `motion` has what `format` holds: a body for kOpenPose and BVH; action units or
/// head angles for kOpenFace, kArkit and kVrm, and arms or a nose will do too for kVrma; action
/// units of brows, lids or cheeks for kFap; head angles, arms or a nose for kBap; anything for
/// kCsv. Only names are looked at, so a motion without frames is judged as well.
Status Suits(const Motion& motion, Format format);

/// Writes `motion` to `path`, completely or not at all.  An older file is replaced, and so is a
/// folder that holds nothing but OpenPose's files.
///
/// Errors: a motion without frames, with values that are no numbers or of sizes that do not fit;
/// one that does not suit the format; a path that cannot be written. They begin with the path.
Status WriteMotion(const Motion& motion, Format format, const std::string& path,
                   const FormatOptions& options = {});

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_FORMATS_H_
