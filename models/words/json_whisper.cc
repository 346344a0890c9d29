// The JSON of the Whisper family: whisper.cpp (-oj and -ojf), openai-whisper, faster-whisper and
// WhisperX.
#include <cmath>

#include "models/words/json_formats.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// Segments of whisper.cpp that are parts of one word follow each other without a pause.
constexpr double kSameWord = 0.05;

// "offsets" in whole milliseconds; else "timestamps" as clock times.
Span WhisperCppSpan(const Json& object) {
  if (const Json* offsets = Member(object, "offsets")) {
    const double from = TimeOf(Member(*offsets, "from")), to = TimeOf(Member(*offsets, "to"));
    if (!std::isnan(from) || !std::isnan(to)) return {from / 1000, to / 1000};
  }
  const Json* stamps = Member(object, "timestamps");
  if (stamps == nullptr) return {};
  return {TimeOf(Member(*stamps, "from")), TimeOf(Member(*stamps, "to"))};
}

// "[_BEG_]", "[_TT_150]", "<|endoftext|>": marks of the model, not text.
bool IsSpecialToken(std::string_view text) {
  return (text.starts_with("[_") && text.ends_with("]")) ||
         (text.starts_with("<|") && text.ends_with("|>"));
}

struct Piece {
  std::string_view text;
  Span span;
  bool token;           // of a segment's "tokens"; otherwise a whole segment
  std::size_t segment;  // its index in `segments`
};

struct Segment {
  Span span;
  bool one_word;  // no blank in its text: a script that has none, or really one word
};

struct Pieces {
  std::vector<Piece> pieces;
  std::vector<Segment> segments;
  Spacing spacing;

  void Add(const Piece& piece) {
    pieces.push_back(piece);
    spacing.Count(piece.text);
  }
};

// The tokens of a segment; false when none of them has a time.
Result<bool> CollectTokens(const Json& tokens, const std::string& where, Pieces* to) {
  const std::size_t before = to->pieces.size();
  bool timed = false;
  const Spacing spacing = to->spacing;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const auto text = TextOf(tokens[i], {"text"}, Element(where, i));
    if (!text.ok()) return text.status();
    if (IsSpecialToken(*text)) continue;
    const Span span = WhisperCppSpan(tokens[i]);
    timed |= !std::isnan(span.start);
    to->Add({*text, span, true, to->segments.size() - 1});
  }
  if (timed) return true;
  to->pieces.resize(before);
  to->spacing = spacing;
  return false;
}

void AddPieces(const Pieces& collected, Draft* draft) {
  std::size_t segment = collected.segments.size();  // none yet
  bool blank = true;                                // before the piece
  double end = kNoTime;                             // of the piece before
  for (const Piece& piece : collected.pieces) {
    bool joins = !blank && collected.spacing.Continues(piece.text);
    if (piece.token) {
      // Scripts without blanks: the tokens of a segment belong together but for ideographs.
      joins |= !collected.spacing.spaced() && piece.segment == segment && !piece.text.empty() &&
               collected.segments[segment].one_word && !IsIdeograph(DecodeAt(piece.text, 0).value);
    } else {
      joins = joins && std::fabs(piece.span.start - end) < kSameWord;
    }
    if (piece.segment != segment) {
      segment = piece.segment;
      // A word that goes on over the border stays in the segment in which it began.
      if (!joins) draft->BeginSegment(collected.segments[segment].span);
    }
    draft->Add(piece.text, piece.span, joins);
    blank = piece.text.empty() || IsSpace(DecodeBefore(piece.text, piece.text.size()).value);
    end = piece.span.end;
  }
}

Status AddWords(const Json& words, const std::string& where, const Spacing& spacing, Draft* draft) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto text = TextOf(words[i], {"word", "text"}, Element(where, i));
    if (!text.ok()) return text.status();
    draft->Add(*text, SpanOf(words[i]), i > 0 && spacing.Continues(*text));
  }
  return Status();
}

const Json* SegmentsOf(const Json& root) {
  return root.is_array() ? &root : ArrayMember(root, "segments");
}

// How the words of all segments are spaced, how many they are, and who wrote them.
struct Survey {
  Spacing spacing;
  std::size_t words = 0;
  bool scores = false;  // WhisperX has them in the place of probabilities
};

Survey SurveySegments(const Json& segments) {
  Survey survey;
  for (const Json& segment : segments) {
    const Json* words = ArrayMember(segment, "words");
    if (words == nullptr) continue;
    survey.words += words->size();
    for (const Json& word : *words) {
      const Json* text = FirstMember(word, {"word", "text"});
      if (text != nullptr && text->is_string()) {
        survey.spacing.Count(text->get_ref<const std::string&>());
      }
      survey.scores |= Member(word, "score") != nullptr;
    }
  }
  return survey;
}

}  // namespace

bool IsWhisperCpp(const Json& root) { return ArrayMember(root, "transcription") != nullptr; }

Status ReadWhisperCpp(const Json& root, Draft* draft) {
  const Json& segments = *ArrayMember(root, "transcription");
  Pieces collected;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string where = Element("transcription", i);
    const auto text = TextOf(segments[i], {"text"}, where);
    if (!text.ok()) return text.status();
    const Span span = WhisperCppSpan(segments[i]);
    collected.segments.push_back({span, SplitAtSpace(*text, 2).size() < 2});
    if (const Json* tokens = ArrayMember(segments[i], "tokens")) {
      const Result<bool> timed = CollectTokens(*tokens, where + ".tokens", &collected);
      if (!timed.ok()) return timed.status();
      if (*timed) continue;
    }
    collected.Add({*text, span, false, i});
  }
  AddPieces(collected, draft);
  return Status();
}

bool IsSegments(const Json& root) {
  const Json* segments = SegmentsOf(root);
  if (segments == nullptr) return false;
  if (segments->empty()) return !root.is_array();
  const Json& first = segments->front();
  return ArrayMember(first, "words") != nullptr || !root.is_array() ||
         (Member(first, "text") != nullptr && Member(first, "word") == nullptr);
}

Status ReadSegments(const Json& root, Draft* draft) {
  const Json& segments = *SegmentsOf(root);
  const Survey survey = SurveySegments(segments);
  const Json* flat = ArrayMember(root, "word_segments");
  if (root.is_array()) draft->set_format("JSON list of phrases");
  if (survey.scores || flat != nullptr) draft->set_format("WhisperX JSON");
  // OpenAI's service lists the words beside the segments.
  if (flat == nullptr) flat = ArrayMember(root, "words");
  if (survey.words == 0 && flat != nullptr && !flat->empty()) {
    return AddWords(*flat, "words", Spacing(), draft);
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string where = Element("segments", i);
    const Span span = SpanOf(segments[i]);
    draft->BeginSegment(span);
    const Json* words = ArrayMember(segments[i], "words");
    if (words != nullptr && !words->empty()) {
      GESTUS_RETURN_IF_ERROR(AddWords(*words, where + ".words", survey.spacing, draft));
      continue;
    }
    const auto text = TextOf(segments[i], {"text"}, where);
    if (!text.ok()) return text.status();
    // Captions of YouTube stay while the next ones are spoken.
    const double next = i + 1 < segments.size() ? SpanOf(segments[i + 1]).start : kNoTime;
    draft->Add(*text, {span.start, next > span.start && next < span.end ? next : span.end});
  }
  return Status();
}

}  // namespace gestus::words
