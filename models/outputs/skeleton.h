// The points of a figure as the skeleton of a BVH file.  A private header of the writer.
//
// A bone leads from a point to its parent's child; its rotation is held by the joint at its
// beginning.  Where several bones begin at one point, each gets a joint of its own there.
#ifndef GESTUS_MODELS_OUTPUTS_SKELETON_H_
#define GESTUS_MODELS_OUTPUTS_SKELETON_H_

#include <cstdint>
#include <string>
#include <vector>

#include "models/outputs/formats.h"
#include "models/outputs/rotations.h"

namespace gestus::outputs {

constexpr int kNone = -1;

/// From point `from` (kNone: the root, when the neck is no point) to the point of the same index as
/// the bone.  The bone of the neck itself is not used.
struct Bone {
  int from = kNone;
  int before = kNone;  ///< the bone that ends where this one begins
  std::int64_t source = 0;
  Vector3 rest;       ///< a unit vector: where it points in the rest pose
  double length = 0;  ///< cm
};

struct Joint {
  std::string name;
  int parent = kNone;  ///< an earlier joint
  Vector3 offset;      ///< from the parent's place, in the rest pose; cm
  int bone = kNone;    ///< whose rotation it holds
  bool ends = true;    ///< nothing is attached to it
};

struct Skeleton {
  std::vector<Bone> bones;    ///< one a point
  std::vector<Joint> joints;  ///< depth first; joint 0 is the root
  int neck = kNone;           ///< which point
  double cm = 0;              ///< of one unit of the figure
  double neck_cm = 0;         ///< of one pixel of the neck's columns

  bool IsBone(int point) const { return point != neck; }
};

/// Where bone `bone` ends as seen from where it begins, in the plane: x right, y up, z 0; cm.
Vector3 Span(const Skeleton& skeleton, const Figure& body, std::int64_t frame, int bone);

/// Of every bone in every frame, (frames, bones); the neck's is 0.
std::vector<Vector3> SpansOf(const Skeleton& skeleton, const Motion& motion);

/// `quantile` of the lengths of a bone over the clip: 0.5 the median.
using LengthQuantile = double (*)(const Bone&);

/// Errors: too many points.
Result<Skeleton> MakeSkeleton(const Motion& motion, const FormatOptions& options,
                              LengthQuantile quantile);

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_SKELETON_H_
