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
  kExport,
  kEval,
  kCheck,
  kVersion,
  kHelp
};

/// infer-cli eval
struct EvalOptions {
  std::string predictions, truth, source, target;  ///< files or folders; empty: not given
  std::string classifier;  ///< network of the weights file; empty: the only one, if any
  int median = 7;          ///< frames
  double order = 2;        ///< of Minkowski distances
  double rate = 0;         ///< frames per second of arrays; 0: as the weights say
};

struct Arguments {
  Command command = Command::kInfer;
  std::string weights;
  std::vector<std::string> inputs;  ///< kStyle: clips; kStyleInfo and so on: styles
  std::string words;                ///< a transcript, whatever it looks like
  std::string output;  ///< never empty for kInfer, kStyle, kFeatures and what makes files of styles
  bool no_sound = false;  ///< kFeatures: without log_mel, pitch and the quality of the voice
  double pose_rate = 0;   ///< frames per second of OpenPose's files; 0: found out
  std::string style;
  std::vector<std::string> exports;   ///< FORMAT=PATH each
  std::vector<float> stance;          ///< X, Y and length of the shoulder; empty: the default
  bool halve = false;                 ///< OpenFace's values
  std::string html, svg, mp4, title;  ///< what to look at; empty: not wanted
  std::string source, target;         ///< motion to show beside it
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
  EvalOptions eval;
  std::string help;  ///< kHelp: the text to print

  /// "speech.wav, words.json"
  std::string Input() const;
};

Result<Arguments> ParseArguments(int argc, const char* const* argv);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_ARGS_H_
