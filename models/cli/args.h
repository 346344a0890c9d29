// The command line of infer-cli.
#ifndef GESTUS_MODELS_CLI_ARGS_H_
#define GESTUS_MODELS_CLI_ARGS_H_

#include <string>
#include <vector>

#include "engine/status.h"
#include "models/network.h"

namespace gestus::cli {

enum class Command { kInfer, kInfo, kStyle, kFeatures, kCheck, kVersion, kHelp };

struct Arguments {
  Command command = Command::kInfer;
  std::string weights;
  std::vector<std::string> inputs;  ///< kStyle: the clip
  std::string words;                ///< a transcript, whatever it looks like
  std::string output;               ///< never empty for kInfer, kStyle and kFeatures
  double pose_rate = 0;             ///< frames per second of OpenPose's files; 0: found out
  std::string style;
  std::string html, svg, mp4, title;  ///< what to look at; empty: not wanted
  std::string source, target;         ///< motion to show beside it
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

  /// "speech.wav, words.json"
  std::string Input() const;
};

Result<Arguments> ParseArguments(int argc, const char* const* argv);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_ARGS_H_
