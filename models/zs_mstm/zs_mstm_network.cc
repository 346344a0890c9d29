// Named arrays of any length, cut into segments for ZS-MSTM.
#include "models/zs_mstm/zs_mstm_network.h"

#include <algorithm>
#include <cstring>

#include "models/run_support.h"
#include "models/segments.h"
#include "models/zs_mstm/zs_mstm.h"

namespace gestus::models {
namespace {

constexpr std::int64_t kAny = ArraySpec::kAny;

Signature MakeSignature(const ZsMstmConfig& c) {
  const std::int64_t mel = c.ast_content.mel_bins;
  const std::string pose_unit = "as the pose statistics: PATS pixels, x of every joint then y";
  const std::string face_unit = "as the face statistics: PATS pixels, x of every landmark then y";
  const auto frames = [](const char* name, std::int64_t cols, const char* axis,
                         const std::string& unit, const char* meaning) {
    return Spec(name, {kAny, cols}, {"frames", axis}, unit, meaning);
  };
  Signature s;
  s.inputs = {
      frames("speech", mel, "mel bins", "ln power", "log-mel spectrogram of the speech"),
      frames("text", c.d_text, "features", "-", "BERT features of the words, aligned with speech"),
      Spec("style", {c.StyleWidth()}, {"values"}, "-", "a style kept from an earlier run"),
      frames("style_speech", mel, "mel bins", "ln power", "speech of the target speaker's clip"),
      frames("style_text", c.d_text, "features", "-", "words of the target speaker's clip"),
      frames("style_pose", c.d_pose, "coordinates", pose_unit,
             "poses of the target speaker's clip"),
  };
  s.outputs = {frames("pose", c.d_pose, "coordinates", pose_unit, "the generated poses")};
  if (c.HasFace()) {
    s.inputs.push_back(frames("style_face", c.d_face, "coordinates", face_unit,
                              "facial landmarks of the target speaker's clip"));
    s.inputs.push_back(Spec("style_tags", {kAny, c.d_tags}, {"segments", "dialog acts"}, "0 or 1",
                            "which dialog acts each segment of the clip holds"));
    s.outputs.push_back(
        frames("face", c.d_face, "coordinates", face_unit, "the generated facial landmarks"));
  }
  for (ArraySpec& spec : s.inputs) spec.required = false;
  s.outputs.push_back(Spec("style", {c.StyleWidth()}, {"values"}, "-",
                           "the style that was used: keep it and give it again"));
  return s;
}

class ZsMstmNetwork final : public Network {
 public:
  /// `model` is null where no plan is wanted.
  ZsMstmNetwork(ZsMstmConfig config, std::shared_ptr<const ZsMstm> model, std::string name,
                const NetworkOptions& options)
      : c_(std::move(config)),
        model_(std::move(model)),
        name_(std::move(name)),
        options_(options),
        signature_(MakeSignature(c_)) {}

  const char* kind() const override { return c_.HasFace() ? "ZS-MSTM 2.0" : "ZS-MSTM 1.0"; }
  const Signature& signature() const override { return signature_; }

  std::string PlanText() const override {
    if (model_ == nullptr) return "";
    return "style encoder\n" + model_->style_plan()->ToString() + "generator\n" +
           model_->generator_plan()->ToString();
  }

  Result<Arrays> Run(const Arrays& inputs, const RunOptions& options, RunReport* report) override;

 private:
  Result<std::unique_ptr<ZsMstmAgent>> NewAgent(const RunOptions& options) const;
  Status RunStyle(const Arrays& inputs, const RunOptions& options, RunReport* report,
                  ZsMstmAgent& agent, Progress& progress) const;
  Status RunGenerator(const Arrays& inputs, const RunOptions& options, RunReport* report,
                      ZsMstmAgent& agent, Progress& progress, Arrays* outputs) const;

