#include "models/metrics/behaviour.h"

#include <algorithm>
#include <cmath>

#include "models/metrics/points.h"

namespace gestus::metrics {
namespace {

using outputs::Figure;

constexpr std::int64_t kOrders = 3;
// Of the finite differences of order 1, 2 and 3, for the frames t, t+1 and so on.
constexpr double kDifference[kOrders][kOrders + 1] = {{-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}};
constexpr std::size_t kPerimeter = 6;

double Norm(const Figure& body, std::size_t point, std::int64_t frame, std::int64_t order) {
  double x = 0, y = 0;
  for (std::int64_t i = 0; i <= order; ++i) {
    const double weight = kDifference[order - 1][i];
    x += weight * body.x(frame + i, point);
    y += weight * body.y(frame + i, point);
  }
  return std::hypot(x, y);
}

void AddDifferences(const Figure& body, std::int64_t frames, double rate,
                    std::span<const std::size_t> points, std::size_t at, BehaviourSums* sums) {
  double scale = 1;
  for (std::int64_t order = 1; order <= kOrders; ++order, ++at) {
    scale *= rate;
    for (std::int64_t frame = 0; frame + order < frames; ++frame) {
      for (const std::size_t point : points)
        sums->sums[at] += scale * Norm(body, point, frame, order);
      sums->counts[at] += static_cast<std::int64_t>(points.size());
    }
  }
}

double Perimeter(const Figure& body, std::int64_t frame, std::span<const std::size_t> points,
                 bool neck) {
  double left = neck ? 0 : body.x(frame, points[0]), right = left;
  double top = neck ? 0 : body.y(frame, points[0]), bottom = top;
  for (const std::size_t point : points) {
    left = std::min<double>(left, body.x(frame, point));
    right = std::max<double>(right, body.x(frame, point));
    top = std::min<double>(top, body.y(frame, point));
    bottom = std::max<double>(bottom, body.y(frame, point));
  }
  return 2 * (right - left + bottom - top);
}

std::vector<std::size_t> Wrists(const Figure& body, std::span<const std::int64_t> sources) {
  std::vector<std::int64_t> wrists;
  for (const std::int64_t source : sources) {
    if (source == kRightWrist || source == kLeftWrist) wrists.push_back(source);
  }
  return PointsWith(body, wrists);
}

}  // namespace

void BehaviourSums::Add(const BehaviourSums& other) {
  for (std::size_t i = 0; i < kBehaviours; ++i) {
    sums[i] += other.sums[i];
    counts[i] += other.counts[i];
  }
}

Behaviour BehaviourSums::Mean() const {
  Behaviour means;
  for (std::size_t i = 0; i < kBehaviours; ++i)
    means[i] = Ratio(sums[i], static_cast<double>(counts[i]));
  return means;
}

BehaviourSums SumBehaviour(const Figure& body, std::int64_t frames, double rate,
                           std::span<const std::int64_t> sources) {
  BehaviourSums sums;
  const std::vector<std::size_t> joints = PointsWith(body, sources);
  AddDifferences(body, frames, rate, joints, 0, &sums);
  AddDifferences(body, frames, rate, Wrists(body, sources), kOrders, &sums);
  if (joints.empty()) return sums;
  const bool neck = std::any_of(body.points.begin(), body.points.end(),
                                [](const outputs::Point& p) { return p.source == kNeck; });
  for (std::int64_t frame = 0; frame < frames; ++frame)
    sums.sums[kPerimeter] += Perimeter(body, frame, joints, neck);
  sums.counts[kPerimeter] = frames;
  return sums;
}

std::vector<double> WristSpeed(const Figure& body, std::int64_t frames, double rate) {
  constexpr std::int64_t kBoth[] = {kRightWrist, kLeftWrist};
  const std::vector<std::size_t> wrists = PointsWith(body, kBoth);
  std::vector<double> speed;
  if (wrists.empty()) return speed;
  for (std::int64_t frame = 0; frame + 1 < frames; ++frame) {
    double sum = 0;
    for (const std::size_t wrist : wrists) sum += rate * Norm(body, wrist, frame, 1);
    speed.push_back(sum / static_cast<double>(wrists.size()));
  }
  return speed;
}

StyleDistance DistanceToTarget(const Measure& source, const Measure& prediction,
                               const Measure& target) {
  StyleDistance distance;
  if (source && target) distance.source = std::abs(*source - *target);
  if (prediction && target) distance.prediction = std::abs(*prediction - *target);
  if (!distance.source || !distance.prediction) return distance;
  const double whole = *distance.source + *distance.prediction;
  distance.source_percent = Ratio(100 * *distance.source, whole);
  distance.prediction_percent = Ratio(100 * *distance.prediction, whole);
  return distance;
}

}  // namespace gestus::metrics
