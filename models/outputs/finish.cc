#include "models/outputs/finish.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "models/io/text.h"
#include "models/outputs/columns.h"

namespace gestus::outputs {
namespace {

constexpr std::int64_t kMaxValues = std::int64_t{1} << 28;
constexpr double kShoulder = 167;  // from neck to shoulder in PATS' normalised poses
// Fewer say nothing of a parabola that goes through three.
constexpr std::int64_t kLeastWindow = 5;

/// What a column is, beside its values.
struct Meaning {
  bool neck_position = false;
  const Curve* curve = nullptr;
};
using Change = std::function<Column(const Column&, const Meaning&)>;

bool IsNeck(const Point& point) { return point.source == 0; }

float Narrow(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kLargest, kLargest));
}

/// `values` (old_frames, columns) -> (frames, columns), column by column.
std::vector<float> Map(const std::vector<float>& values, std::int64_t old_frames,
                       std::int64_t frames, std::size_t columns, const Change& change,
                       const std::function<Meaning(std::size_t)>& meaning) {
  std::vector<float> out(static_cast<std::size_t>(frames) * columns);
  Column column(static_cast<std::size_t>(old_frames));
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t f = 0; f < column.size(); ++f) column[f] = values[f * columns + c];
    const Column made = change(column, meaning(c));
    for (std::size_t f = 0; f < made.size(); ++f) out[f * columns + c] = Narrow(made[f]);
  }
  return out;
}

/// `motion` with `change` made to every column; each result has `frames` values.
Motion MapColumns(const Motion& motion, std::int64_t frames, const Change& change) {
  Motion out = motion;
  out.frames = frames;
  const auto figure = [&](const std::optional<Figure>& from, bool body, std::optional<Figure>* to) {
    if (!from.has_value()) return;
    const std::size_t points = from->points.size();
    (*to)->values =
        Map(from->values, motion.frames, frames, 2 * points, change, [&](std::size_t c) {
          const bool neck = body && from->neck_is_position && IsNeck(from->points[c % points]);
          return Meaning{neck, nullptr};
        });
  };
  figure(motion.body, true, &out.body);
  figure(motion.face, false, &out.face);
  if (motion.curves.has_value()) {
    const std::vector<Curve>& curves = motion.curves->curves;
    out.curves->values = Map(motion.curves->values, motion.frames, frames, curves.size(), change,
                             [&](std::size_t c) {
                               return Meaning{false, &curves[c]};
                             });
  }
  return out;
}

/// Seams in order, each once, none at an end.
std::vector<Seam> SeamsOf(const Motion& motion) {
  std::vector<std::int64_t> at = motion.seams;
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  std::erase_if(at, [&](std::int64_t s) { return s <= 0 || s >= motion.frames; });
  std::vector<Seam> seams;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::int64_t last = i == 0 ? 0 : at[i - 1];
    const std::int64_t next = i + 1 < at.size() ? at[i + 1] : motion.frames;
    seams.push_back({at[i], at[i] - last, next - at[i]});
  }
  return seams;
}

Status CheckWithin(const char* what, double value, double least, double most) {
  if (value >= least && value <= most) return Status();
  return Status(Code::kInvalidArgument, std::string(what) + ": is " + Significant(value, 6) +
                                            ", expected " + Fixed(least, 0) + " to " +
                                            Fixed(most, 0));
}

std::int64_t FramesAt(const Motion& motion, double rate) {
  // 25 frames of 25 a second are 15 of 15, whatever the division rounds to.
  const double frames = static_cast<double>(motion.frames) * rate / motion.frame_rate + 1e-6;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(frames));
}

