#include "models/metrics/points.h"

#include <algorithm>

namespace gestus::metrics {
namespace {

using outputs::Figure;

bool Has(const Figure& figure, std::int64_t source) {
  return std::any_of(figure.points.begin(), figure.points.end(),
                     [source](const outputs::Point& point) { return point.source == source; });
}

struct Column {
  const Figure* figure;
  std::size_t point;
};

}  // namespace

std::vector<std::int64_t> SharedSources(std::span<const Figure* const> figures, Part part) {
  std::vector<std::int64_t> shared;
  const auto first = std::find_if(figures.begin(), figures.end(),
                                  [](const Figure* figure) { return figure != nullptr; });
  if (first == figures.end()) return shared;
  for (const outputs::Point& point : (*first)->points) {
    if (part == Part::kBody && point.source == kNeck) continue;
    const bool everywhere = std::all_of(figures.begin(), figures.end(), [&](const Figure* figure) {
      return figure == nullptr || Has(*figure, point.source);
    });
    const bool new_one = std::find(shared.begin(), shared.end(), point.source) == shared.end();
    if (everywhere && new_one) shared.push_back(point.source);
  }
  return shared;
}

std::vector<std::size_t> PointsWith(const Figure& figure, std::span<const std::int64_t> sources) {
  std::vector<std::size_t> points;
  for (const std::int64_t source : sources) {
    for (std::size_t i = 0; i < figure.points.size(); ++i) {
      if (figure.points[i].source != source) continue;
      points.push_back(i);
      break;
    }
  }
  return points;
}

std::vector<float> Coordinates(const outputs::Motion& motion, std::int64_t frames,
                               std::span<const std::int64_t> body_sources,
                               std::span<const std::int64_t> face_sources) {
  std::vector<Column> columns;
  const auto add = [&](const std::optional<Figure>& figure, std::span<const std::int64_t> sources) {
    if (!figure) return;
    for (const std::size_t point : PointsWith(*figure, sources))
      columns.push_back({&*figure, point});
  };
  add(motion.body, body_sources);
  add(motion.face, face_sources);
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(frames) * 2 * columns.size());
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    for (const auto& [figure, point] : columns) values.push_back(figure->x(frame, point));
    for (const auto& [figure, point] : columns) values.push_back(figure->y(frame, point));
  }
  return values;
}

}  // namespace gestus::metrics
