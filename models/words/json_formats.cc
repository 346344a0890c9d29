#include "models/words/json_formats.h"

#include <cmath>
#include <utility>

#include "models/words/formats.h"
#include "models/words/json_text.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

struct JsonFormat {
  const char* name;
  bool (*is)(const Json&);
  Status (*read)(const Json&, Draft*);
};

constexpr JsonFormat kJsonFormats[] = {{"whisper.cpp JSON", IsWhisperCpp, ReadWhisperCpp},
                                       {"Google speech JSON", IsGoogle, ReadGoogle},
                                       {"Gentle JSON", IsGentle, ReadGentle},
                                       {"openai-whisper JSON", IsSegments, ReadSegments},
                                       {"MFA JSON", IsTiers, ReadTiers},
                                       {"JSON word list", IsWordList, ReadWordList}};

double NumberOf(const Json* value) {
  if (value == nullptr) return 0;
  if (value->is_number()) return value->get<double>();
  double number = 0;
  return value->is_string() && ParseTime(value->get_ref<const std::string&>(), &number) ? number
                                                                                        : 0;
}

}  // namespace

const Json* ArrayMember(const Json& object, const char* name) {
  const Json* member = Member(object, name);
  return member != nullptr && member->is_array() ? member : nullptr;
}

const Json* FirstMember(const Json& object, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const Json* member = Member(object, name);
    if (member != nullptr && !member->is_null()) return member;
  }
  return nullptr;
}

double TimeOf(const Json* value) {
  if (value == nullptr) return kNoTime;
  if (value->is_number()) return value->get<double>();
  // Protocol buffers leave out what is 0.
  if (value->is_object()) {
    return NumberOf(Member(*value, "seconds")) + NumberOf(Member(*value, "nanos")) * 1e-9;
  }
  double seconds = 0;
  const bool is_time =
      value->is_string() && ParseTime(value->get_ref<const std::string&>(), &seconds);
  return is_time ? seconds : kNoTime;
}

Span SpanOf(const Json& object) {
  Span span = {TimeOf(FirstMember(object, {"start", "start_time", "startTime", "startOffset"})),
               TimeOf(FirstMember(object, {"end", "end_time", "endTime", "endOffset"}))};
  if (std::isnan(span.end)) span.end = span.start + TimeOf(Member(object, "duration"));
  return span;
}

Result<std::string_view> TextOf(const Json& object, std::initializer_list<const char*> names,
                                const std::string& where) {
  const Json* text = FirstMember(object, names);
  if (text != nullptr && text->is_string()) {
    return std::string_view(text->get_ref<const std::string&>());
  }
  const std::string name = std::string("'") + *names.begin() + "'";
  if (!object.is_object()) {
    return Status(Code::kBadInput, where + ": is no object, expected one with " + name);
  }
  return Status(Code::kBadInput, where + ": has no string " + name);
}

std::string Element(const std::string& array, std::size_t index) {
  return array + "[" + std::to_string(index) + "]";
}

void Spacing::Count(std::string_view piece) {
  if (TrimSpace(piece).empty()) return;
  ++pieces_;
  blanks_ += IsSpace(DecodeAt(piece, 0).value) ? 1 : 0;
}

bool Spacing::Continues(std::string_view piece) const {
  if (piece.empty() || !spaced()) return false;
  const char32_t first = DecodeAt(piece, 0).value;
  return !IsSpace(first) && !IsIdeograph(first);
}

bool LooksLikeJson(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return false;
  if (text[first] == '{') return true;
  // "[00:00:00.000 --> ..." and "[Music]" are no arrays of objects.
  const std::size_t second = text.find_first_not_of(" \t\r\n", first + 1);
  return text[first] == '[' && second != std::string_view::npos &&
         (text[second] == '{' || text[second] == '[' || text[second] == ']');
}

Result<Draft> ReadJson(std::string_view text) {
  const JsonText repaired = RepairJson(text);
  const Result<Json> root = ParseJson(repaired.text);
  if (!root.ok()) return root.status();
  for (const JsonFormat& format : kJsonFormats) {
    if (!format.is(*root)) continue;
    Draft draft(format.name);
    draft.set_escaped(repaired.escaped);
    GESTUS_RETURN_IF_ERROR(format.read(*root, &draft));
    return draft;
  }
  if (root->is_array() && root->empty()) return Draft("empty JSON list");
  return Status(
      Code::kBadInput,
      "is JSON of a kind that gestus does not know, expected 'transcription' "
      "(whisper.cpp), 'segments' (Whisper, WhisperX), 'results' (Google), 'words' (Gentle) "
      "or 'tiers' (MFA)");
}

}  // namespace gestus::words