Status CheckOptions(const Motion& motion, const FinishOptions& options) {
  if (options.frame_rate != 0)
    GESTUS_RETURN_IF_ERROR(CheckWithin("frame rate", options.frame_rate, 1, kMaxFinishRate));
  GESTUS_RETURN_IF_ERROR(
      CheckWithin("seconds of cross-fade", options.crossfade, 0, kMaxFinishSeconds));
  GESTUS_RETURN_IF_ERROR(CheckWithin("seconds of smoothing", options.smooth, 0, kMaxFinishSeconds));
  GESTUS_RETURN_IF_ERROR(CheckWithin("amplitude", options.amplitude, 0, kMaxAmplitude));
  GESTUS_RETURN_IF_ERROR(
      CheckWithin("frame rate of the motion", motion.frame_rate, 1e-3, kMaxFinishRate));
  std::int64_t columns = 1;
  for (const auto* figure : {&motion.body, &motion.face})
    if (figure->has_value()) columns = std::max(columns, (*figure)->columns());
  const double rate = options.frame_rate == 0 ? motion.frame_rate : options.frame_rate;
  if (static_cast<double>(motion.frames) * rate / motion.frame_rate *
          static_cast<double>(columns) <=
      static_cast<double>(kMaxValues))
    return Status();
  return Status(Code::kResourceExhausted, "frame rate: makes more than " +
                                              Grouped(static_cast<std::uint64_t>(kMaxValues)) +
                                              " values of this motion, expected a lower one");
}

/// Half of the window of Smooth, in frames; 0: too short.
std::int64_t HalfWindow(const Motion& motion, double seconds) {
  if (!(seconds > 0)) return 0;
  const std::int64_t most = (motion.frames - 1) / 2;
  const double wanted = seconds * motion.frame_rate / 2 + 1e-6;
  const std::int64_t half =
      wanted < static_cast<double>(most) ? static_cast<std::int64_t>(wanted) : most;
  return 2 * half + 1 < kLeastWindow ? 0 : half;
}

/// The mean length of the third differences of `values` (frames, columns) over `vectors`, each of
/// which is a list of columns.
std::optional<double> MeanThird(const Motion& motion, const std::vector<float>& values,
                                std::size_t columns,
                                const std::vector<std::vector<std::size_t>>& vectors) {
  if (motion.frames < 4 || vectors.empty()) return std::nullopt;
  double sum = 0;
  for (std::int64_t f = 0; f + 3 < motion.frames; ++f) {
    const float* x = values.data() + static_cast<std::size_t>(f) * columns;
    for (const auto& vector : vectors) {
      double square = 0;
      for (const std::size_t c : vector) {
        const double third = static_cast<double>(x[c + 3 * columns]) - 3.0 * x[c + 2 * columns] +
                             3.0 * x[c + columns] - x[c];
        square += third * third;
      }
      sum += std::sqrt(square);
    }
  }
  const double count = static_cast<double>(motion.frames - 3) * static_cast<double>(vectors.size());
  return sum / count * motion.frame_rate * motion.frame_rate * motion.frame_rate;
}

}  // namespace

Motion Resample(const Motion& motion, double rate, Interpolation interpolation) {
  if (motion.frames < 1 || rate == motion.frame_rate) return motion;
  const std::int64_t frames = FramesAt(motion, rate);
  Motion out = MapColumns(motion, frames, [&](const Column& x, const Meaning&) {
    return Interpolate(x, motion.frame_rate, rate, frames, interpolation);
  });
  out.frame_rate = rate;
  out.seams.clear();
  for (const Seam& seam : SeamsOf(motion)) {
    const double first = static_cast<double>(seam.at) * rate / motion.frame_rate;
    const auto at = static_cast<std::int64_t>(std::ceil(first));
    if (at < frames && (out.seams.empty() || out.seams.back() < at)) out.seams.push_back(at);
  }
  return out;
}

Motion CrossFade(const Motion& motion, double seconds) {
  const std::vector<Seam> seams = SeamsOf(motion);
  if (seams.empty() || seconds <= 0) return motion;
  return MapColumns(motion, motion.frames, [&](const Column& x, const Meaning&) {
    Column out = x;
    for (const Seam& seam : seams) FadeSeam(x, seam, seconds * motion.frame_rate, &out);
    return out;
  });
}

