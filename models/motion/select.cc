#include "models/motion/select.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"
#include "models/motion/clean.h"
#include "models/motion/joints.h"

namespace gestus::motion {
namespace {

Status CheckPoints(const Track& track, std::int64_t points, const char* what) {
  if (track.coordinates == 2 && track.point_count() == points && track.frames > 0) return Status();
  return BadInput(std::string(what) + ": " +
                  Count(static_cast<std::uint64_t>(track.frames), "frame") + " of " +
                  Count(static_cast<std::uint64_t>(track.point_count()), "point") +
                  ", expected frames of " + std::to_string(points));
}

Status CheckIndices(const std::vector<std::int32_t>& indices, std::int64_t count,
                    const char* noun) {
  if (indices.empty()) return BadInput(std::string("no ") + noun + "s, expected one at least");
  for (const std::int32_t i : indices) {
    if (i >= 0 && i < count) continue;
    return BadInput(std::string(noun) + " " + std::to_string(i) + ", expected 0 to " +
                    std::to_string(count - 1));
  }
  return Status();
}

Status CheckSeen(const Track& track, std::int64_t point) {
  if (track.Has(point)) return Status();
  return BadInput(track.points[static_cast<std::size_t>(point)] + " was not seen in any of " +
                  Count(static_cast<std::uint64_t>(track.frames), "frame") +
                  ", but the pose needs it");
}

float Scale(const Stance& stance, PoseSource source) {
  return source == PoseSource::kNormalize ? kShoulder / stance.shoulder : 1.0f;
}

// (frames, 2 * points) of the points `indices` of `track`, relative to the neck.
std::vector<float> Relative(const Track& track, const std::vector<std::int32_t>& indices,
                            PoseSource source, std::span<const Stance> stances) {
  const std::size_t n = indices.size();
  std::vector<float> columns(static_cast<std::size_t>(track.frames) * 2 * n);
  float* to = columns.data();
  for (std::int64_t t = 0; t < track.frames; ++t, to += 2 * n) {
    const Stance& stance = stances[static_cast<std::size_t>(t)];
    const float scale = Scale(stance, source);
    for (std::size_t i = 0; i < n; ++i) {
      to[i] = (track.value(t, 0, indices[i]) - stance.neck_x) * scale;
      to[n + i] = (track.value(t, 1, indices[i]) - stance.neck_y) * scale;
    }
  }
  return columns;
}

Status CheckStances(std::int64_t frames, std::span<const Stance> stances, bool one_is_enough) {
  const auto n = std::ssize(stances);
  if (n == frames || (one_is_enough && n == 1)) {
    for (const Stance& s : stances) {
      if (!(s.shoulder > 0)) return BadInput("a shoulder of no length, expected one above 0");
    }
    return Status();
  }
  return BadInput(Count(stances.size(), "stance") + " for " +
                  Count(static_cast<std::uint64_t>(frames), "frame") + ", expected as many");
}

// Pixels of `points` many relative points.
Result<std::vector<float>> Absolute(std::span<const float> columns, std::size_t points,
                                    PoseSource source, std::span<const Stance> stances) {
  if (points == 0 || columns.size() % (2 * points) != 0) {
    return BadInput(Count(columns.size(), "value") + ", expected a multiple of " +
                    std::to_string(2 * points));
  }
  const std::size_t frames = columns.size() / (2 * points);
  GESTUS_RETURN_IF_ERROR(CheckStances(static_cast<std::int64_t>(frames), stances, true));
  std::vector<float> pixels(columns.begin(), columns.end());
  float* row = pixels.data();
  for (std::size_t t = 0; t < frames; ++t, row += 2 * points) {
    const Stance& stance = stances[stances.size() == 1 ? 0 : t];
    const float scale = 1 / Scale(stance, source);
    for (std::size_t i = 0; i < points; ++i) {
      row[i] = row[i] * scale + stance.neck_x;
      row[points + i] = row[points + i] * scale + stance.neck_y;
    }
  }
  return pixels;
}

// Calls `at(frame, column of x, column of y)` for each time that the neck is among the joints.
template <class Function>
void ForEachNeck(const PoseLayout& layout, std::size_t frames, Function at) {
  const std::size_t n = layout.joints.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (layout.joints[i] != kNeck) continue;
    for (std::size_t t = 0; t < frames; ++t) at(t, 2 * n * t + i, 2 * n * t + n + i);
  }
}

}  // namespace

