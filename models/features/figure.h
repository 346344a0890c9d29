// A filmed speaker as X_pose and X_face.
#ifndef GESTUS_MODELS_FEATURES_FIGURE_H_
#define GESTUS_MODELS_FEATURES_FIGURE_H_

#include <string>

#include "engine/status.h"
#include "models/features/input_stream.h"
#include "models/features/spec.h"
#include "models/motion/openpose.h"
#include "models/motion/select.h"

namespace gestus::features {

struct Figure {
  motion::OpenPoseClip raw;  ///< as OpenPose found it, at the video's rate
  motion::Track body, face;  ///< cleaned, at the motion's rate; no face: 0 frames
  motion::Stances stances;   ///< of the cleaned body
};

/// Reads and cleans OpenPose's files.  `pose_rate` is their frame rate; 0: of those that are usual
/// the one that makes them last `seconds`, or 15 where that is 0 too.  Errors begin with the path.
Result<Figure> ReadFigure(const std::string& path, double pose_rate, double seconds,
                          double frame_rate, Account* account);

/// X_pose (frames, 2 * joints) and X_face (frames, 2 * landmarks) as the spec lists them.
Result<models::Array> PoseOf(const Figure& figure, const FeatureSpec& spec);
Result<models::Array> FaceOf(const Figure& figure, const FeatureSpec& spec);

/// `values` as an array of `rows` rows.
models::Array RowsOf(std::vector<float> values, std::int64_t rows);

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_FIGURE_H_
