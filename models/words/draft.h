// What a reader of a format hands in: words in the order of the file, some without times, some in
// the wrong order.  Finish() makes a transcript of it, the same way for every format.  A private
// header of models/words.
#ifndef GESTUS_MODELS_WORDS_DRAFT_H_
#define GESTUS_MODELS_WORDS_DRAFT_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/status.h"
#include "models/words/times.h"
#include "models/words/transcript.h"

namespace gestus::words {

/// A stretch of time in seconds; kNoTime where the file does not say.
struct Span {
  double start = kNoTime, end = kNoTime;
};

class Draft {
 public:
  explicit Draft(std::string format) : format_(std::move(format)) {}

  /// The words that follow were said within `span`: a phrase, a segment, a cue.
  void BeginSegment(Span span);
  /// One word; or a phrase, whose words share its time by their numbers of characters.  With
  /// `joins` its first word continues the word before it, as pieces of words do.
  void Add(std::string_view text, Span span, bool joins = false);
  void AddNote(std::string note) { notes_.push_back(std::move(note)); }
  /// Bytes that are not UTF-8 stand in the texts as RepairJson() wrote them.
  void set_escaped(bool escaped) { escaped_ = escaped; }
  void set_format(std::string format) { format_ = std::move(format); }

  bool empty() const { return words_.empty(); }
  std::size_t size() const { return words_.size(); }

  /// Takes whole numbers that make sense only as milliseconds for milliseconds.  For formats of no
  /// fixed unit.
  void GuessUnit();

  /// Repairs texts and times, fills what is missing, sorts, and cuts overlaps; each with one note
  /// that counts the cases.
  Result<Transcript> Finish() &&;

 private:
  struct Entry {  // a word
    std::string text;
    Span span;
    bool timed;
    std::size_t segment;
  };

  void Append(std::string_view text, Span span, bool timed);
  void NoteUnit(std::string_view text, Span span);
  void RepairTexts();
  void DropSounds();
  void AttachPunctuation();
  // draft_times.cc
  Status CheckTimes();
  Status FillMissing();
  double SecondsPerCharacter() const;
  std::vector<double> NextKnown(double rate) const;
  void FillPartial(double rate, const std::vector<double>& next);
  void FillRun(std::size_t first, std::size_t last, double next, double rate);
  bool StartsSegment(std::size_t i) const;
  bool EndsSegment(std::size_t i) const;
  void SortAndCut();

  std::string format_;
  std::vector<std::string> notes_;
  std::vector<Entry> words_;
  std::vector<Span> segments_ = {Span{}};  // the first is what comes before any segment
  // Of the phrases as the file has them, for GuessUnit().
  bool whole_times_ = true;
  double phrase_seconds_ = 0, phrase_characters_ = 0;
  bool escaped_ = false;
  bool too_many_ = false;
};

/// The ends of the parts of `span` that `parts` get by their numbers of characters.
std::vector<double> ShareByLength(const std::vector<std::string_view>& parts, Span span);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_DRAFT_H_
