// The JSON of aligners (Gentle, the Montreal Forced Aligner) and plain lists of words.
#include "models/words/json_formats.h"
#include "models/words/tiers.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

const Json* WordsOf(const Json& root) {
  if (root.is_array()) return &root;
  for (const char* name : {"words", "word_segments", "result"}) {
    if (const Json* words = ArrayMember(root, name)) return words;
  }
  return nullptr;
}

// A transcript in which Gentle's offsets, which count characters, find their bytes.
class IndexedText {
 public:
  explicit IndexedText(std::string_view text) : text_(text) {
    for (std::size_t at = 0; at < text.size(); at += DecodeAt(text, at).bytes) {
      starts_.push_back(at);
    }
    starts_.push_back(text.size());
  }

  /// The punctuation right behind character `end` of the text, at most a few signs.
  std::string_view PunctuationAt(double end) const {
    if (!(end >= 0 && end < static_cast<double>(starts_.size()))) return {};
    const std::size_t begin = starts_[static_cast<std::size_t>(end)];
    std::size_t at = begin;
    constexpr std::size_t kMaxBytes = 12;
    while (at < text_.size() && at - begin < kMaxBytes) {
      const Character c = DecodeAt(text_, at);
      if (!IsPunctuation(c.value)) return text_.substr(begin, at - begin);
      at += c.bytes;
    }
    return at == text_.size() ? text_.substr(begin, at - begin) : std::string_view();
  }

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;  // of characters, in bytes
};

std::string_view StringMember(const Json& object, const char* name) {
  const Json* member = Member(object, name);
  return member != nullptr && member->is_string()
             ? std::string_view(member->get_ref<const std::string&>())
             : std::string_view();
}

// One interval of MFA: [start, end, label], or an object of these.
Status AddEntry(const Json& entry, const std::string& where, Tier* tier) {
  const bool listed = entry.is_array() && entry.size() >= 3 && entry[2].is_string();
  if (!listed && !entry.is_object()) {
    return Status(Code::kBadInput, where + ": is no interval, expected [start, end, label]");
  }
  if (listed) {
    tier->intervals.push_back(
        {{TimeOf(&entry[0]), TimeOf(&entry[1])}, entry[2].get<std::string>()});
    return Status();
  }
  const auto label = TextOf(entry, {"label", "text", "name"}, where);
  if (!label.ok()) return label.status();
  tier->intervals.push_back({SpanOf(entry), std::string(*label)});
  return Status();
}

Status AddTier(const Json& json, std::string name, std::vector<Tier>* tiers) {
  const Json* entries = ArrayMember(json, "entries");
  if (entries == nullptr) return Status();
  Tier tier{std::move(name), {}};
  for (std::size_t i = 0; i < entries->size(); ++i) {
    // Points of time have two elements.
    const Json& entry = (*entries)[i];
    if (entry.is_array() && entry.size() == 2) return Status();
    GESTUS_RETURN_IF_ERROR(AddEntry(entry, Element("entries", i), &tier));
  }
  tiers->push_back(std::move(tier));
  return Status();
}

}  // namespace

bool IsGentle(const Json& root) {
  const Json* words = ArrayMember(root, "words");
  if (words == nullptr || ArrayMember(root, "segments") != nullptr) return false;
  const bool has_transcript = Member(root, "transcript") != nullptr;
  return words->empty() ? has_transcript : Member(words->front(), "case") != nullptr;
}

Status ReadGentle(const Json& root, Draft* draft) {
  const Json& words = *ArrayMember(root, "words");
  const IndexedText transcript(StringMember(root, "transcript"));
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string where = Element("words", i);
    // What was heard but is not in the transcript, as "uh", has only its aligned form.
    const bool unwritten = StringMember(words[i], "case") == "not-found-in-transcript";
    const auto text = unwritten ? TextOf(words[i], {"alignedWord", "word"}, where)
                                : TextOf(words[i], {"word", "alignedWord"}, where);
    if (!text.ok()) return text.status();
    if (unwritten && (*text == "<unk>" || *text == "[oov]")) continue;
    // Here startOffset and endOffset are places in the transcript, not times.
    draft->Add(*text, {TimeOf(Member(words[i], "start")), TimeOf(Member(words[i], "end"))});
    const Json* end = Member(words[i], "endOffset");
    if (unwritten || end == nullptr || !end->is_number()) continue;
    const std::string_view signs = transcript.PunctuationAt(end->get<double>());
    if (!signs.empty() && !text->ends_with(signs)) draft->Add(signs, {}, /*joins=*/true);
  }
  return Status();
}

bool IsTiers(const Json& root) {
  const Json* tiers = Member(root, "tiers");
  return tiers != nullptr && (tiers->is_object() || tiers->is_array());
}

Status ReadTiers(const Json& root, Draft* draft) {
  std::vector<Tier> tiers;
  for (const auto& [name, tier] : Member(root, "tiers")->items()) {
    const std::string_view own = StringMember(tier, "name");
    GESTUS_RETURN_IF_ERROR(AddTier(tier, own.empty() ? name : std::string(own), &tiers));
  }
  return tiers.empty() ? Status() : AddWordTiers(tiers, draft);
}

bool IsWordList(const Json& root) {
  const Json* words = WordsOf(root);
  if (words == nullptr) return false;
  if (words->empty()) return !root.is_array();
  const Json& first = words->front();
  return FirstMember(first, {"word", "text", "label", "value"}) != nullptr;
}

Status ReadWordList(const Json& root, Draft* draft) {
  const Json& words = *WordsOf(root);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto text = TextOf(words[i], {"word", "text", "label", "value"}, Element("words", i));
    if (!text.ok()) return text.status();
    draft->Add(*text, SpanOf(words[i]));
  }
  draft->GuessUnit();
  return Status();
}

}  // namespace gestus::words
