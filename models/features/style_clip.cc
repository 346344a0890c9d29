// FrontEnd::StyleClip: what a speaker's recording, words and poses tell of a style.
#include <algorithm>
#include <cmath>

#include "models/features/figure.h"
#include "models/features/frame_inputs.h"
#include "models/features/front_end.h"
#include "models/features/samples.h"
#include "models/io/text.h"
#include "models/segments.h"
#include "models/words/units.h"
#include "weights_generated.h"

namespace gestus::features {
namespace {

using models::Array;
using models::Arrays;

void Cut(Array* array, std::int64_t rows) {
  const std::int64_t columns = array->shape[1];
  array->shape[0] = rows;
  array->f32.resize(static_cast<std::size_t>(rows * columns));
}

}  // namespace

Status FrontEnd::AddMotion(const Recording& recording, Account* account, Arrays* clip) {
  if (recording.openpose.empty()) return Status();
  if (clip->count("style_pose") != 0 && (spec_.d_face == 0 || clip->count("style_face") != 0)) {
    account->notes.push_back(recording.openpose + " was not used, style_pose is there already");
    return Status();
  }
  double seconds = 0;
  if (recording.pose_rate <= 0 && !recording.audio.empty()) {
    const Result<double> length = SecondsOf(recording.audio);
    if (!length.ok()) return length.status();
    seconds = *length;
  }
  const Result<Figure> figure =
      ReadFigure(recording.openpose, recording.pose_rate, seconds, spec_.frame_rate, account);
  if (!figure.ok()) return figure.status();
  std::string made;
  if (clip->count("style_pose") == 0) {
    Result<Array> pose = PoseOf(*figure, spec_);
    if (!pose.ok()) return pose.status().In(recording.openpose);
    (*clip)["style_pose"] = *std::move(pose);
    made = " -> style_pose";
  }
  if (spec_.d_face > 0 && clip->count("style_face") == 0) {
    Result<Array> face = FaceOf(*figure, spec_);
    if (!face.ok()) return face.status().In(recording.openpose);
    (*clip)["style_face"] = *std::move(face);
    made += made.empty() ? " -> style_face" : ", style_face";
  }
  account->used.push_back(recording.openpose + ": " +
                          Count(static_cast<std::uint64_t>(figure->raw.body.frames), "frame") +
                          made);
  return Status();
}

Status FrontEnd::AddSpeechAndText(const Recording& recording, const words::Transcript* transcript,
                                  Account* account, Arrays* clip) {
  const bool has_speech = clip->count("style_speech") != 0,
             has_text = clip->count("style_text") != 0;
  if (has_speech && has_text) {
    for (const std::string& path : {recording.audio, recording.transcript}) {
      if (path.empty()) continue;
      account->notes.push_back(path +
                               " was not used, style_speech and style_text are there already");
    }
    return Status();
  }
  FrameSources sources;
  sources.arrays_path = recording.arrays_path;
  if (has_speech) sources.arrays["speech"] = clip->at("style_speech");
  if (has_text) sources.arrays["text"] = clip->at("style_text");
  sources.audio = recording.audio;
  sources.transcript = transcript;
  sources.transcript_path = recording.transcript;
  if (clip->count("style_pose") != 0) sources.frames = clip->at("style_pose").shape[0];
  const Result<WordEncoder*> encoder = EncoderFor(transcript, has_text, account);
  if (!encoder.ok()) return encoder.status();
  sources.encoder = *encoder;
  auto stream = FrameInputs::Open(spec_, sources, account);
  if (!stream.ok()) return stream.status();
  Result<Arrays> frames = (*stream)->Next((*stream)->total());
  if (!frames.ok()) return frames.status();
  for (std::string& note : (*stream)->Notes()) account->notes.push_back(std::move(note));
  (*clip)["style_speech"] = std::move(frames->at("speech"));
  (*clip)["style_text"] = std::move(frames->at("text"));
  return Status();
}

Status FrontEnd::AddTags(const words::Transcript* transcript, Account* account, Arrays* clip) {
  if (spec_.d_tags == 0 || clip->count("style_tags") != 0) return Status();
  const std::int64_t frames = clip->at("style_speech").shape[0];
  const auto windows = models::Windows(frames, spec_.style_frames);
  Array& tags = (*clip)["style_tags"];
  tags.shape = {static_cast<std::int64_t>(windows.size()), spec_.d_tags};
  tags.f32.assign(windows.size() * static_cast<std::size_t>(spec_.d_tags), 0.0f);
  if (transcript == nullptr || transcript->words.empty()) {
    account->notes.push_back("style_tags: no words, so no dialog acts");
    return Status();
  }
  const Result<ActClassifier*> classifier = Classifier();
  if (!classifier.ok()) return classifier.status();
  if (*classifier == nullptr) {
    account->notes.push_back(
        "style_tags: the weights file has no classifier of dialog acts, none are "
        "taken to occur");
    return Status();
  }
  const Result<std::vector<std::int64_t>> columns = TagColumns((*classifier)->labels());
  if (!columns.ok()) return columns.status();
  std::size_t shortened = 0;
  for (const words::Sentence& sentence :
       words::MakeSentences(transcript->words, {.pause = spec_.pause})) {
    const Result<ActClassifier::Act> act = (*classifier)->Classify(sentence.text);
    if (!act.ok()) return act.status();
    shortened += act->shortened;
    if (act->label < 0) continue;
    const std::int64_t column = (*columns)[static_cast<std::size_t>(act->label)];
    for (std::size_t i = 0; i < windows.size(); ++i) {
      const double begin = static_cast<double>(windows[i].begin) / spec_.frame_rate;
      const double end =
          static_cast<double>(windows[i].begin + spec_.style_frames) / spec_.frame_rate;
      if (sentence.start < end && sentence.end > begin)
        tags.f32[i * static_cast<std::size_t>(spec_.d_tags) + static_cast<std::size_t>(column)] = 1;
    }
  }
  account->used.push_back("words -> style_tags, by the classifier of the weights file");
  if (shortened > 0)
    account->notes.push_back("style_tags: of " + Count(shortened, "sentence") +
                             " the classifier had room for the beginning only");
  return Status();
}

// The column of X_tags that each of the classifier's labels has.
Result<std::vector<std::int64_t>> FrontEnd::TagColumns(
    const std::vector<std::string>& labels) const {
  std::vector<std::int64_t> columns;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto found = std::find(spec_.tags.begin(), spec_.tags.end(), labels[i]);
    const auto column =
        spec_.tags.empty() ? static_cast<std::int64_t>(i) : found - spec_.tags.begin();
    if (column >= spec_.d_tags)
      return Status(Code::kBadWeights, file_->path() + ": dialog act " + labels[i] +
                                           " of the classifier is none of the network's tags");
    columns.push_back(column);
  }
  return columns;
}

