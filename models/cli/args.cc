// Declares the command line to CLI11, which also writes the help from these declarations.
#include "models/cli/args.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace gestus::cli {
namespace {

constexpr const char* kFooter = R"(
Examples:
  infer-cli weights.fb speech.wav --words speech.json --style anna/ -o motion.npz
  infer-cli weights.fb speech.wav --html motion.html    the same to watch, in a browser
  infer-cli weights.fb arrays.npz                       motion into arrays.out.npz
  infer-cli style extract weights.fb anna/ -o anna.style
                                                        a speaker's style, once and for all
  infer-cli style blend anna.style:0.7 bob.style:0.3 -o both.style
  infer-cli features weights.fb speech.wav speech.json  what the networks are fed with
  infer-cli export weights.fb m.npz --export bvh=m.bvh  motion for other programs
  infer-cli info weights.fb                             what a file holds, takes and gives
  infer-cli eval made/ filmed/ -o report.html           how good is the motion?
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
  app->add_option("--words", a->words,
                  "Transcript, with times or plain text, where INPUT does not hold it")
      ->type_name("FILE");
  app->add_option("--pose-fps", a->pose_rate,
                  "Frames per second of OpenPose's files; default: as the recording's length says")
      ->type_name("FPS")
      ->check(CLI::Range(1.0, 1000.0, ""));
}

// Files of other programs.
CLI::Option* AddExport(CLI::App* app, Arguments* a) {
  app->add_option("--stance", a->stance,
                  "Where the figure stands in OpenPose's picture: pixels of the neck and of the "
                  "length from there to the shoulder; default 640,360,100")
      ->type_name("X,Y,LENGTH")
      ->delimiter(',')
      ->expected(3);
  app->add_flag("--halve", a->halve, "Halve OpenFace's values, as the author did to animate");
  return app
      ->add_option(
          "--export", a->exports,
          "Write the motion as openpose, openface, openface2, csv, bvh, bvh3d, arkit, vrm, vrma, "
          "fap or bap; may be repeated")
      ->type_name("FORMAT=PATH")
      ->allow_extra_args(false);
}

