#include "models/features/sentence_inputs.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"
#include "models/words/units.h"

namespace gestus::features {
namespace {

std::int32_t Milliseconds(double seconds) {
  return static_cast<std::int32_t>(std::lround(1000 * seconds));
}

/// The transcript as one sentence.
words::Sentence Whole(const words::Transcript& transcript) {
  words::Sentence all{0, transcript.words.size(), 0, 0, ""};
  for (const words::Word& word : transcript.words) {
    all.text += (all.text.empty() ? "" : " ") + std::string(words::Stripped(word.text));
    all.end = word.end;
  }
  if (!transcript.words.empty()) all.start = transcript.words.front().start;
  return all;
}

}  // namespace

Result<std::unique_ptr<SentenceInputs>> SentenceInputs::Open(const FeatureSpec& spec,
                                                             const words::Transcript& transcript,
                                                             const std::string& path,
                                                             const models::WordPiece& tokeniser,
                                                             Account* account) {
  std::vector<words::Sentence> sentences;
  if (spec.classifies) {
    sentences = words::MakeSentences(transcript.words, {.pause = spec.pause});
  } else {
    sentences.push_back(Whole(transcript));
  }
  auto inputs = std::make_unique<SentenceInputs>();
  const auto most = static_cast<std::size_t>(spec.positions - 2);
  std::size_t shortened = 0;
  for (const words::Sentence& sentence : sentences) {
    std::vector<std::int32_t> ids;
    for (const models::Token& token : tokeniser.Tokenise(sentence.text)) ids.push_back(token.id);
    if (ids.empty()) continue;
    if (spec.classifies && ids.size() > most) {
      ids.resize(most);
      ++shortened;
    }
    inputs->ids_.push_back(std::move(ids));
    inputs->times_ms_.push_back(Milliseconds(sentence.start));
    inputs->times_ms_.push_back(Milliseconds(sentence.end));
  }
  if (inputs->ids_.empty()) return Status(Code::kBadInput, path + ": has no words, expected some");
  account->used.push_back(Describe(transcript, path) + " -> ids, " +
                          (spec.classifies ? Count(inputs->ids_.size(), "sentence")
                                           : Count(inputs->ids_[0].size(), "piece")));
  if (shortened > 0)
    account->notes.push_back(Count(shortened, "sentence") + " had more than " +
                             std::to_string(most) + " pieces, only the beginning was read");
  return inputs;
}

Result<models::Arrays> SentenceInputs::Next(std::int64_t count) {
  models::Arrays arrays;
  const std::size_t end = std::min(ids_.size(), next_ + static_cast<std::size_t>(count));
  if (next_ >= end) return arrays;
  std::size_t longest = 0;
  for (std::size_t i = next_; i < end; ++i) longest = std::max(longest, ids_[i].size());
  models::Array& ids = arrays["ids"];
  ids.dtype = DType::kI32;
  ids.shape = {static_cast<std::int64_t>(end - next_), static_cast<std::int64_t>(longest)};
  for (; next_ < end; ++next_) {
    ids.i32.insert(ids.i32.end(), ids_[next_].begin(), ids_[next_].end());
    ids.i32.insert(ids.i32.end(), longest - ids_[next_].size(), 0);
  }
  return arrays;
}

models::Arrays SentenceInputs::Beside() const {
  models::Array times;
  times.dtype = DType::kI32;
  times.shape = {total(), 2};
  times.i32 = times_ms_;
  return {{"times_ms", std::move(times)}};
}

}  // namespace gestus::features
