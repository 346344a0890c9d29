#include "models/features/word_inputs.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"
#include "models/prosody/contour.h"
#include "models/run_support.h"
#include "models/words/units.h"

namespace gestus::features {

Result<std::unique_ptr<WordInputs>> WordInputs::Open(const FeatureSpec& spec,
                                                     const WordSources& sources, Account* account) {
  if (spec.text_rows != 1)
    return Status(Code::kInvalidArgument,
                  "text: the network takes " + std::to_string(spec.text_rows) +
                      " rows of each word, expected 1 where words are made into features");
  std::unique_ptr<WordInputs> inputs(new WordInputs(spec, sources));
  GESTUS_RETURN_IF_ERROR(inputs->OpenPitch(account));
  GESTUS_RETURN_IF_ERROR(inputs->MakeItems(account));
  inputs->CutIntoSpans();
  for (const auto& [name, columns] :
       {std::pair{"f0", spec.f0_length}, std::pair{"text", spec.d_text}})
    GESTUS_RETURN_IF_ERROR(inputs->CheckGiven(name, columns).In(sources.arrays_path));
  return inputs;
}

bool WordInputs::HasWords() const {
  return sources_.transcript != nullptr && !sources_.transcript->words.empty();
}

Status WordInputs::OpenPitch(Account* account) {
  const bool given = Given("f0");
  if (sources_.audio.empty()) {
    if (!given) account->notes.push_back("f0: no recording, every word counts as unvoiced");
    return Status();
  }
  if (given) account->notes.push_back(sources_.audio + " was not used, f0 is there already");
  if (given && HasWords()) return Status();
  Result<Pitch> pitch = ReadPitch(sources_.audio, spec_);
  if (!pitch.ok()) return pitch.status();
  pitch_ = *std::move(pitch);
  if (given) return Status();  // but how long the recording is decides how it is cut
  account->used.push_back(sources_.audio + ": " + pitch_.description + " -> f0");
  account->notes.insert(account->notes.end(), pitch_.notes.begin(), pitch_.notes.end());
  return Status();
}

// The arrays have as many rows as there are items.
Status WordInputs::CheckGiven(const char* name, std::int64_t columns) const {
  if (!Given(name)) return Status();
  std::int64_t rows = 0;
  for (const Span& span : spans_) rows += RowsOf(span);
  return models::CheckArray(models::Spec(name, {rows, columns}, {"words", "columns"}, "-", ""),
                            sources_.arrays.at(name));
}

Status WordInputs::MakeItems(Account* account) {
  const words::Transcript* transcript = sources_.transcript;
  if (!HasWords()) return MakeItemsOfSound(account);
  if (sources_.encoder == nullptr && sources_.audio.empty() && sources_.arrays.empty())
    return Status(Code::kBadInput,
                  sources_.transcript_path +
                      ": the weights file has no BERT for the words, expected a recording");
  const Result<std::vector<words::Unit>> units =
      words::MakeUnits(transcript->words, {.pause = spec_.pause, .max_items = 0});
  if (!units.ok()) return units.status().In(sources_.transcript_path);
  for (const words::Unit& unit : *units) {
    units_.push_back({items_.size(), unit.items.size()});
    for (const words::UnitItem& item : unit.items) {
      const std::string text =
          item.is_comma() ? "," : std::string(words::Stripped(transcript->words[item.word].text));
      items_.push_back({text, item.start, item.end, item.is_comma()});
    }
  }
  account->used.push_back(
      Describe(*transcript, sources_.transcript_path) + " -> " + Count(items_.size(), "item") +
      " in " + Count(units_.size(), "inter-pausal unit") +
      (sources_.encoder != nullptr ? ", text by the BERT of the weights file" : ""));
  if (sources_.encoder == nullptr && !Given("text"))
    account->notes.push_back(
        "text: the weights file has no BERT for the words, zeros stand for it");
  if (!pitch_.f0.empty()) NoteTimes(account);
  return Status();
}

// What of the words the f0 of the recording does not cover.
void WordInputs::NoteTimes(Account* account) const {
  const double longest = (static_cast<double>(spec_.f0_length) + 0.5) * spec_.pitch_hop;
  std::size_t cut = 0, outside = 0;
  for (const words::Word& word : sources_.transcript->words) {
    cut += word.end - word.start > longest;
    outside += word.start >= pitch_.seconds;
  }
  const std::string all = " of " + Count(sources_.transcript->words.size(), "word");
  if (cut > 0)
    account->notes.push_back("f0: " + std::to_string(cut) + all + " last longer than " +
                             std::to_string(spec_.f0_length) + " values and were cut");
  if (outside > 0)
    account->notes.push_back("f0: " + std::to_string(outside) + all +
                             " begin behind the end of the recording");
}

// Without words there is no telling where one ends: each is as long as a word may be.
Status WordInputs::MakeItemsOfSound(Account* account) {
  if (pitch_.f0.empty())
    return Status(Code::kBadInput,
                  (sources_.transcript_path.empty() ? "input" : sources_.transcript_path) +
                      ": neither a recording nor words, expected one of them");
  const double length = static_cast<double>(spec_.f0_length) * spec_.pitch_hop;
  const double count = std::max(1.0, std::ceil(pitch_.seconds / length - 1e-6));
  for (double i = 0; i < count; ++i)
    items_.push_back(
        {"", i * length, std::max(i * length, std::min((i + 1) * length, pitch_.seconds))});
  units_.push_back({0, items_.size()});
  sources_.encoder = nullptr;
  account->notes.push_back("f0: no words, the recording was cut into words of " +
                           Significant(length, 3) + " s");
  if (!Given("text")) account->notes.push_back("text: no words, zeros stand for them");
  return Status();
}

void WordInputs::CutIntoSpans() {
  const bool windows = spec_.layout == Layout::kWindows;
  const auto most = static_cast<std::size_t>(windows ? spec_.max_words : 1);
  for (std::size_t unit = 0; unit < units_.size(); ++unit) {
    const std::size_t end = units_[unit].first + units_[unit].count;
    for (std::size_t first = units_[unit].first; first < end;) {
      std::size_t count = std::min(most, end - first);
      // A silence between two windows belongs to neither.
      const bool skip = windows && items_[first].comma;
      if (!skip)
        spans_.push_back({first, count - (windows && items_[first + count - 1].comma), unit});
      first += skip ? 1 : count;
    }
  }
}

// A window that is not full ends in words without f0 and meaning, as in training (features.md 2.4).
std::int64_t WordInputs::RowsOf(const Span& span) const {
  return spec_.layout == Layout::kWindows ? spec_.max_words : static_cast<std::int64_t>(span.count);
}

Status WordInputs::AddText(const Span& span, std::vector<float>* text) {
  const auto columns = static_cast<std::size_t>(spec_.d_text);
  const std::size_t rows = static_cast<std::size_t>(RowsOf(span));
  if (Given("text")) {
    AddGiven("text", RowsOf(span), text);
    return Status();
  }
  if (sources_.encoder == nullptr) {
    text->insert(text->end(), rows * columns, 0.0f);
    return Status();
  }
  const UnitOfItems& unit = units_[span.unit];
  if (encoded_unit_ != span.unit) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < unit.count; ++i) words.push_back(items_[unit.first + i].text);
    const Result<Pieces> pieces = sources_.encoder->Encode(words);
    if (!pieces.ok()) return pieces.status();
    encoded_ = pieces->WordMeans();
    encoded_unit_ = span.unit;
  }
  const auto from =
      encoded_.begin() + static_cast<std::ptrdiff_t>((span.first - unit.first) * columns);
  text->insert(text->end(), from, from + static_cast<std::ptrdiff_t>(span.count * columns));
  text->insert(text->end(), (rows - span.count) * columns, 0.0f);
  return Status();
}

