// What infer-cli eval says: text for people, CSV and JSON for programs, a page with plots.
#ifndef GESTUS_MODELS_CLI_EVAL_REPORT_H_
#define GESTUS_MODELS_CLI_EVAL_REPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "models/cli/args.h"
#include "models/cli/eval_scores.h"

namespace gestus::cli {

enum class EvalFormat { kText, kCsv, kJson, kHtml };

/// By the ending of a file's name; empty: none of them.
std::optional<EvalFormat> FormatOf(const std::string& path);

struct EvalReport {
  const Arguments& arguments;
  const Material& material;
  const Evaluation& evaluation;
  std::string classifier;  ///< empty: none was run
  bool trained = true;     ///< false: the classifier's weights are random

  std::string In(EvalFormat format) const;
  std::string Text() const;
  /// A line for each figure: sequence, group, subject, measure, value, unit.  Undefined is empty.
  std::string Csv() const;
  /// Undefined is null.
  std::string Json() const;
  /// One file, nothing from the network.
  std::string Html() const;
};

/// A figure with its name, as CSV lists it and tables show it.
struct Figured {
  std::string group;    ///< "action units", "behaviour", "transfer"
  std::string subject;  ///< "AU01", "prediction"
  std::string measure;  ///< "rmse", "velocity"
  metrics::Measure value;
  std::string unit;
};
std::vector<Figured> FiguresOf(const Scores& scores);

/// "undefined", or a few digits.
std::string MeasureText(const metrics::Measure& measure);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EVAL_REPORT_H_
