// The command line of infer-cli.
#ifndef GESTUS_MODELS_CLI_ARGS_H_
#define GESTUS_MODELS_CLI_ARGS_H_

#include <string>

#include "engine/status.h"
#include "models/network.h"

namespace gestus::cli {

enum class Command { kInfer, kInfo, kStyle, kCheck, kVersion, kHelp };

struct Arguments {
  Command command = Command::kInfer;
  std::string weights;
  std::string input;   ///< kStyle: the clip
  std::string output;  ///< never empty for kInfer and kStyle
  std::string style;
  std::string network;
  std::string isa;
  int threads = 1;
  int repeat = 1;
  models::Sampling sampling;
  bool profile = false;
  bool plan = false;
  bool taps = false;
  bool json = false;
  std::string help;  ///< kHelp: the text to print
};

Result<Arguments> ParseArguments(int argc, const char* const* argv);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_ARGS_H_
