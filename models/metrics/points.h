// Which points of figures can be compared, and their coordinates side by side.
#ifndef GESTUS_MODELS_METRICS_POINTS_H_
#define GESTUS_MODELS_METRICS_POINTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "models/outputs/motion.h"

namespace gestus::metrics {

enum class Part { kBody, kFace };

/// PATS' numbers.
constexpr std::int64_t kNeck = 0, kRightWrist = 3, kLeftWrist = 6;

/// Sources (outputs::Point::source) that every one of `figures` has, in the order of the first,
/// each once.  Null figures are passed over.  The neck of a body is left out: joints are relative
/// to it, and its own columns hold its place in the picture or nothing.
std::vector<std::int64_t> SharedSources(std::span<const outputs::Figure* const> figures, Part part);

/// Indices of the points of `figure` with these sources; those that it lacks are passed over.
std::vector<std::size_t> PointsWith(const outputs::Figure& figure,
                                    std::span<const std::int64_t> sources);

/// (frames, 2 * points): x of the body's points and of the face's, then y of them, of the first
/// `frames` frames.  A part without sources need not be there.
std::vector<float> Coordinates(const outputs::Motion& motion, std::int64_t frames,
                               std::span<const std::int64_t> body_sources,
                               std::span<const std::int64_t> face_sources);

}  // namespace gestus::metrics

#endif  // GESTUS_MODELS_METRICS_POINTS_H_
