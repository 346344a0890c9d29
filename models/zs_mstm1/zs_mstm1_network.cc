// Named arrays of any length, cut into segments for ZS-MSTM 1.0.
#include "models/zs_mstm1/zs_mstm1_network.h"

#include <algorithm>
#include <cstring>

#include "models/run_support.h"
#include "models/segments.h"
#include "models/zs_mstm1/zs_mstm1.h"

namespace gestus::models {
namespace {

constexpr std::int64_t kAny = ArraySpec::kAny;

Signature MakeSignature(const ZsMstm1Config& c) {
  const std::int64_t mel = c.ast_content.mel_bins;
  const auto spec = [](const char* name, std::int64_t cols, const char* axis, const char* unit,
                       const char* meaning) {
    ArraySpec s;
    s.name = name;
    s.shape = {kAny, cols};
    s.axes = {"frames", axis};
    s.required = false;
    s.unit = unit;
    s.meaning = meaning;
    return s;
  };
  const char* pose_unit = "as the pose statistics: PATS pixels, x of every joint then y";
  ArraySpec style = spec("style", 0, "", "-", "a style kept from an earlier run");
  style.shape = {c.StyleWidth()};
  style.axes = {"values"};
  Signature s;
  s.inputs = {
      spec("speech", mel, "mel bins", "ln power", "log-mel spectrogram of the speech"),
      spec("text", c.d_text, "features", "-", "BERT features of the words, aligned with speech"),
      style,
      spec("style_speech", mel, "mel bins", "ln power", "speech of the target speaker's clip"),
      spec("style_text", c.d_text, "features", "-", "words of the target speaker's clip"),
      spec("style_pose", c.d_pose, "coordinates", pose_unit, "poses of the target speaker's clip"),
  };
  style.meaning = "the style that was used: keep it and give it again";
  style.required = true;
  ArraySpec pose = spec("pose", c.d_pose, "coordinates", pose_unit, "the generated poses");
  s.outputs = {pose, style};
  return s;
}

class ZsMstm1Network final : public Network {
 public:
  ZsMstm1Network(std::shared_ptr<const ZsMstm1> model, std::string name,
                 const NetworkOptions& options)
      : model_(std::move(model)),
        name_(std::move(name)),
        options_(options),
        signature_(MakeSignature(model_->config())) {}

  const char* kind() const override { return "ZS-MSTM 1.0"; }
  const Signature& signature() const override { return signature_; }

  std::string PlanText() const override {
    return "style encoder\n" + model_->style_plan()->ToString() + "generator\n" +
           model_->generator_plan()->ToString();
  }

  Result<Arrays> Run(const Arrays& inputs, const RunOptions& options, RunReport* report) override;

 private:
  Result<std::unique_ptr<ZsMstm1Agent>> NewAgent(const RunOptions& options) const;
  Status RunStyle(const Arrays& inputs, const RunOptions& options, RunReport* report,
                  ZsMstm1Agent& agent, Progress& progress) const;
  Status RunGenerator(const Arrays& inputs, const RunOptions& options, RunReport* report,
                      ZsMstm1Agent& agent, Progress& progress, Array* pose) const;

