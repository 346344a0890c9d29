// The command line of infer-cli.
#ifndef GESTUS_MODELS_CLI_ARGS_H_
#define GESTUS_MODELS_CLI_ARGS_H_

#include <optional>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/network.h"
#include "models/outputs/finish.h"

namespace gestus::cli {

enum class Command {
  kInfer,
  kInfo,
  kStyle,
  kStyleInfo,
  kStyleBlend,
  kStyleDistance,
  kStyleGallery,
  kFeatures,
  kCheck,
  kVersion,
  kHelp
};

struct Arguments {
  Command command = Command::kInfer;
  std::string weights;
  std::vector<std::string> inputs;  ///< kStyle: clips; kStyleInfo and so on: styles
  std::string words;                ///< a transcript, whatever it looks like
  std::string output;  ///< never empty for kInfer, kStyle, kFeatures and what makes files of styles
  double pose_rate = 0;  ///< frames per second of OpenPose's files; 0: found out
  std::string style;
  std::string network;
  std::string isa;
  int threads = 1;
  int repeat = 1;
  models::Sampling sampling;
  std::optional<outputs::FinishOptions> finish;  ///< as one of its options was given
  bool profile = false;
  bool plan = false;
  bool taps = false;
  bool json = false;
  std::string help;  ///< kHelp: the text to print

  /// "speech.wav, words.json"
  std::string Input() const;
};

Result<Arguments> ParseArguments(int argc, const char* const* argv);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_ARGS_H_
