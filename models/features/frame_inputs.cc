#include "models/features/frame_inputs.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"
#include "models/run_support.h"
#include "models/words/frames.h"

namespace gestus::features {
namespace {

using models::Array;
using models::ArraySpec;

// Nobody speaks longer at a stretch; a transcript that says so, with nothing beside it, is wrong.
constexpr double kMaxHours = 100;

Status CheckGiven(const FrameSources& sources, const char* name, std::int64_t columns) {
  const auto found = sources.arrays.find(name);
  if (found == sources.arrays.end()) return Status();
  return models::CheckArray(
             models::Spec(name, {ArraySpec::kAny, columns}, {"frames", "columns"}, "-", ""),
             found->second)
      .In(sources.arrays_path);
}

void AppendRows(const Array& array, std::int64_t first, std::int64_t count,
                std::vector<float>* rows) {
  const auto columns = array.shape[1];
  rows->insert(rows->end(), array.f32.begin() + first * columns,
               array.f32.begin() + (first + count) * columns);
}

/// `count` times the mean of a stream's statistics, or zeros.
void AppendAbsent(const std::vector<float>& mean, std::int64_t columns, std::int64_t count,
                  std::vector<float>* rows) {
  for (std::int64_t i = 0; i < count; ++i) {
    if (mean.empty()) {
      rows->insert(rows->end(), static_cast<std::size_t>(columns), 0.0f);
    } else {
      rows->insert(rows->end(), mean.begin(), mean.end());
    }
  }
}

std::string Absent(const std::vector<float>& mean) {
  return mean.empty() ? "zeros stand for it" : "the mean of its statistics stands for it";
}

Array Rows(std::vector<float> values, std::int64_t columns) {
  Array array;
  array.shape = {static_cast<std::int64_t>(values.size()) / columns, columns};
  array.f32 = std::move(values);
  return array;
}

}  // namespace

Result<std::unique_ptr<FrameInputs>> FrameInputs::Open(const FeatureSpec& spec,
                                                       const FrameSources& sources,
                                                       Account* account) {
  std::unique_ptr<FrameInputs> inputs(new FrameInputs(spec, sources));
  GESTUS_RETURN_IF_ERROR(CheckGiven(sources, "speech", spec.mel_bins));
  if (spec.d_text > 0) GESTUS_RETURN_IF_ERROR(CheckGiven(sources, "text", spec.d_text));
  GESTUS_RETURN_IF_ERROR(inputs->OpenSpeech(account));
  GESTUS_RETURN_IF_ERROR(inputs->CountFrames());
  GESTUS_RETURN_IF_ERROR(inputs->CheckCounts());
  if (spec.d_text > 0) {
    GESTUS_RETURN_IF_ERROR(inputs->OpenText(account));
  } else if (sources.transcript != nullptr) {
    account->notes.push_back(sources.transcript_path + " was not used: the network takes no text");
  }
  return inputs;
}

Status FrameInputs::OpenSpeech(Account* account) {
  const bool given = sources_.arrays.count("speech") != 0;
  if (given || sources_.audio.empty()) {
    if (given && !sources_.audio.empty())
      account->notes.push_back(sources_.audio + " was not used, speech is there already");
    if (!given) account->notes.push_back("speech: no recording, " + Absent(spec_.absent_speech));
    return Status();
  }
  Result<SpeechRows> rows = SpeechRows::Open(sources_.audio, spec_);
  if (!rows.ok()) return rows.status();
  speech_.emplace(*std::move(rows));
  account->used.push_back(sources_.audio + ": " + speech_->Description() + " -> speech, " +
                          Count(static_cast<std::uint64_t>(speech_->total()), "frame"));
  return Status();
}

// The recording decides, or else arrays that are there, or else the words.
Status FrameInputs::CountFrames() {
  if (speech_) {
    total_ = speech_->total();
  } else {
    for (const char* name : {"text", "speech"}) {
      const auto found = sources_.arrays.find(name);
      if (found != sources_.arrays.end()) total_ = found->second.shape[0];
    }
  }
  if (total_ == 0) total_ = sources_.frames;
  if (total_ > 0) return Status();
  if (!HasWords() || sources_.encoder == nullptr) return Nothing();
  const double seconds = sources_.transcript->words.back().end;
  if (seconds > 3600 * kMaxHours)
    return Status(Code::kBadInput, sources_.transcript_path + ": the last word ends after " +
                                       Significant(seconds / 3600, 4) +
                                       " hours, expected at most " + Significant(kMaxHours, 3) +
                                       " without a recording");
  total_ = std::max<std::int64_t>(1, std::llround(std::ceil(seconds * spec_.frame_rate - 1e-6)));
  return Status();
}

// The network takes text, and there are words for it.
bool FrameInputs::HasWords() const {
  return spec_.d_text > 0 && sources_.transcript != nullptr && !sources_.transcript->words.empty();
}

// Why nothing at all could be made.
Status FrameInputs::Nothing() const {
  const std::string where = sources_.transcript_path.empty() ? "input" : sources_.transcript_path;
  const char* why = spec_.d_text == 0 || sources_.transcript == nullptr ? "no recording"
                    : HasWords() ? "the weights file has no BERT for the words"
                                 : "no words";
  return Status(Code::kBadInput, where + ": " + why + ", expected a recording" +
                                     (spec_.d_text == 0 || HasWords() ? "" : " or words"));
}

Status FrameInputs::CheckCounts() const {
  for (const char* name : {"speech", "text"}) {
    const auto found = sources_.arrays.find(name);
    if (found == sources_.arrays.end() || found->second.shape[0] == total_) continue;
    return Status(Code::kBadInput, std::string(name) + ": " +
                                       std::to_string(found->second.shape[0]) +
                                       " frames, expected " + std::to_string(total_))
        .In(sources_.arrays_path);
  }
  return Status();
}

Status FrameInputs::OpenText(Account* account) {
  const words::Transcript* transcript = sources_.transcript;
  const std::string& path = sources_.transcript_path;
  if (sources_.arrays.count("text") != 0) {
    if (transcript != nullptr)
      account->notes.push_back(path + " was not used, text is there already");
    return Status();
  }
  if (!HasWords() || sources_.encoder == nullptr) {
    account->notes.push_back("text: " +
                             std::string(transcript == nullptr ? "no words"
                                         : !HasWords()
                                             ? "the transcript has no words"
                                             : "the weights file has no BERT for the words") +
                             ", " + Absent(spec_.absent_text));
    return Status();
  }
  std::vector<std::string> texts;
  for (const words::Word& word : transcript->words) texts.emplace_back(words::Stripped(word.text));
  pieces_.emplace(sources_.encoder, texts);
  return PlaceWords(account);
}

Status FrameInputs::PlaceWords(Account* account) {
  const std::vector<std::size_t> counts(pieces_->counts().begin(), pieces_->counts().end());
  words::FrameOptions options;
  options.frames = static_cast<std::size_t>(total_);
  options.rate = spec_.frame_rate;
  const Result<words::FramePlan> plan =
      words::PlaceOnFrames(sources_.transcript->words, counts, options);
  if (!plan.ok()) return plan.status().In(sources_.transcript_path);
  std::vector<std::int64_t> first(counts.size() + 1);
  for (std::size_t word = 0; word < counts.size(); ++word)
    first[word + 1] = first[word] + static_cast<std::int64_t>(counts[word]);
  for (const words::FramePiece& at : plan->frames)
    piece_of_frame_.push_back(at.word < 0 ? -1
                                          : first[static_cast<std::size_t>(at.word)] + at.piece);
  account->used.push_back(Describe(*sources_.transcript, sources_.transcript_path) +
                          " -> text, by the BERT of the weights file");
  account->notes.insert(account->notes.end(), plan->notes.begin(), plan->notes.end());
  return Status();
}

std::vector<std::string> FrameInputs::Notes() const {
  return speech_ ? speech_->notes() : std::vector<std::string>();
}

Status FrameInputs::ReadSpeech(std::int64_t count, std::vector<float>* rows) {
  if (speech_) return speech_->Read(count, rows);
  const auto given = sources_.arrays.find("speech");
  if (given != sources_.arrays.end()) {
    AppendRows(given->second, next_, count, rows);
  } else {
    AppendAbsent(spec_.absent_speech, spec_.mel_bins, count, rows);
  }
  return Status();
}

Status FrameInputs::ReadText(std::int64_t count, std::vector<float>* rows) {
  const auto given = sources_.arrays.find("text");
  if (given != sources_.arrays.end()) {
    AppendRows(given->second, next_, count, rows);
    return Status();
  }
  if (!pieces_) {
    AppendAbsent(spec_.absent_text, spec_.d_text, count, rows);
    return Status();
  }
  for (std::int64_t frame = next_; frame < next_ + count; ++frame) {
    const std::int64_t piece = piece_of_frame_[static_cast<std::size_t>(frame)];
    if (piece < 0) {
      AppendAbsent(spec_.absent_text, spec_.d_text, 1, rows);
      continue;
    }
    const Result<const float*> row = pieces_->Row(piece);
    if (!row.ok()) return row.status();
    rows->insert(rows->end(), *row, *row + spec_.d_text);
  }
  return Status();
}

Result<models::Arrays> FrameInputs::Next(std::int64_t count) {
  count = std::min(count, total_ - next_);
  models::Arrays arrays;
  if (count <= 0) return arrays;
  std::vector<float> rows;
  rows.reserve(static_cast<std::size_t>(count * spec_.mel_bins));
  GESTUS_RETURN_IF_ERROR(ReadSpeech(count, &rows));
  arrays["speech"] = Rows(std::move(rows), spec_.mel_bins);
  if (spec_.d_text > 0) {
    rows = {};
    rows.reserve(static_cast<std::size_t>(count * spec_.d_text));
    GESTUS_RETURN_IF_ERROR(ReadText(count, &rows));
    arrays["text"] = Rows(std::move(rows), spec_.d_text);
  }
  next_ += count;
  return arrays;
}

}  // namespace gestus::features