  std::shared_ptr<const ZsMstm1> model_;
  std::string name_;
  NetworkOptions options_;
  Signature signature_;
};

bool Has(const Arrays& inputs, const char* name) { return inputs.count(name) != 0; }

std::int64_t Frames(const Arrays& inputs, const char* name) {
  return Has(inputs, name) ? inputs.at(name).shape[0] : 0;
}

/// All of `names` are given, with as many frames each; or none is, and the result is false.
Result<bool> Together(const Arrays& inputs, std::initializer_list<const char*> names) {
  const char* first = *names.begin();
  for (const char* name : names) {
    if (Has(inputs, name) != Has(inputs, first))
      return Status(Code::kBadInput, std::string(Has(inputs, name) ? first : name) +
                                         ": missing, expected beside " +
                                         (Has(inputs, name) ? name : first));
    if (Frames(inputs, name) != Frames(inputs, first))
      return Status(Code::kBadInput, std::string(name) + ": " +
                                         std::to_string(Frames(inputs, name)) +
                                         " frames, expected those of " + first + ", " +
                                         std::to_string(Frames(inputs, first)));
  }
  return Has(inputs, first);
}

void Note(RunReport* report, const std::string& note) {
  if (report != nullptr && !note.empty()) report->notes.push_back(note);
}

Result<std::unique_ptr<ZsMstm1Agent>> ZsMstm1Network::NewAgent(const RunOptions& options) const {
  std::shared_ptr<const ZsMstm1> model = model_;
  if (options.taps) {
    ZsMstm1Options with_taps;
    with_taps.kernels = &model->generator_plan()->kernels();
    with_taps.plan.taps = true;
    with_taps.plan.max_arena_bytes = options_.max_arena_bytes;
    auto made = ZsMstm1::Make(model->file(), name_, with_taps);
    if (!made.ok()) return made.status();
    model = *std::move(made);
  }
  return ZsMstm1::NewAgent(model, {.threads = options.threads, .profile = options.profile});
}

Status ZsMstm1Network::RunStyle(const Arrays& inputs, const RunOptions& options, RunReport* report,
                                ZsMstm1Agent& agent, Progress& progress) const {
  if (Has(inputs, "style")) {
    agent.SetStyle(inputs.at("style").f32.data());
    return {};
  }
  const ZsMstm1Config& c = model_->config();
  const std::int64_t total = Frames(inputs, "style_speech");
  Array speech = MakeArray({c.frames, c.ast_style.mel_bins});
  Array text = MakeArray({c.frames, c.d_text}), pose = MakeArray({c.frames, c.d_pose});
  for (const Window& w : Windows(total, c.frames)) {
    for (auto [name, to] : {std::pair("style_speech", &speech), std::pair("style_text", &text),
                            std::pair("style_pose", &pose)})
      CopyWindow(inputs.at(name).f32.data(), total, to->shape[1], w.begin, c.frames,
                 to->f32.data());
    agent.AddStyleSegment(speech.f32.data(), text.f32.data(), pose.f32.data());
    progress.Step(options);
  }
  Note(report, DescribeLastWindow("style clip", total, c.frames));
  return {};
}

Status ZsMstm1Network::RunGenerator(const Arrays& inputs, const RunOptions& options,
                                    RunReport* report, ZsMstm1Agent& agent, Progress& progress,
                                    Array* pose) const {
  const ZsMstm1Config& c = model_->config();
  const std::int64_t total = Frames(inputs, "speech"), length = c.WindowFrames();
  *pose = MakeArray({total, c.d_pose});
  Array speech = MakeArray({length, c.ast_content.mel_bins}), text = MakeArray({length, c.d_text});
  Array window = MakeArray({length, c.d_pose});
  for (const Window& w : Windows(total, length)) {
    CopyWindow(inputs.at("speech").f32.data(), total, speech.shape[1], w.begin, length,
               speech.f32.data());
    CopyWindow(inputs.at("text").f32.data(), total, c.d_text, w.begin, length, text.f32.data());
    TimedRun(options, report,
             [&] { agent.Generate(speech.f32.data(), text.f32.data(), window.f32.data()); });
    const std::int64_t rows = std::min(length, total - w.begin) - w.keep;
    std::memcpy(pose->f32.data() + (w.begin + w.keep) * c.d_pose,
                window.f32.data() + w.keep * c.d_pose,
                static_cast<std::size_t>(rows * c.d_pose) * sizeof(float));
    progress.Step(options);
  }
  Note(report, DescribeLastWindow("speech", total, length));
  return CheckFinite("pose", *pose, Code::kNonFinite);
}

Result<Arrays> ZsMstm1Network::Run(const Arrays& inputs, const RunOptions& options,
                                   RunReport* report) {
  GESTUS_RETURN_IF_ERROR(CheckOptions(options));
  GESTUS_RETURN_IF_ERROR(CheckInputs(signature_, inputs));
  const Result<bool> speaks = Together(inputs, {"speech", "text"});
  if (!speaks.ok()) return speaks.status();
  const Result<bool> clip = Together(inputs, {"style_speech", "style_text", "style_pose"});
  if (!clip.ok()) return clip.status();
  if (!*clip && !Has(inputs, "style"))
    return Status(Code::kBadInput,
                  "style: missing, expected style, or style_speech, style_text and style_pose");
  if (*clip && Has(inputs, "style"))
    return Status(Code::kBadInput, "style: given twice, as a style and as a clip");

  Result<std::unique_ptr<ZsMstm1Agent>> agent = NewAgent(options);
  if (!agent.ok()) return agent.status();
  const ZsMstm1Config& c = model_->config();
  Progress progress;
  progress.total = Windows(Frames(inputs, "style_speech"), c.frames).size() +
                   Windows(Frames(inputs, "speech"), c.WindowFrames()).size();
  if (report != nullptr) {
    report->frames = static_cast<std::size_t>(Frames(inputs, "speech"));
    report->frame_rate = c.frame_rate;
  }
  GESTUS_RETURN_IF_ERROR(RunStyle(inputs, options, report, **agent, progress));
  Arrays outputs;
  Array style = MakeArray({c.StyleWidth()});
  std::memcpy(style.f32.data(), (*agent)->style(), style.f32.size() * sizeof(float));
  GESTUS_RETURN_IF_ERROR(CheckFinite("style", style, Code::kNonFinite));
  outputs["style"] = std::move(style);
  if (*speaks)
    GESTUS_RETURN_IF_ERROR(
        RunGenerator(inputs, options, report, **agent, progress, &outputs["pose"]));
  if (options.taps) {
    if (*clip) CopyTaps((*agent)->style_session(), &outputs);
    if (*speaks) CopyTaps((*agent)->generator_session(), &outputs);
  }
  AddProfiles({&(*agent)->style_session(), &(*agent)->generator_session()}, report);
  return outputs;
}

}  // namespace

Result<std::unique_ptr<Network>> MakeZsMstm1Network(std::shared_ptr<const WeightsFile> file,
                                                    const std::string& name,
                                                    const NetworkOptions& options) {
  ZsMstm1Options model_options;
  model_options.kernels = options.kernels;
  model_options.plan.max_arena_bytes = options.max_arena_bytes;
  auto model = ZsMstm1::Make(std::move(file), name, model_options);
  if (!model.ok()) return model.status();
  return std::unique_ptr<Network>(
      std::make_unique<ZsMstm1Network>(*std::move(model), name, options));
}

}  // namespace gestus::models
