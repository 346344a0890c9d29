// Words into the pieces that BERT knows: the published tokeniser of bert-base-uncased (Devlin et
// al. 2019; tokenization.py of google-research/bert, BasicTokenizer and WordpieceTokenizer).
//
//   auto words = WordPiece::Make(bytes_of_vocab_txt);
//   if (!words.ok()) return words.status();
//   auto sentence = words->Frame("Deep learning.", 512);  // [CLS] deep learning . [SEP]
//
// 1. U+0000, U+FFFD and characters of category C* are dropped, as by Hugging Face's BertTokenizer;
//    google-research/bert drops Cc and Cf and keeps the unassigned and the private ones.  A byte
//    that is not UTF-8 counts as U+FFFD.  White space separates, and a Chinese character is a word
//    of its own.
// 2. Lower case as Python's str.lower(), canonical decomposition, and accents (Mn) are dropped.
// 3. A punctuation character is a word of its own.
// 4. Each word becomes the longest pieces from its left end, "##" before all but the first; a word
//    that this does not reach the end of, or of more than 100 characters, becomes [UNK].
//
// "[CLS]", "[SEP]", "[MASK]", "[UNK]" and "[PAD]" in the text are text like any other: brackets and
// letters, as in the published BasicTokenizer.
#ifndef GESTUS_MODELS_TEXT_WORDPIECE_H_
#define GESTUS_MODELS_TEXT_WORDPIECE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/status.h"
#include "models/text/vocabulary.h"

namespace gestus::models {

struct WordPieceOptions {
  bool lower_case = true;             ///< step 2; without it letters stay as they are
  std::int64_t max_word_chars = 100;  ///< longer words are [UNK]; counted after step 3
};

/// Bytes [begin, end) of the original text: from the first byte of the token's first character to
/// the last of its last.  Neither ever decreases from one token to the next.  Tokens share bytes
/// only where step 2 makes several characters of one, as it does of Hangul syllables, or may
/// exchange neighbouring marks that are not accents.
struct Token {
  std::int32_t id;
  std::size_t begin, end;
};

struct Sentence {
  std::vector<Token> tokens;  ///< [CLS], the text, [SEP]; the two frames cover no bytes
  std::size_t left_out = 0;   ///< tokens at the end of the text for which there was no room
};

/// Immutable; any number of threads may use it.
class WordPiece {
 public:
  /// `vocabulary` is the content of a vocab.txt: one token a line, its number is the id.
  static Result<WordPiece> Make(std::string vocabulary, const WordPieceOptions& options = {});

  /// The pieces of any bytes.  Time grows with the length of the text, whatever it holds.
  std::vector<Token> Tokenise(std::string_view text) const;
  /// At most `max_tokens` >= 2 tokens, the frames included; `left_out` says what that cost.
  Result<Sentence> Frame(std::string_view text, std::size_t max_tokens) const;

  const Vocabulary& vocabulary() const { return vocabulary_; }
  std::int32_t unk() const { return unk_; }
  std::int32_t cls() const { return cls_; }
  std::int32_t sep() const { return sep_; }

 private:
  WordPiece(Vocabulary vocabulary, const WordPieceOptions& options)
      : vocabulary_(std::move(vocabulary)), options_(options) {}

  Vocabulary vocabulary_;
  WordPieceOptions options_;
  std::int32_t unk_ = -1, cls_ = -1, sep_ = -1;
};

}  // namespace gestus::models

#endif  // GESTUS_MODELS_TEXT_WORDPIECE_H_
