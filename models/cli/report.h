// What infer-cli says after a run: a few friendly lines, or JSON.
#ifndef GESTUS_MODELS_CLI_REPORT_H_
#define GESTUS_MODELS_CLI_REPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "models/cli/args.h"
#include "models/cli/setup.h"
#include "models/network.h"
#include "models/outputs/finish.h"

namespace gestus::cli {

/// Seconds of one run of one segment, over all of them.
struct Timing {
  std::size_t segments = 0;
  double median = 0, p99 = 0;
  double times_real_time = 0;  ///< 0 when unknown
};
Timing Summarise(const models::RunReport& report, int repeat);

struct InferReport {
  const Arguments& arguments;
  const Setup& setup;
  const std::vector<std::string>& used;  ///< what was made of what, a line each
  const std::vector<std::string>& style_used;
  const models::Arrays& inputs;  ///< those that were given as such
  const models::Arrays& outputs;
  const std::vector<std::string>& exports;  ///< files of other programs, a line each
  const std::vector<std::string>& views;    ///< of --html, --svg and --mp4
  const models::RunReport& run;
  const std::optional<outputs::Finished>& finished;

  std::string Text() const;
  std::string Json() const;
};

/// "speech (192, 128), text (192, 768)"
std::string ArraysText(const models::Arrays& arrays);

/// Time, share, GFLOP/s and GB/s: first by kind of op, then of every op in order of execution.
std::string ProfileText(const std::vector<OpProfile>& ops);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_REPORT_H_
