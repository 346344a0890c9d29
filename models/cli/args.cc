// Declares the command line to CLI11, which also writes the help from these declarations.
#include "models/cli/args.h"

#include <CLI/CLI.hpp>

namespace gestus::cli {
namespace {

constexpr const char* kFooter = R"(
Examples:
  infer-cli weights.fb speech.npz                       motion into speech.out.npz
  infer-cli weights.fb speech.npz --style anna.style -o motion.npz
  infer-cli style weights.fb clip.npz -o anna.style     a speaker's style, once and for all
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
  app->add_option("--isa", a->isa, "Instruction set: scalar, sse2, avx2, avx512 or neon")
      ->type_name("NAME");
}

void AddInfer(CLI::App* app, Arguments* a) {
  app->add_option("WEIGHTS", a->weights, "Weights file")->type_name("FILE.fb");
  app->add_option("INPUT", a->input, "Input arrays; infer-cli info WEIGHTS names them")
      ->type_name("FILE.npz");
  app->add_option("-o,--output", a->output, "Output arrays; default: INPUT with .out.npz for .npz")
      ->type_name("FILE.npz");
  app->add_option("--style", a->style, "Style: a .style file, or a clip (.npz) to take it from")
      ->type_name("FILE");
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

// "a/speech.npz" -> "a/speech.out.npz"
std::string DefaultOutput(const std::string& input) {
  const bool known = input.ends_with(".npz") || input.ends_with(".npy");
  return (known ? input.substr(0, input.size() - 4) : input) + ".out.npz";
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
  style->add_option("CLIP", a.input, "speech, text and pose of the speaker (.npz)")
      ->type_name("FILE.npz")
      ->required();
  style->add_option("-o,--output", a.output, "The style file")->type_name("FILE.style")->required();
  AddCompute(style, &a);
  AddShared(style, &a);

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
  if (a.command != Command::kInfer) return a;
  if (a.weights.empty()) return Missing("WEIGHTS");
  if (a.input.empty()) return Missing("INPUT.npz");
  if (a.output.empty()) a.output = DefaultOutput(a.input);
  return a;
}

}  // namespace gestus::cli
