#include "models/motion/clean.h"

#include <algorithm>
#include <array>

#include "models/io/text.h"

namespace gestus::motion {
namespace {

constexpr int kMaxMedian = 99;

// A column at a time, taken out of the track's rows.
class Column {
 public:
  Column(const CleanOptions& options, std::int64_t frames)
      : options_(options), x_(static_cast<std::size_t>(frames)), y_(x_.size()) {}

  void Clean(std::int64_t coordinate, std::int64_t point, const std::vector<std::uint8_t>& seen,
             Track* track) {
    for (std::size_t t = 0; t < x_.size(); ++t) {
      x_[t] = track->value(static_cast<std::int64_t>(t), coordinate, point);
    }
    const bool fill_first = options_.order == CleanOrder::kFillFirst;
    if (fill_first) FillGaps(seen, &x_);
    MedianFilter(x_.data(), std::ssize(x_), options_.median, fill_first, y_.data());
    if (!fill_first) FillGaps(seen, &y_);
    for (std::size_t t = 0; t < x_.size(); ++t) {
      track->value(static_cast<std::int64_t>(t), coordinate, point) = y_[t];
    }
  }

 private:
  const CleanOptions& options_;
  std::vector<float> x_, y_;
};

Status Check(const Track& track, const CleanOptions& options) {
  if (options.median < 1 || options.median > kMaxMedian || options.median % 2 == 0) {
    return Status(Code::kInvalidArgument, "a median of " + std::to_string(options.median) +
                                              " frames, expected an odd number from 1 to " +
                                              std::to_string(kMaxMedian));
  }
  if (!(options.min_confidence >= 0 && options.min_confidence < 1)) {
    return Status(Code::kInvalidArgument, "a least confidence of " +
                                              Significant(options.min_confidence, 3) +
                                              ", expected 0 or more and less than 1");
  }
  const bool any = std::any_of(track.confidence.begin(), track.confidence.end(),
                               [&](float c) { return c > options.min_confidence; });
  if (any) return Status();
  return Status(Code::kBadInput,
                "nothing was seen in " + Count(static_cast<std::uint64_t>(track.frames), "frame") +
                    " with a confidence above " + Significant(options.min_confidence, 3) +
                    ", expected one frame at least");
}

std::int64_t CountLostFrames(const Track& track) {
  std::int64_t lost = 0;
  for (std::int64_t t = 0; t < track.frames; ++t) {
    const float* begin = track.confidence.data() + t * track.point_count();
    lost += std::all_of(begin, begin + track.point_count(), [](float c) { return c <= 0; });
  }
  return lost;
}

std::int64_t LongestGap(const std::vector<std::uint8_t>& seen) {
  std::int64_t longest = 0, gap = 0;
  for (const std::uint8_t s : seen) {
    gap = s ? 0 : gap + 1;
    longest = std::max(longest, gap);
  }
  return longest;
}

void Describe(const Track& track, CleanReport* report) {
  const auto count = [](std::int64_t n, const char* noun) {
    return Count(static_cast<std::uint64_t>(n), noun);
  };
  if (report->filled_points > 0) {
    report->notes.push_back(count(report->lost_frames, "frame") + " of " +
                            std::to_string(track.frames) + " lost, " +
                            count(report->filled_points, "point") + " filled in, " +
                            std::to_string(report->longest_gap) + " in a row at most");
  }
  if (!report->never_seen.empty()) {
    report->notes.push_back(count(std::ssize(report->never_seen), "point") +
                            " never seen: " + report->never_seen.front() +
                            (report->never_seen.size() > 1 ? " and others" : ""));
  }
}

}  // namespace

void MedianFilter(const float* x, std::int64_t n, int size, bool hold_ends, float* y) {
  std::array<float, kMaxMedian> window;
  const std::int64_t half = size / 2;
  for (std::int64_t t = 0; t < n; ++t) {
    for (std::int64_t i = 0; i < size; ++i) {
      const std::int64_t at = t - half + i;
      const bool inside = at >= 0 && at < n;
      window[static_cast<std::size_t>(i)] =
          inside || hold_ends ? x[std::clamp<std::int64_t>(at, 0, n - 1)] : 0.0f;
    }
    std::nth_element(window.begin(), window.begin() + half, window.begin() + size);
    y[t] = window[static_cast<std::size_t>(half)];
  }
}

void FillGaps(const std::vector<std::uint8_t>& seen, std::vector<float>* x) {
  const auto n = std::ssize(*x);
  std::ptrdiff_t left = -1;
  for (std::ptrdiff_t right = 0; right <= n; ++right) {
    if (right < n && !seen[static_cast<std::size_t>(right)]) continue;
    if (left < 0 && right == n) return;
    const double a = (*x)[static_cast<std::size_t>(left >= 0 ? left : right)];
    const double b = (*x)[static_cast<std::size_t>(right < n ? right : left)];
    for (std::ptrdiff_t t = left + 1; t < right; ++t) {
      const double part = static_cast<double>(t - left) / static_cast<double>(right - left);
      (*x)[static_cast<std::size_t>(t)] = static_cast<float>(a + (b - a) * part);
    }
    left = right;
  }
}

Result<CleanReport> Clean(Track* track, const CleanOptions& options) {
  GESTUS_RETURN_IF_ERROR(Check(*track, options));
  for (float& c : track->confidence) {
    if (!(c > options.min_confidence)) c = 0;
  }
  CleanReport report;
  report.lost_frames = CountLostFrames(*track);
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(track->frames));
  Column column(options, track->frames);
  for (std::int64_t p = 0; p < track->point_count(); ++p) {
    for (std::size_t t = 0; t < seen.size(); ++t) {
      seen[t] = track->seen(static_cast<std::int64_t>(t), p) > 0;
    }
    const auto found = std::count(seen.begin(), seen.end(), std::uint8_t{1});
    if (found == 0) {
      report.never_seen.push_back(track->points[static_cast<std::size_t>(p)]);
      continue;
    }
    report.filled_points += track->frames - found;
    report.longest_gap = std::max(report.longest_gap, LongestGap(seen));
    for (std::int64_t c = 0; c < track->coordinates; ++c) column.Clean(c, p, seen, track);
  }
  Describe(*track, &report);
  return report;
}

}  // namespace gestus::motion
