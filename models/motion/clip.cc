#include "models/motion/clip.h"

#include <utility>

#include "models/io/text.h"

namespace gestus::motion {
namespace {

// A clip of which less than a hundredth is there is none; short ones cost nothing to hold.
constexpr std::int64_t kShortClip = 10000;
constexpr std::int64_t kMostGaps = 100;

}  // namespace

Track::Track(std::vector<std::string> names, std::int64_t coordinates_of_a_point, std::int64_t n,
             double rate)
    : points(std::move(names)), coordinates(coordinates_of_a_point), frames(n), frame_rate(rate) {
  values.resize(static_cast<std::size_t>(frames * columns()));
  confidence.resize(static_cast<std::size_t>(frames * point_count()));
}

bool Track::Has(std::int64_t point) const {
  for (std::int64_t t = 0; t < frames; ++t) {
    if (seen(t, point) > 0) return true;
  }
  return false;
}

Result<std::int64_t> CountFrames(std::int64_t first, std::int64_t last, std::int64_t present,
                                 std::int64_t max_frames) {
  // Numbers are not negative, so that the difference fits.
  const std::int64_t span = last - first;
  if (span >= max_frames) {
    return Status(Code::kResourceExhausted,
                  "frames " + std::to_string(first) + " to " + std::to_string(last) +
                      ", expected at most " +
                      Count(static_cast<std::uint64_t>(max_frames), "frame"));
  }
  if (span >= kShortClip && span / kMostGaps >= present) {
    return Status(Code::kBadInput,
                  "frames " + std::to_string(first) + " to " + std::to_string(last) +
                      ", but only " + std::to_string(present) +
                      " of them are there, expected numbers that follow each other");
  }
  return span + 1;
}

Status CheckFrameRate(double rate, const std::string& what) {
  if (rate >= 1 && rate <= 1000) return Status();
  return Status(Code::kInvalidArgument,
                what + " is " + Significant(rate, 6) + ", expected 1 to 1000 frames per second");
}

}  // namespace gestus::motion
