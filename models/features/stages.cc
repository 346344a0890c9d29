#include "models/features/stages.h"

#include <algorithm>
#include <cmath>

#include "models/audio/log_mel.h"
#include "models/audio/rows.h"
#include "models/features/figure.h"
#include "models/features/pitch.h"
#include "models/features/samples.h"
#include "models/io/text.h"
#include "models/motion/clean.h"
#include "models/motion/openface.h"
#include "models/prosody/voice_quality.h"
#include "models/words/frames.h"
#include "models/words/units.h"

namespace gestus::features {
namespace {

using models::Array;
using models::Arrays;

Array Line(std::vector<float> values) {
  Array array;
  array.shape = {static_cast<std::int64_t>(values.size())};
  array.f32 = std::move(values);
  return array;
}

/// Begin and end of each of `spans`, in ms.
template <class Spans>
Array Milliseconds(const Spans& spans) {
  Array array;
  array.dtype = DType::kI32;
  array.shape = {static_cast<std::int64_t>(spans.size()), 2};
  for (const auto& span : spans) {
    array.i32.push_back(static_cast<std::int32_t>(std::lround(1000 * span.start)));
    array.i32.push_back(static_cast<std::int32_t>(std::lround(1000 * span.end)));
  }
  return array;
}

Status AddLogMel(const std::string& path, const FeatureSpec& spec, Arrays* arrays) {
  Result<std::unique_ptr<audio::AudioSource>> source = audio::OpenAudio(path);
  if (!source.ok()) return source.status();
  Result<audio::LogMel> stage = audio::LogMel::Make(audio::PatsLogMel512(spec.sample_rate));
  if (!stage.ok()) return stage.status().In(path);
  Result<std::vector<float>> rows = audio::AllRows(&*stage, source->get(), spec.sample_rate);
  if (!rows.ok()) return rows.status();
  const auto n = static_cast<std::int64_t>(rows->size()) / stage->width();
  (*arrays)["log_mel"] = RowsOf(*std::move(rows), n);
  return Status();
}

Status AddVoice(const std::string& path, const FeatureSpec& spec, Account* account,
                Arrays* arrays) {
  Result<Samples> samples = Samples::Open(path, spec.pitch_sample_rate);
  if (!samples.ok()) return samples.status();
  Result<prosody::VoiceQuality> voice =
      prosody::VoiceQuality::Make({.swipe = SwipeOptionsOf(spec)});
  if (!voice.ok()) return voice.status().In(path);
  constexpr std::size_t kColumns = prosody::VoiceQuality::kColumns;
  constexpr const char* kNames[kColumns] = {"pitch", "pitch_strength", "jitter", "shimmer",
                                            "hnr",   "hammarberg"};
  std::vector<float> columns[kColumns], rows;
  for (bool ended = false; !ended;) {
    const Result<std::span<const float>> piece = samples->Next();
    if (!piece.ok()) return piece.status();
    ended = piece->empty();
    rows.resize((ended ? voice->MaxRowsAtFinish() : voice->MaxRows(piece->size())) * kColumns);
    const std::size_t n =
        ended ? voice->Finish(rows.data()) : voice->Push(piece->data(), piece->size(), rows.data());
    for (std::size_t i = 0; i < n * kColumns; ++i) columns[i % kColumns].push_back(rows[i]);
  }
  for (std::size_t i = 0; i < kColumns; ++i) (*arrays)[kNames[i]] = Line(std::move(columns[i]));
  account->used.push_back(path + ": " + samples->Description() + " -> pitch and voice quality");
  account->notes.insert(account->notes.end(), samples->notes().begin(), samples->notes().end());
  return Status();
}

Status AddWords(const Recording& recording, const FeatureSpec& spec, double seconds,
                Account* account, Arrays* arrays) {
  const Result<words::Transcript> transcript = ReadWords(recording, account);
  if (!transcript.ok()) return transcript.status();
  account->used.push_back(Describe(*transcript, recording.transcript));
  if (transcript->words.empty()) return Status();
  const Result<std::vector<words::Unit>> units =
      words::MakeUnits(transcript->words, {.pause = spec.pause, .max_items = 0});
  if (!units.ok()) return units.status().In(recording.transcript);
  words::FrameOptions options;
  options.rate = spec.frame_rate;
  const double end = seconds > 0 ? seconds : transcript->words.back().end;
  options.frames =
      static_cast<std::size_t>(std::max(1.0, std::floor(end * spec.frame_rate + 1e-6)));
  const std::vector<std::size_t> pieces(transcript->words.size(), 1);
  const Result<words::FramePlan> plan = words::PlaceOnFrames(transcript->words, pieces, options);
  if (!plan.ok()) return plan.status().In(recording.transcript);
  Array& frames = (*arrays)["word_of_frame"];
  frames.dtype = DType::kI32;
  frames.shape = {static_cast<std::int64_t>(plan->frames.size())};
  for (const words::FramePiece& frame : plan->frames) frames.i32.push_back(frame.word);
  (*arrays)["word_ms"] = Milliseconds(transcript->words);
  (*arrays)["unit_ms"] = Milliseconds(*units);
  return Status();
}

void AddTrack(const std::string& name, const motion::Track& track, Arrays* arrays) {
  if (track.frames > 0) (*arrays)[name] = RowsOf(track.values, track.frames);
}

Status AddFigure(const Recording& recording, const FeatureSpec& spec, double seconds,
                 Account* account, Arrays* arrays) {
  const Result<Figure> figure =
      ReadFigure(recording.openpose, recording.pose_rate, seconds, spec.frame_rate, account);
  if (!figure.ok()) return figure.status();
  AddTrack("body", figure->raw.body, arrays);
  (*arrays)["body_confidence"] = RowsOf(figure->raw.body.confidence, figure->raw.body.frames);
  AddTrack("body_clean", figure->body, arrays);
  if (figure->face.frames > 0) {
    AddTrack("face_points", figure->raw.face, arrays);
    (*arrays)["face_confidence"] = RowsOf(figure->raw.face.confidence, figure->raw.face.frames);
    AddTrack("face_clean", figure->face, arrays);
  }
  account->used.push_back(recording.openpose + ": " +
                          Count(static_cast<std::uint64_t>(figure->raw.body.frames), "frame"));
  if (!spec.joints.empty()) {
    Result<Array> pose = PoseOf(*figure, spec);
    if (!pose.ok()) return pose.status().In(recording.openpose);
    (*arrays)["pose"] = *std::move(pose);
  }
  if (spec.landmarks.empty() || figure->face.frames == 0) return Status();
  Result<Array> face = FaceOf(*figure, spec);
  if (!face.ok()) return face.status().In(recording.openpose);
  (*arrays)["face"] = *std::move(face);
  return Status();
}

Status AddOpenFace(const std::string& path, Account* account, Arrays* arrays) {
  Result<motion::OpenFaceClip> clip = motion::ReadOpenFace(path);
  if (!clip.ok()) return clip.status();
  motion::Track& track = clip->track;
  std::string columns;
  for (const std::string& point : track.points) columns += (columns.empty() ? "" : " ") + point;
  account->used.push_back(path + ": " + Count(static_cast<std::uint64_t>(track.frames), "frame") +
                          " at " + Significant(track.frame_rate, 4) + " a second -> openface, " +
                          columns);
  account->notes.insert(account->notes.end(), clip->notes.begin(), clip->notes.end());
  AddTrack("openface", track, arrays);
  (*arrays)["openface_confidence"] = RowsOf(track.confidence, track.frames);
  const Result<motion::CleanReport> report = motion::Clean(&track);
  if (!report.ok()) return report.status().In(path);
  for (const std::string& note : report->notes) account->notes.push_back(path + ": " + note);
  AddTrack("openface_clean", track, arrays);
  return Status();
}

}  // namespace

Result<Arrays> Stages(const Recording& recording, const std::string& openface,
                      const FeatureSpec& spec, Account* account, bool sound) {
  Arrays arrays;
  double seconds = 0;
  if (!recording.audio.empty()) {
    const Result<double> length = SecondsOf(recording.audio);
    if (!length.ok()) return length.status();
    if (*length <= 0)
      return Status(Code::kBadInput,
                    recording.audio + ": has no samples, expected recorded speech");
    seconds = *length;
    if (sound) {
      GESTUS_RETURN_IF_ERROR(AddLogMel(recording.audio, spec, &arrays));
      GESTUS_RETURN_IF_ERROR(AddVoice(recording.audio, spec, account, &arrays));
    }
  }
  if (!recording.transcript.empty())
    GESTUS_RETURN_IF_ERROR(AddWords(recording, spec, seconds, account, &arrays));
  if (!recording.openpose.empty())
    GESTUS_RETURN_IF_ERROR(AddFigure(recording, spec, seconds, account, &arrays));
  if (!openface.empty()) GESTUS_RETURN_IF_ERROR(AddOpenFace(openface, account, &arrays));
  return arrays;
}

}  // namespace gestus::features