  ZsMstmConfig c_;
  std::shared_ptr<const ZsMstm> model_;
  std::string name_;
  NetworkOptions options_;
  Signature signature_;
};

bool Has(const Arrays& inputs, const char* name) { return inputs.count(name) != 0; }

std::int64_t Frames(const Arrays& inputs, const char* name) {
  return Has(inputs, name) ? inputs.at(name).shape[0] : 0;
}

/// All of `names` are given, with as many frames each; or none is, and the result is false.
Result<bool> Together(const Arrays& inputs, const std::vector<const char*>& names) {
  const char* first = names.front();
  for (const char* name : names) {
    if (Has(inputs, name) != Has(inputs, first))
      return Status(Code::kBadInput, std::string(Has(inputs, name) ? first : name) +
                                         ": missing, expected beside " +
                                         (Has(inputs, name) ? name : first));
    if (Has(inputs, name)) GESTUS_RETURN_IF_ERROR(CheckSameRows(inputs, name, first, "frames"));
  }
  return Has(inputs, first);
}

/// The streams of a style clip that have a row a frame.
std::vector<const char*> ClipStreams(const ZsMstmConfig& c) {
  std::vector<const char*> names = {"style_speech", "style_text", "style_pose"};
  if (c.HasFace()) names.push_back("style_face");
  return names;
}

/// Beside a style clip stands one row of tags for each of its segments.
Status CheckTags(const ZsMstmConfig& c, const Arrays& inputs) {
  if (c.d_tags == 0) return {};
  const bool clip = Has(inputs, "style_speech");
  if (clip != Has(inputs, "style_tags"))
    return Status(Code::kBadInput, std::string(clip ? "style_tags" : "style_speech") +
                                       ": missing, expected beside " +
                                       (clip ? "style_speech" : "style_tags"));
  const auto segments =
      static_cast<std::int64_t>(Windows(Frames(inputs, "style_speech"), c.frames).size());
  if (Frames(inputs, "style_tags") == segments) return {};
  return Status(Code::kBadInput, "style_tags: " + std::to_string(Frames(inputs, "style_tags")) +
                                     " rows, expected one for each segment of the clip, " +
                                     std::to_string(segments));
}

Result<std::unique_ptr<ZsMstmAgent>> ZsMstmNetwork::NewAgent(const RunOptions& options) const {
  std::shared_ptr<const ZsMstm> model = model_;
  if (options.taps) {
    ZsMstmOptions with_taps;
    with_taps.kernels = &model->generator_plan()->kernels();
    with_taps.plan.taps = true;
    with_taps.plan.max_arena_bytes = options_.max_arena_bytes;
    auto made = ZsMstm::Make(model->file(), name_, with_taps);
    if (!made.ok()) return made.status();
    model = *std::move(made);
  }
  return ZsMstm::NewAgent(model, SessionOptionsOf(options));
}

Status ZsMstmNetwork::RunStyle(const Arrays& inputs, const RunOptions& options, RunReport* report,
                               ZsMstmAgent& agent, Progress& progress) const {
  if (Has(inputs, "style")) {
    agent.SetStyle(inputs.at("style").f32.data());
    return {};
  }
  const std::int64_t total = Frames(inputs, "style_speech");
  std::vector<std::pair<const char*, Array>> streams;
  for (const char* name : ClipStreams(c_))
    streams.emplace_back(name, MakeArray({c_.frames, inputs.at(name).shape[1]}));
  const float* tags = c_.d_tags > 0 ? inputs.at("style_tags").f32.data() : nullptr;
  for (const Window& w : Windows(total, c_.frames)) {
    for (auto& [name, to] : streams)
      CopyWindow(inputs.at(name).f32.data(), total, to.shape[1], w.begin, c_.frames, to.f32.data());
    const auto data = [&](std::size_t i) {
      return i < streams.size() ? streams[i].second.f32.data() : nullptr;
    };
    agent.AddStyleSegment({data(0), data(1), data(2), data(3), tags});
    if (tags != nullptr) tags += c_.d_tags;
    progress.Step(options);
  }
  AddNote(report, DescribeLastWindow("style clip", total, c_.frames));
  return {};
}

Status ZsMstmNetwork::RunGenerator(const Arrays& inputs, const RunOptions& options,
                                   RunReport* report, ZsMstmAgent& agent, Progress& progress,
                                   Arrays* outputs) const {
  const std::int64_t total = Frames(inputs, "speech"), length = c_.WindowFrames();
  Array speech = MakeArray({length, c_.ast_content.mel_bins}),
        text = MakeArray({length, c_.d_text});
  Array pose = MakeArray({length, c_.d_pose}), face = MakeArray({length, c_.d_face});
  std::vector<std::pair<const Array*, Array*>> streams;  // of a window, and whole
  (*outputs)["pose"] = MakeArray({total, c_.d_pose});
  streams.emplace_back(&pose, &(*outputs)["pose"]);
  if (c_.HasFace()) {
    (*outputs)["face"] = MakeArray({total, c_.d_face});
    streams.emplace_back(&face, &(*outputs)["face"]);
  }
  for (const Window& w : Windows(total, length)) {
    CopyWindow(inputs.at("speech").f32.data(), total, speech.shape[1], w.begin, length,
               speech.f32.data());
    CopyWindow(inputs.at("text").f32.data(), total, c_.d_text, w.begin, length, text.f32.data());
    TimedRun(options, report, [&] {
      agent.Generate(speech.f32.data(), text.f32.data(), pose.f32.data(), face.f32.data());
    });
    const std::int64_t rows = std::min(length, total - w.begin) - w.keep;
    for (auto& [window, whole] : streams) {
      const std::int64_t cols = whole->shape[1];
      std::memcpy(whole->f32.data() + (w.begin + w.keep) * cols, window->f32.data() + w.keep * cols,
                  static_cast<std::size_t>(rows * cols) * sizeof(float));
    }
    progress.Step(options);
  }
  AddNote(report, DescribeLastWindow("speech", total, length));
  for (const auto& [name, array] : *outputs)
    GESTUS_RETURN_IF_ERROR(CheckFinite(name, array, Code::kNonFinite));
  return {};
}

Result<Arrays> ZsMstmNetwork::Run(const Arrays& inputs, const RunOptions& options,
                                  RunReport* report) {
  if (model_ == nullptr) return NotPlanned();
  GESTUS_RETURN_IF_ERROR(CheckOptions(options));
  GESTUS_RETURN_IF_ERROR(CheckInputs(signature_, inputs));
  const Result<bool> speaks = Together(inputs, {"speech", "text"});
  if (!speaks.ok()) return speaks.status();
  const Result<bool> clip = Together(inputs, ClipStreams(c_));
  if (!clip.ok()) return clip.status();
  if (!*clip && !Has(inputs, "style"))
    return Status(Code::kBadInput, "style: missing, expected style, or style_speech, style_text" +
                                       std::string(c_.HasFace() ? ", style_face, style_tags" : "") +
                                       " and style_pose");
  GESTUS_RETURN_IF_ERROR(CheckTags(c_, inputs));
  if (*clip && Has(inputs, "style"))
    return Status(Code::kBadInput, "style: given twice, as a style and as a clip");

  Result<std::unique_ptr<ZsMstmAgent>> agent = NewAgent(options);
  if (!agent.ok()) return agent.status();
  Progress progress;
  progress.total = Windows(Frames(inputs, "style_speech"), c_.frames).size() +
                   Windows(Frames(inputs, "speech"), c_.WindowFrames()).size();
  if (report != nullptr) {
    report->frames = static_cast<std::size_t>(Frames(inputs, "speech"));
    report->frame_rate = c_.frame_rate;
  }
  GESTUS_RETURN_IF_ERROR(RunStyle(inputs, options, report, **agent, progress));
  Arrays outputs;
  Array style = MakeArray({c_.StyleWidth()});
  std::memcpy(style.f32.data(), (*agent)->style(), style.f32.size() * sizeof(float));
  GESTUS_RETURN_IF_ERROR(CheckFinite("style", style, Code::kNonFinite));
  outputs["style"] = std::move(style);
  if (*speaks)
    GESTUS_RETURN_IF_ERROR(RunGenerator(inputs, options, report, **agent, progress, &outputs));
  if (options.taps) {
    if (*clip) CopyTaps((*agent)->style_session(), &outputs);
    if (*speaks) CopyTaps((*agent)->generator_session(), &outputs);
  }
  AddProfiles({&(*agent)->style_session(), &(*agent)->generator_session()}, report);
  return outputs;
}

}  // namespace

Result<std::unique_ptr<Network>> MakeZsMstmNetwork(std::shared_ptr<const WeightsFile> file,
                                                   const std::string& name,
                                                   const NetworkOptions& options) {
  if (!options.plan) {
    ZsMstmConfig config;
    ZsMstmWeights weights;
    GESTUS_RETURN_IF_ERROR(LoadZsMstm(*file, *file->FindNetwork(name), &config, &weights));
    return std::unique_ptr<Network>(
        std::make_unique<ZsMstmNetwork>(std::move(config), nullptr, name, options));
  }
  ZsMstmOptions model_options;
  model_options.kernels = options.kernels;
  model_options.plan.max_arena_bytes = options.max_arena_bytes;
  auto model = ZsMstm::Make(std::move(file), name, model_options);
  if (!model.ok()) return model.status();
  return std::unique_ptr<Network>(
      std::make_unique<ZsMstmNetwork>((*model)->config(), *model, name, options));
}

}  // namespace gestus::models
