// Google speech-to-text: the answers of the REST interfaces (v1, v2), of long-running operations,
// and the list that client programs store.
#include "models/words/json_formats.h"

namespace gestus::words {
namespace {

// The list of results, wherever it lies.
const Json* ResultsOf(const Json& root) {
  if (root.is_array()) return &root;
  if (const Json* results = ArrayMember(root, "results")) return results;
  const Json* response = Member(root, "response");
  return response == nullptr ? nullptr : ArrayMember(*response, "results");
}

// The first alternative is the likeliest.
const Json* BestOf(const Json& result) {
  const Json* alternatives = ArrayMember(result, "alternatives");
  return alternatives == nullptr || alternatives->empty() ? nullptr : &alternatives->front();
}

bool HasSpeaker(const Json& word) {
  const Json* speaker = FirstMember(word, {"speakerTag", "speaker_tag"});
  return speaker != nullptr && speaker->is_number() && *speaker != 0;
}

// The place of the last result when it repeats the words of all before it with the speakers' tags,
// as this service does when it tells speakers apart; else the number of results.
std::size_t FindRepetition(const Json& results) {
  const std::size_t none = results.size();
  if (none < 2) return none;
  const auto words_of = [&](std::size_t i) {
    const Json* best = BestOf(results[i]);
    return best == nullptr ? nullptr : ArrayMember(*best, "words");
  };
  const Json* last = words_of(none - 1);
  if (last == nullptr || last->empty() || !HasSpeaker(last->front())) return none;
  for (std::size_t i = 0; i + 1 < none; ++i) {
    const Json* words = words_of(i);
    if (words == nullptr) continue;
    for (const Json& word : *words) {
      if (HasSpeaker(word)) return none;
    }
  }
  return none - 1;
}

Status AddWords(const Json& words, const std::string& where, Draft* draft) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto text = TextOf(words[i], {"word"}, Element(where, i));
    if (!text.ok()) return text.status();
    Span span = SpanOf(words[i]);
    // An offset of 0 is left out.
    if (draft->empty() && span.end >= 0 && span.start != span.start) span.start = 0;
    draft->Add(*text, span);
  }
  return Status();
}

}  // namespace

bool IsGoogle(const Json& root) {
  const Json* results = ResultsOf(root);
  if (results == nullptr) return false;
  if (results->empty()) return !root.is_array();
  return ArrayMember(results->front(), "alternatives") != nullptr;
}

Status ReadGoogle(const Json& root, Draft* draft) {
  const Json& results = *ResultsOf(root);
  const std::size_t repetition = FindRepetition(results);
  const bool repeats = repetition < results.size();
  if (repeats) draft->AddNote("the last result, which repeats the words of all speakers, was used");
  double before = 0;  // where the result before ends
  for (std::size_t i = repeats ? repetition : 0; i < results.size(); ++i) {
    const std::string where = Element("results", i);
    const Json* best = BestOf(results[i]);
    if (best == nullptr) continue;  // silence
    const double end =
        TimeOf(FirstMember(results[i], {"resultEndTime", "resultEndOffset", "result_end_time"}));
    draft->BeginSegment({before, end});
    const Json* words = ArrayMember(*best, "words");
    if (words != nullptr && !words->empty()) {
      GESTUS_RETURN_IF_ERROR(AddWords(*words, where + ".words", draft));
    } else if (Member(*best, "transcript") != nullptr) {
      const auto text = TextOf(*best, {"transcript"}, where);
      if (!text.ok()) return text.status();
      draft->Add(*text, {end == end ? before : kNoTime, end});
    }
    if (end >= before) before = end;
  }
  return Status();
}

}  // namespace gestus::words