Status WordInputs::AddPitch(const Span& span, std::vector<float>* f0) const {
  const auto length = static_cast<std::size_t>(spec_.f0_length);
  const std::size_t rows = static_cast<std::size_t>(RowsOf(span));
  if (Given("f0")) {
    AddGiven("f0", RowsOf(span), f0);
    return Status();
  }
  std::vector<prosody::WordSpan> words;
  for (std::size_t i = 0; i < span.count; ++i) {
    const Item& item = items_[span.first + i];
    words.push_back({item.start, item.comma ? item.start : item.end});
  }
  prosody::ContourOptions options;
  options.hop_seconds = spec_.pitch_hop;
  options.values = length;
  options.ends = spec_.pitch_ends == PitchEnds::kLinear ? prosody::ContourEnds::kLinear
                                                        : prosody::ContourEnds::kNearest;
  options.min_hz = spec_.pitch_minimum;
  options.max_hz = spec_.pitch_maximum;
  const Result<prosody::WordContours> contours =
      prosody::ContoursOfWords(pitch_.f0.data(), pitch_.f0.size(), 1, words, options);
  if (!contours.ok()) return contours.status();
  f0->insert(f0->end(), contours->hz.begin(), contours->hz.end());
  f0->insert(f0->end(), (rows - span.count) * length, 0.0f);
  return Status();
}

void WordInputs::AddGiven(const char* name, std::int64_t count, std::vector<float>* rows) const {
  const models::Array& array = sources_.arrays.at(name);
  const auto from = array.f32.begin() + next_row_ * array.shape[1];
  rows->insert(rows->end(), from, from + count * array.shape[1]);
}

Result<models::Arrays> WordInputs::Next(std::int64_t count) {
  models::Arrays arrays;
  const std::size_t end = std::min(spans_.size(), next_ + static_cast<std::size_t>(count));
  if (next_ >= end) return arrays;
  std::vector<float> f0, text;
  for (; next_ < end; ++next_) {
    GESTUS_RETURN_IF_ERROR(AddPitch(spans_[next_], &f0));
    GESTUS_RETURN_IF_ERROR(AddText(spans_[next_], &text));
    next_row_ += RowsOf(spans_[next_]);
  }
  for (auto& [name, values, columns] :
       {std::tuple{"f0", &f0, spec_.f0_length}, std::tuple{"text", &text, spec_.d_text}}) {
    models::Array& array = arrays[name];
    array.shape = {static_cast<std::int64_t>(values->size()) / columns, columns};
    array.f32 = std::move(*values);
  }
  return arrays;
}

models::Arrays WordInputs::Beside() const {
  models::Array times;
  times.dtype = DType::kI32;
  times.shape = {total(), 2};
  for (const Span& span : spans_) {
    for (const double seconds : {items_[span.first].start, items_[span.first + span.count - 1].end})
      times.i32.push_back(static_cast<std::int32_t>(std::lround(1000 * seconds)));
  }
  return {{"times_ms", std::move(times)}};
}

}  // namespace gestus::features