Result<Stances> FindStances(const Track& body) {
  GESTUS_RETURN_IF_ERROR(CheckPoints(body, kPatsJoints, "body"));
  GESTUS_RETURN_IF_ERROR(CheckSeen(body, kNeck));
  GESTUS_RETURN_IF_ERROR(CheckSeen(body, kRShoulder));
  Stances found;
  std::vector<float> lengths;
  for (std::int64_t t = 0; t < body.frames; ++t) {
    Stance s = {body.value(t, 0, kNeck), body.value(t, 1, kNeck)};
    lengths.push_back(std::hypot(body.value(t, 0, kRShoulder) - s.neck_x,
                                 body.value(t, 1, kRShoulder) - s.neck_y));
    found.frames.push_back(s);
  }
  std::vector<float> sorted = lengths;
  const auto middle = sorted.begin() + std::ssize(sorted) / 2;
  std::nth_element(sorted.begin(), middle, sorted.end());
  if (!(*middle > 0)) {
    return BadInput("Neck and RShoulder are at one place in most frames, expected a distance");
  }
  std::vector<std::uint8_t> long_enough;
  for (const float length : lengths) long_enough.push_back(length >= *middle / 10);
  FillGaps(long_enough, &lengths);
  for (std::size_t t = 0; t < lengths.size(); ++t) found.frames[t].shoulder = lengths[t];
  const auto filled = std::count(long_enough.begin(), long_enough.end(), std::uint8_t{0});
  if (filled > 0) {
    found.notes.push_back(Count(static_cast<std::uint64_t>(filled), "frame") +
                          " with hardly any distance from Neck to RShoulder: interpolated");
  }
  return found;
}

Result<std::vector<float>> PoseColumns(const Track& body, const PoseLayout& layout,
                                       std::span<const Stance> stances) {
  GESTUS_RETURN_IF_ERROR(CheckPoints(body, kPatsJoints, "body"));
  GESTUS_RETURN_IF_ERROR(CheckIndices(layout.joints, kPatsJoints, "joint"));
  GESTUS_RETURN_IF_ERROR(CheckStances(body.frames, stances, false));
  for (const std::int32_t j : layout.joints) GESTUS_RETURN_IF_ERROR(CheckSeen(body, j));
  std::vector<float> columns = Relative(body, layout.joints, layout.source, stances);
  if (layout.neck == NeckColumns::kPosition) {
    ForEachNeck(layout, stances.size(), [&](std::size_t t, std::size_t x, std::size_t y) {
      columns[x] = stances[t].neck_x;
      columns[y] = stances[t].neck_y;
    });
  }
  return columns;
}

Result<std::vector<float>> FaceColumns(const Track& face,
                                       const std::vector<std::int32_t>& landmarks,
                                       PoseSource source, std::span<const Stance> stances) {
  GESTUS_RETURN_IF_ERROR(CheckPoints(face, kFacePoints, "face"));
  GESTUS_RETURN_IF_ERROR(CheckIndices(landmarks, kFacePoints, "landmark"));
  GESTUS_RETURN_IF_ERROR(CheckStances(face.frames, stances, false));
  for (const std::int32_t p : landmarks) GESTUS_RETURN_IF_ERROR(CheckSeen(face, p));
  return Relative(face, landmarks, source, stances);
}

Result<std::vector<float>> PosePixels(std::span<const float> columns, const PoseLayout& layout,
                                      std::span<const Stance> stances) {
  GESTUS_RETURN_IF_ERROR(CheckIndices(layout.joints, kPatsJoints, "joint"));
  Result<std::vector<float>> pixels =
      Absolute(columns, layout.joints.size(), layout.source, stances);
  if (!pixels.ok()) return pixels.status();
  const std::size_t frames = columns.size() / (2 * layout.joints.size());
  ForEachNeck(layout, frames, [&](std::size_t t, std::size_t x, std::size_t y) {
    const Stance& stance = stances[stances.size() == 1 ? 0 : t];
    (*pixels)[x] = stance.neck_x;
    (*pixels)[y] = stance.neck_y;
  });
  return pixels;
}

Result<std::vector<float>> FacePixels(std::span<const float> columns, std::int64_t landmarks,
                                      PoseSource source, std::span<const Stance> stances) {
  return Absolute(columns, static_cast<std::size_t>(std::max<std::int64_t>(0, landmarks)), source,
                  stances);
}

}  // namespace gestus::motion
