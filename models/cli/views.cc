// Reads again what the run has heard, as people hear it, and hands it with the motion to
// models/player.
#include "models/cli/views.h"

#include <algorithm>

#include "models/audio/log_mel.h"
#include "models/audio/rows.h"
#include "models/cli/npz.h"
#include "models/features/pitch.h"
#include "models/features/samples.h"
#include "models/features/spec.h"
#include "models/io/reading.h"
#include "models/io/text.h"
#include "models/player/page.h"
#include "models/player/sheet.h"
#include "models/player/video.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

using models::ArraySpec;
using outputs::Motion;

// Speech in a page: more would only be larger.
constexpr int kMaxSampleRate = 22050;

/// Where the words or windows of Model 1 and Model 2 lie, which infer-cli writes beside their
/// output.
ArraySpec TimesSpec() {
  ArraySpec spec;
  spec.name = "times_ms";
  spec.dtype = DType::kI32;
  spec.shape = {ArraySpec::kAny, 2};
  spec.required = false;
  return spec;
}

/// What the network would put out, as a file holds it.
Result<Motion> ReadMotion(const std::string& path, const Setup& setup) {
  std::vector<ArraySpec> wanted = setup.network->signature().outputs;
  for (ArraySpec& spec : wanted) spec.required = false;
  wanted.push_back(TimesSpec());
  const Result<NpzContents> file = ReadNpz(path, wanted);
  if (!file.ok()) return file.status();
  Result<Motion> motion = outputs::MotionOf(*setup.weights->FindNetwork(setup.name), file->arrays);
  if (!motion.ok()) return motion.status().In(path);
  return motion;
}

Status OpenOne(const std::string& path, std::optional<AtomicFile>* file) {
  if (path.empty()) return Status();
  Result<AtomicFile> created = AtomicFile::Create(path);
  if (!created.ok()) return created.status().In(path);
  file->emplace(*std::move(created));
  return Status();
}

Status WriteOne(const std::string& path, const std::string& bytes, AtomicFile* file,
                std::vector<std::string>* written) {
  GESTUS_RETURN_IF_ERROR(file->Write(bytes.data(), bytes.size()).In(path));
  GESTUS_RETURN_IF_ERROR(file->Commit().In(path));
  written->push_back(path + ": " + Bytes(bytes.size()));
  return Status();
}

Status AddSound(const std::string& path, player::Sound* sound) {
  Result<std::unique_ptr<audio::AudioSource>> source = audio::OpenAudio(path);
  if (!source.ok()) return source.status();
  sound->sample_rate = std::min((*source)->sample_rate(), kMaxSampleRate);
  Result<features::Samples> samples = features::Samples::Open(path, sound->sample_rate);
  if (!samples.ok()) return samples.status();
  while (true) {
    const Result<std::span<const float>> piece = samples->Next();
    if (!piece.ok()) return piece.status();
    if (piece->empty()) break;
    sound->samples.insert(sound->samples.end(), piece->begin(), piece->end());
  }
  // Only a file that is small enough to be embedded as it is.
  if (Result<std::string> file = ReadFile(path, player::kMaxPlainWav); file.ok())
    sound->file = *std::move(file);
  return Status();
}

Status AddSpectrogram(const player::Sound& sound, player::Spectrogram* spectrogram) {
  audio::LogMelOptions options;
  options.sample_rate = sound.sample_rate;
  options.fft_size = options.window_size = 1024;
  options.hop = std::max(1, sound.sample_rate / 60);
  options.mels = 64;
  options.f_max = std::min(8000.0, sound.sample_rate / 2.0);
  Result<audio::LogMel> stage = audio::LogMel::Make(options);
  if (!stage.ok()) return stage.status();
  spectrogram->rate = static_cast<double>(sound.sample_rate) / options.hop;
  spectrogram->bins = options.mels;
  spectrogram->values = audio::AllRows(&*stage, sound.samples.data(), sound.samples.size());
  return Status();
}