// What to look at afterwards.
void AddViews(CLI::App* app, Arguments* a) {
  app->add_option("--html", a->html, "A page that plays the motion beside the recording")
      ->type_name("FILE");
  app->add_option("--svg", a->svg, "A contact sheet: figures over time")->type_name("FILE");
  app->add_option("--mp4", a->mp4, "A video, where the program ffmpeg is installed")
      ->type_name("FILE");
  app->add_option("--title", a->title, "Title of these; default: the recording's name")
      ->type_name("TEXT");
  app->add_option("--source", a->source,
                  "Motion of the source speaker to show beside it, arrays like the output's")
      ->type_name("FILE.npz");
  app->add_option("--target", a->target, "The same of the target speaker")->type_name("FILE.npz");
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
  AddExport(app, a);
  AddRecording(app, a);
  AddViews(app, a);
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

CLI::App* AddEval(CLI::App* app, Arguments* a) {
  CLI::App* eval = app->add_subcommand("eval", "Measure motion as the thesis' evaluations do");
  EvalOptions* e = &a->eval;
  eval->add_option("PREDICTIONS", e->predictions,
                   "Arrays (.npz), OpenFace's CSV, a folder of OpenPose's frames, or a folder of "
                   "many of these")
      ->type_name("FILE")
      ->required();
  eval->add_option("TRUTH", e->truth, "The same of the truth, paired by name")->type_name("FILE");
  eval->add_option("--source", e->source, "Motion of the speaker who is heard")->type_name("FILE");
  eval->add_option("--target", e->target, "Motion of the speaker whose style it is")
      ->type_name("FILE");
  eval->add_option("--weights", a->weights, "Weights file: names joints, holds the classifier")
      ->type_name("FILE.fb");
  eval->add_option("--classifier", e->classifier, "Network that judges transfer strength")
      ->type_name("NAME");
  eval->add_option("--median", e->median, "Median filter over curves; default 7 frames, 1: none")
      ->type_name("N")
      ->check(CLI::Range(1, 99, ""));
  eval->add_option("--order", e->order, "Order of Minkowski distances; default 2")
      ->type_name("P")
      ->check(CLI::Range(1.0, 100.0, ""));
  eval->add_option("--fps", e->rate,
                   "Frames per second of arrays; default: as the weights say, or 15 for poses and "
                   "24 for curves")
      ->type_name("FPS")
      ->check(CLI::Range(1.0, 240.0, ""));
  eval->add_option("--pose-fps", a->pose_rate, "Frames per second of OpenPose's files; default 15")
      ->type_name("FPS")
      ->check(CLI::Range(1.0, 1000.0, ""));
  eval->add_option("-o,--output", a->output, "Report, by its ending .html, .csv, .json or .txt")
      ->type_name("FILE");
  AddCompute(eval, a);
  AddShared(eval, a);
  return eval;
}

// What becomes of the motion; without any of these it stays as the network said it.
std::vector<CLI::Option*> AddFinish(CLI::App* app, outputs::FinishOptions* options) {
  std::vector<CLI::Option*> all = {
      app->add_option("--fps", options->frame_rate,
                      "Frames per second of the motion; default: the network's")
          ->type_name("FPS")
          ->check(CLI::Range(1.0, outputs::kMaxFinishRate, "")),
      app->add_option("--crossfade", options->crossfade,
                      "Seconds over which the jump at a segment's border fades on each side; "
                      "default 0.3, where any of these options is given")
          ->type_name("SECONDS")
          ->check(CLI::Range(0.0, outputs::kMaxFinishSeconds, "")),
      app->add_option("--smooth", options->smooth,
                      "Seconds of motion that make each smoothed frame; default 0, not at all")
          ->type_name("SECONDS")
          ->check(CLI::Range(0.0, outputs::kMaxFinishSeconds, "")),
      app->add_option(
             "--amplitude", options->amplitude,
             "How far motion goes from the rest pose: 0 still, 1 as it is (default), to 10")
          ->type_name("A")
          ->check(CLI::Range(0.0, outputs::kMaxAmplitude, "")),
      app->add_flag_callback(
          "--linear", [options] { options->interpolation = outputs::Interpolation::kLinear; },
          "Straight lines between frames instead of cubics without overshoot")};
  for (CLI::Option* option : all) option->group("Finish");
  return all;
}

// `infer-cli style`, and its own commands.
struct StyleCommands {
  CLI::App *all = nullptr, *info = nullptr, *blend = nullptr, *distance = nullptr,
           *gallery = nullptr;
};

void AddExtract(CLI::App* app, Arguments* a) {
  app->add_option("WEIGHTS", a->weights, "Weights file")->type_name("FILE.fb");
  app->add_option("CLIP", a->inputs,
                  "Recording, words and poses of the speaker; or folders of these and arrays "
                  "(.npz), each a clip of its own")
      ->type_name("FILE");
  app->add_option("-o,--output", a->output, "The style file")->type_name("FILE.style");
  AddRecording(app, a);
  AddCompute(app, a);
  AddShared(app, a);
}

CLI::App* AddOnStyles(CLI::App* style, Arguments* a, const char* name, const char* meaning,
                      const char* takes, const char* output) {
  CLI::App* app = style->add_subcommand(name, meaning);
  app->add_option("STYLE", a->inputs, takes)->type_name("FILE")->required();
  if (output != nullptr)
    app->add_option("-o,--output", a->output, output)->type_name("FILE")->required();
  app->add_flag("--json", a->json, "Report as JSON on the standard output");
  return app;
}

StyleCommands AddStyle(CLI::App* app, Arguments* a) {
  constexpr const char* kTakes = "Style files, and the weights file that made them if it is there";
  StyleCommands style;
  style.all = app->add_subcommand("style", "Compute, mix, compare and show speakers' styles");
  style.all->require_subcommand(0, 1);
  AddExtract(style.all, a);  // `extract` may be left out
  AddExtract(style.all->add_subcommand("extract", "Compute a speaker's style from clips, to reuse"),
             a);
  style.info = AddOnStyles(style.all, a, "info", "Show what style files hold", kTakes, nullptr);
  style.blend = AddOnStyles(style.all, a, "blend", "Mix styles into one",
                            "Style files, each with :WEIGHT or not", "The style file");
  style.distance =
      AddOnStyles(style.all, a, "distance", "How far styles are from one another", kTakes, nullptr);
  style.gallery = AddOnStyles(style.all, a, "gallery", "A page with maps of styles", kTakes,
                              "The page (.html)");
  return style;
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
  outputs::FinishOptions finish;
  const std::vector<CLI::Option*> finishing = AddFinish(&app, &finish);
  app.add_flag("--version", version, "Version, instruction sets and compiler");

  CLI::App* info = app.add_subcommand("info", "Show what a weights file holds, takes and gives");
  info->add_option("WEIGHTS", a.weights, "Weights file")->type_name("FILE.fb")->required();
  info->add_flag("--plan", a.plan, "The planned ops and where the arena keeps their values");
  AddShared(info, &a);

  const StyleCommands style = AddStyle(&app, &a);

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
  features->add_flag("--no-sound", a.no_sound,
                     "Leave out the stages of the sound, which take the most time: log_mel, pitch "
                     "and the quality of the voice");
  AddRecording(features, &a);
  AddCompute(features, &a);
  AddShared(features, &a);

  CLI::App* convert = app.add_subcommand("export", "Write motion in the files of other programs");
  convert->add_option("WEIGHTS", a.weights, "Weights file")->type_name("FILE.fb")->required();
  convert->add_option("MOTION", a.inputs, "What a run has put out")
      ->type_name("FILE.npz")
      ->expected(1)
      ->required();
  AddExport(convert, &a)->required();
  AddShared(convert, &a);

  CLI::App* eval = AddEval(&app, &a);

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
  if (convert->parsed()) a.command = Command::kExport;
  if (style.all->parsed()) a.command = Command::kStyle;
  for (const auto& [app_of, command] : {std::pair(style.info, Command::kStyleInfo),
                                        {style.blend, Command::kStyleBlend},
                                        {style.distance, Command::kStyleDistance},
                                        {style.gallery, Command::kStyleGallery}}) {
    if (app_of->parsed()) a.command = command;
  }
  if (a.command == Command::kStyle) {
    if (a.weights.empty()) return Missing("WEIGHTS");
    if (a.inputs.empty()) return Missing("CLIP");
    if (a.output.empty()) return Missing("--output");
  }
  if (check->parsed()) a.command = Command::kCheck;
  if (eval->parsed()) a.command = Command::kEval;
  if (features->parsed()) {
    a.command = Command::kFeatures;
    if (a.output.empty()) a.output = DefaultOutput(a.inputs.front(), ".features.npz");
  }
  if (a.command != Command::kInfer) return a;
  const auto given = [](const CLI::Option* option) { return option->count() > 0; };
  if (std::any_of(finishing.begin(), finishing.end(), given)) a.finish = finish;
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