Motion Smooth(const Motion& motion, double seconds) {
  const std::int64_t half = HalfWindow(motion, seconds);
  if (half == 0) return motion;
  return MapColumns(motion, motion.frames,
                    [&](const Column& x, const Meaning&) { return FitParabolas(x, half); });
}

Motion Amplify(const Motion& motion, double amplitude) {
  if (amplitude == 1 || motion.frames < 1) return motion;
  return MapColumns(motion, motion.frames, [&](const Column& x, const Meaning& meaning) {
    if (meaning.neck_position) return x;
    const double rest = Median(x);
    Column out(x.size());
    std::transform(x.begin(), x.end(), out.begin(),
                   [&](double value) { return rest + amplitude * (value - rest); });
    return out;
  });
}

Motion Clamp(const Motion& motion) {
  return MapColumns(motion, motion.frames, [](const Column& x, const Meaning& meaning) {
    const Curve* curve = meaning.curve;
    Column out = x;
    if (curve == nullptr || !curve->name.starts_with("AU") || !(curve->minimum < curve->maximum))
      return out;
    for (double& value : out) value = std::clamp<double>(value, curve->minimum, curve->maximum);
    return out;
  });
}

std::vector<Jerk> MeanJerk(const Motion& motion) {
  std::vector<Jerk> jerks;
  const auto add = [&](const char* part, const std::string& unit, std::optional<double> value) {
    if (value.has_value()) jerks.push_back({part, unit + "/s^3", *value});
  };
  const auto figure = [&](const char* part, const std::optional<Figure>& from, bool body) {
    if (!from.has_value()) return;
    const std::size_t points = from->points.size();
    std::vector<std::vector<std::size_t>> vectors;
    for (std::size_t p = 0; p < points; ++p)
      if (!body || !IsNeck(from->points[p])) vectors.push_back({p, points + p});
    std::optional<double> mean = MeanThird(motion, from->values, 2 * points, vectors);
    if (mean.has_value() && motion.normalised) *mean /= kShoulder;
    add(part, motion.normalised ? "shoulder lengths" : "pixels", mean);
  };
  figure("body", motion.body, true);
  figure("face", motion.face, false);
  if (!motion.curves.has_value()) return jerks;
  std::vector<std::vector<std::size_t>> units, angles;
  const std::vector<Curve>& curves = motion.curves->curves;
  for (std::size_t c = 0; c < curves.size(); ++c)
    (curves[c].name.starts_with("AU") ? units : angles).push_back({c});
  add("action units", "intensity", MeanThird(motion, motion.curves->values, curves.size(), units));
  add("angles", "rad", MeanThird(motion, motion.curves->values, curves.size(), angles));
  return jerks;
}

Result<Finished> Finish(const Motion& motion, const FinishOptions& options) {
  GESTUS_RETURN_IF_ERROR(CheckOptions(motion, options));
  Finished done;
  done.before = MeanJerk(motion);
  const double rate = options.frame_rate == 0 ? motion.frame_rate : options.frame_rate;
  done.motion = Amplify(CrossFade(motion, options.crossfade), options.amplitude);
  // Where there are more frames a smoothed value sees most, and none is left out before it has.
  if (rate < motion.frame_rate) {
    done.motion = Resample(Smooth(done.motion, options.smooth), rate, options.interpolation);
  } else {
    done.motion = Smooth(Resample(done.motion, rate, options.interpolation), options.smooth);
  }
  const Motion& smoothed = rate < motion.frame_rate ? motion : done.motion;
  if (options.smooth > 0 && HalfWindow(smoothed, options.smooth) == 0)
    done.notes.push_back("smoothing of " + Significant(options.smooth, 3) + " s sees less than " +
                         std::to_string(kLeastWindow) + " frames of " +
                         Count(static_cast<std::uint64_t>(smoothed.frames), "frame") + " at " +
                         Significant(smoothed.frame_rate, 4) + " a second: nothing was smoothed");
  done.motion = Clamp(done.motion);
  done.after = MeanJerk(Resample(done.motion, motion.frame_rate));
  return done;
}

}  // namespace gestus::outputs
