// Inputs word by word: f0 and X_text of Model 1 and Model 2.
#ifndef GESTUS_MODELS_FEATURES_WORD_INPUTS_H_
#define GESTUS_MODELS_FEATURES_WORD_INPUTS_H_

#include <memory>
#include <string>
#include <vector>

#include "models/features/input_stream.h"
#include "models/features/pitch.h"
#include "models/features/spec.h"
#include "models/features/word_encoder.h"
#include "models/words/transcript.h"

namespace gestus::features {

struct WordSources {
  models::Arrays arrays;  ///< "f0", "text": taken as they are
  std::string arrays_path;
  std::string audio;  ///< path; empty: f0 is 0 everywhere
  const words::Transcript* transcript = nullptr;
  std::string transcript_path;
  WordEncoder* encoder = nullptr;  ///< null: text is 0 everywhere
};

/// Streams "f0" (words, f0_length) and "text" (words, d_text).
///
/// Speech is cut into inter-pausal units at silences longer than spec.pause; a shorter silence is a
/// word of its own, ",", without f0 (thesis 5.6.1).  The words of a unit see one another in BERT,
/// and a word of several pieces gets their mean.  With Layout::kWindows units are cut into windows
/// of max_words, which begin and end with a word, and filled up with rows of zeros.  Without words
/// the recording is cut into words as long as f0_length values.  An error when there is nothing but
/// zeros to give.
///
/// Beside the outputs stands "times_ms" (words or windows, 2) int32: when each begins and ends.
class WordInputs final : public InputStream {
 public:
  static Result<std::unique_ptr<WordInputs>> Open(const FeatureSpec& spec,
                                                  const WordSources& sources, Account* account);

  std::int64_t total() const override { return static_cast<std::int64_t>(spans_.size()); }
  std::int64_t unit() const override { return 1; }
  Result<models::Arrays> Next(std::int64_t count) override;
  models::Arrays Beside() const override;

 private:
  struct Item {
    std::string text;
    double start, end;
    bool comma = false;
  };
  // Items [first, first + count) are one row of output; all of `unit` are encoded together.
  struct Span {
    std::size_t first, count, unit;
  };
  struct UnitOfItems {
    std::size_t first, count;
  };

  WordInputs(const FeatureSpec& spec, WordSources sources)
      : spec_(spec), sources_(std::move(sources)) {}
  bool Given(const char* name) const { return sources_.arrays.count(name) != 0; }
  bool HasWords() const;
  Status OpenPitch(Account* account);
  Status MakeItems(Account* account);
  Status MakeItemsOfSound(Account* account);
  void NoteTimes(Account* account) const;
  void CutIntoSpans();
  Status CheckGiven(const char* name, std::int64_t columns) const;
  Status AddText(const Span& span, std::vector<float>* text);
  Status AddPitch(const Span& span, std::vector<float>* f0) const;
  void AddGiven(const char* name, std::int64_t count, std::vector<float>* rows) const;
  std::int64_t RowsOf(const Span& span) const;

  FeatureSpec spec_;
  WordSources sources_;
  Pitch pitch_;
  std::vector<Item> items_;
  std::vector<UnitOfItems> units_;
  std::vector<Span> spans_;
  std::size_t next_ = 0;
  std::int64_t next_row_ = 0;  // of the arrays
  std::size_t encoded_unit_ = static_cast<std::size_t>(-1);
  std::vector<float> encoded_;  // (items of that unit, d_text)
};

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_WORD_INPUTS_H_