Status AddRecording(const Inputs& inputs, const fb::Network& record, player::Show* show) {
  if (!inputs.transcript.empty()) {
    Result<words::Transcript> transcript = words::ReadTranscript(inputs.transcript);
    if (!transcript.ok()) return transcript.status();
    // Plain text has no times to be shown at.
    if (!transcript->words.empty() && transcript->words.back().end > 0)
      show->words = std::move(transcript->words);
  }
  if (inputs.audio.empty()) return Status();
  GESTUS_RETURN_IF_ERROR(AddSound(inputs.audio, &show->sound));
  if (show->sound.samples.empty()) return Status();
  GESTUS_RETURN_IF_ERROR(AddSpectrogram(show->sound, &show->spectrogram).In(inputs.audio));
  const Result<features::FeatureSpec> spec = features::ReadFeatureSpec(record);
  if (!spec.ok()) return spec.status();
  Result<features::Pitch> pitch = features::ReadPitch(inputs.audio, *spec);
  if (!pitch.ok()) return pitch.status();
  show->pitch = {.rate = 1 / spec->pitch_hop, .hz = std::move(pitch->f0)};
  return Status();
}

std::string Name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

/// "Weights: weights.fb, trained on PATS, CC BY 4.0."
std::string WeightsText(const Setup& setup) {
  const fb::Provenance& from = *setup.weights->root().provenance();
  std::string text = "Weights: " + Name(setup.weights->path());
  if (from.trained() && from.trained_on() != nullptr)
    text += ", trained on " + from.trained_on()->str();
  if (from.licence() != nullptr && from.licence()->size() > 0)
    text += ", licence: " + from.licence()->str();
  return OneLine(text + ".");
}

}  // namespace

Result<Views> Views::Open(const Arguments& arguments, const Setup& setup) {
  Views views;
  GESTUS_RETURN_IF_ERROR(OpenOne(arguments.html, &views.html_));
  GESTUS_RETURN_IF_ERROR(OpenOne(arguments.svg, &views.svg_));
  GESTUS_RETURN_IF_ERROR(OpenOne(arguments.mp4, &views.mp4_));
  if (views.mp4_) GESTUS_RETURN_IF_ERROR(player::FindFfmpeg().In(arguments.mp4));
  for (const auto& [path, motion] :
       {std::pair(arguments.source, &views.source_), std::pair(arguments.target, &views.target_)}) {
    if (path.empty()) continue;
    if (!views.Any())
      return Status(Code::kInvalidArgument,
                    path + ": nothing to show it in, expected --html, --svg or --mp4 with it");
    Result<Motion> read = ReadMotion(path, setup);
    if (!read.ok()) return read.status();
    *motion = *std::move(read);
  }
  return views;
}

Status Views::Write(const Arguments& arguments, const Inputs& inputs, const Setup& setup,
                    const outputs::Motion& motion, std::vector<std::string>* written,
                    std::vector<std::string>* notes) {
  if (!Any()) return Status();
  const fb::Network& record = *setup.weights->FindNetwork(setup.name);
  player::Show show;
  show.title = arguments.title;
  if (show.title.empty())
    show.title = OneLine(Name(inputs.audio.empty() ? arguments.inputs.front() : inputs.audio));
  show.network = setup.network->kind();
  show.weights = WeightsText(setup);
  show.trained = setup.Trained();
  show.prediction = motion;
  show.source = std::move(source_);
  show.target = std::move(target_);
  GESTUS_RETURN_IF_ERROR(AddRecording(inputs, record, &show));
  if (html_) {
    const Result<std::string> page = player::MakePage(show, notes);
    if (!page.ok()) return page.status().In(arguments.html);
    GESTUS_RETURN_IF_ERROR(WriteOne(arguments.html, *page, &*html_, written));
  }
  if (svg_) {
    const Result<std::string> sheet = player::MakeSheet(show);
    if (!sheet.ok()) return sheet.status().In(arguments.svg);
    GESTUS_RETURN_IF_ERROR(WriteOne(arguments.svg, *sheet, &*svg_, written));
  }
  if (mp4_) {
    const Result<std::string> video = player::MakeVideo(show);
    if (!video.ok()) return video.status().In(arguments.mp4);
    GESTUS_RETURN_IF_ERROR(WriteOne(arguments.mp4, *video, &*mp4_, written));
  }
  return Status();
}

}  // namespace gestus::cli
