// Arms out of the plane: what depth their bones must have to look as short as they do.  A private
// header of the BVH writer.
#ifndef GESTUS_MODELS_OUTPUTS_LIFT_H_
#define GESTUS_MODELS_OUTPUTS_LIFT_H_

#include <cstdint>
#include <vector>

#include "models/outputs/skeleton.h"

namespace gestus::outputs {

/// The quantile of the lengths in the picture that stands for a bone's length: nearly the longest
/// for arms, which are only ever foreshortened, else the median.
double LiftedQuantile(const Bone& bone);

/// Gives the upper arms and forearms among `spans`, (frames, bones) in the plane, a depth (z, to
/// the viewer): sqrt(length^2 - span^2), 0 where a span is longer than its bone.  Of the two signs
/// of each bone those are taken, over the whole clip (Viterbi), that bend the arm least against its
/// joints and change its direction least from frame to frame.  A guess: one picture does not tell.
void Lift(const Skeleton& skeleton, std::int64_t frames, std::vector<Vector3>* spans);

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_LIFT_H_