Result<Arrays> FrontEnd::StyleClip(const Recording& recording, Account* account) {
  if (spec_.layout != Layout::kFrames || spec_.d_text == 0)
    return Status(Code::kInvalidArgument, file_->path() + ": network " + record_->name()->str() +
                                              " has no style, expected one that takes a clip");
  const Result<const words::Transcript*> transcript = OpenTranscript(recording, account);
  if (!transcript.ok()) return transcript.status();
  Arrays clip = recording.arrays;
  GESTUS_RETURN_IF_ERROR(AddMotion(recording, account, &clip));
  if (clip.count("style_pose") == 0)
    return Status(Code::kBadInput,
                  "style: no poses, expected a folder of OpenPose's files or the array pose");
  GESTUS_RETURN_IF_ERROR(AddSpeechAndText(recording, *transcript, account, &clip));
  // A video and its recording rarely end together.
  std::int64_t frames = clip.at("style_pose").shape[0], longest = frames;
  for (const auto& [name, array] : clip) {
    if (name == "style_tags") continue;
    frames = std::min(frames, array.shape[0]);
    longest = std::max(longest, array.shape[0]);
  }
  for (auto& [name, array] : clip) {
    if (name != "style_tags") Cut(&array, frames);
  }
  if (longest > frames + 1)
    account->notes.push_back("style: the first " + std::to_string(frames) + " of " +
                             std::to_string(longest) +
                             " frames are taken, where all streams are there");
  GESTUS_RETURN_IF_ERROR(AddTags(*transcript, account, &clip));
  return clip;
}

}  // namespace gestus::features
