// Plots as SVG that stands in a page: colours come from the page's classes, so that they follow its
// dark and light.
#ifndef GESTUS_MODELS_CLI_EVAL_SVG_H_
#define GESTUS_MODELS_CLI_EVAL_SVG_H_

#include <string>
#include <vector>

#include "models/metrics/measure.h"

namespace gestus::cli {

/// `text` with the characters that mean something in HTML escaped, on one line.
std::string Escaped(const std::string& text);

struct Bars {
  std::string name;                      ///< in the legend
  std::string color;                     ///< a class: "prediction", "truth", "source", "target"
  std::vector<metrics::Measure> values;  ///< one for each category; undefined: said so
};

/// Groups of bars, one for each category, with their values above.  `line`: a dashed one across.
std::string BarChart(const std::string& caption, const std::string& unit,
                     const std::vector<std::string>& categories, const std::vector<Bars>& bars,
                     const metrics::Measure& line = std::nullopt);

struct Line {
  std::string name, color;
  std::vector<double> values;
};

/// Curves over time at `rate` values per second.
std::string LineChart(const std::string& caption, const std::string& unit, double rate,
                      const std::vector<Line>& lines);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EVAL_SVG_H_
