// Declares the command line to CLI11, which also writes the help from these declarations.
#include "models/cli/args.h"

#include <CLI/CLI.hpp>

namespace gestus::cli {
namespace {

constexpr const char* kFooter = R"(
Examples:
  infer-cli weights.fb speech.wav --words speech.json --style anna/ -o motion.npz
  infer-cli weights.fb arrays.npz                       motion into arrays.out.npz
  infer-cli style weights.fb anna/ -o anna.style        a speaker's style, once and for all
  infer-cli features weights.fb speech.wav speech.json  what the networks are fed with
  infer-cli info weights.fb                             what a file holds, takes and gives
  infer-cli check weights.fb                            does it compute here what it should?

Exit codes: 0 done; 2 an error, told in one line on the standard error output. Outputs are complete
or not written at all. GESTUS_ISA=<name> in the environment lowers the instruction set as --isa does.)";

void AddShared(CLI::App* app, Arguments* a) {
  app->add_option("--network", a->network, "Network of a file that holds several")
      ->type_name("NAME");
  app->add_flag("--json", a->json, "Report as JSON on the standard output");
}

void AddCompute(CLI::App* app, Arguments* a) {
  app->add_option("--threads", a->threads,
                  "Threads that compute, 1 to 64, default 1; results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 64, ""));
  app->add_option("--isa", a->isa, "Instruction set, such as scalar, avx2 or avx512 (see --version)")
      ->type_name("NAME");
}

// What recordings need to be said of.
void AddRecording(CLI::App* app, Arguments* a) {
  app->add_option("--words", a->words, "Transcript with times, where INPUT does not hold it")
      ->type_name("FILE");
  app->add_option("--pose-fps", a->pose_rate,
                  "Frames per second of OpenPose's files; default: as the recording's length says")
      ->type_name("FPS")
      ->check(CLI::Range(1.0, 1000.0, ""));
}

void AddInfer(CLI::App* app, Arguments* a) {
  app->add_option("WEIGHTS", a->weights, "Weights file")->type_name("FILE.fb");
  app->add_option("INPUT", a->inputs,
                  "Recording, transcript, arrays (.npz; infer-cli info WEIGHTS names them), or a "
                  "folder of these")
      ->type_name("FILE");
  app->add_option("-o,--output", a->output,
                  "Output arrays; default: the first INPUT with .out.npz for its ending")
      ->type_name("FILE.npz");
  app->add_option("--style", a->style,
                  "Style: a .style file, a clip (.npz), or a folder with a speaker's recording, "
                  "words and poses")
      ->type_name("FILE");
  AddRecording(app, a);
  AddCompute(app, a);
  app->add_option("--repeat", a->repeat, "Runs of each segment, for timing; default 1")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000, ""));
  app->add_option("--temperature", a->sampling.temperature,
                  "Variety of networks that choose tokens; default 0, always the likeliest")
      ->type_name("T")
      ->check(CLI::Range(0.0, 100.0, ""));
  app->add_option("--top-k", a->sampling.top_k, "Draw among the K likeliest tokens; default 0, all")
      ->type_name("K")
      ->check(CLI::Range(0, 1000000, ""));
  app->add_option("--seed", a->sampling.seed, "The same seed draws the same tokens; default 0")
      ->type_name("N");
  app->add_flag("--profile", a->profile, "Time, GFLOP/s and GB/s of every op");
  app->add_flag("--plan", a->plan, "The planned ops and where the arena keeps their values");
  app->add_flag("--taps", a->taps, "Add named intermediates to the output, as tap/NAME");
  AddShared(app, a);
}

// "a/speech.wav" -> "a/speech.out.npz"
std::string DefaultOutput(std::string input, const std::string& ending) {
  while (input.size() > 1 && input.ends_with('/')) input.pop_back();
  const std::size_t slash = input.rfind('/');
  const std::size_t name = slash == std::string::npos ? 0 : slash + 1;
  const std::size_t point = input.rfind('.');
  const bool has_ending = point != std::string::npos && point > name;
  return input.substr(0, has_ending ? point : input.size()) + ending;
}

Status Missing(const std::string& what) {
  return Status(Code::kInvalidArgument,
                "command line: no " + what + ", expected as shown by infer-cli --help");
}

}  // namespace

Result<Arguments> ParseArguments(int argc, const char* const* argv) {
  Arguments a;
  bool version = false;
  CLI::App app("Speech to expressive face and body motion on the CPU.", "infer-cli");
  app.footer(kFooter);
  app.require_subcommand(0, 1);
  AddInfer(&app, &a);
  app.add_flag("--version", version, "Version, instruction sets and compiler");

  CLI::App* info = app.add_subcommand("info", "Show what a weights file holds, takes and gives");
  info->add_option("WEIGHTS", a.weights, "Weights file")->type_name("FILE.fb")->required();
  info->add_flag("--plan", a.plan, "The planned ops and where the arena keeps their values");
  AddShared(info, &a);

  CLI::App* style = app.add_subcommand("style", "Compute a speaker's style from a clip, to reuse");
  style->add_option("WEIGHTS", a.weights, "Weights file")->type_name("FILE.fb")->required();
  style
      ->add_option("CLIP", a.inputs,
                   "Recording, words and poses of the speaker, arrays (.npz), or a folder of these")
      ->type_name("FILE")
      ->required();
  style->add_option("-o,--output", a.output, "The style file")->type_name("FILE.style")->required();
  AddRecording(style, &a);
  AddCompute(style, &a);
  AddShared(style, &a);

  CLI::App* features =
      app.add_subcommand("features", "Write what recordings and words are made into, every stage");
  features
      ->add_option("INPUT", a.inputs,
                   "Weights file, recording, transcript, OpenPose or OpenFace files, or a folder "
                   "of these")
      ->type_name("FILE")
      ->required();
  features
      ->add_option("-o,--output", a.output,
                   "The arrays; default: the first INPUT with .features.npz for its ending")
      ->type_name("FILE.npz");
  AddRecording(features, &a);
  AddCompute(features, &a);
  AddShared(features, &a);

  CLI::App* check = app.add_subcommand("check", "Run the self-tests that a weights file carries");
  check->add_option("WEIGHTS", a.weights, "Weights file")->type_name("FILE.fb")->required();
  AddCompute(check, &a);
  AddShared(check, &a);

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    a.command = Command::kHelp;
    a.help = app.help();
    return a;
  } catch (const CLI::ParseError& error) {
    return Status(Code::kInvalidArgument, std::string("command line: ") + error.what() +
                                              ", expected as shown by infer-cli --help");
  }
  if (version) a.command = Command::kVersion;
  if (info->parsed()) a.command = Command::kInfo;
  if (style->parsed()) a.command = Command::kStyle;
  if (check->parsed()) a.command = Command::kCheck;
  if (features->parsed()) {
    a.command = Command::kFeatures;
    if (a.output.empty()) a.output = DefaultOutput(a.inputs.front(), ".features.npz");
  }
  if (a.command != Command::kInfer) return a;
  if (a.weights.empty()) return Missing("WEIGHTS");
  if (a.inputs.empty() && !a.words.empty()) a.inputs = {a.words};
  if (a.inputs.empty()) return Missing("INPUT");
  if (a.output.empty()) a.output = DefaultOutput(a.inputs.front(), ".out.npz");
  return a;
}

std::string Arguments::Input() const {
  std::string text;
  for (const std::string& input : inputs) text += (text.empty() ? "" : ", ") + input;
  return text;
}

}  // namespace gestus::cli
