// Words into pieces, and sentences of pieces.
#include "models/text/wordpiece.h"

#include "models/text/unicode.h"
#include "models/text/words.h"

namespace gestus::models {
namespace {

// Cuts words into pieces; its buffers are reused from word to word.
class PieceWriter {
 public:
  PieceWriter(const Vocabulary& vocabulary, std::int32_t unk, std::size_t max_chars)
      : vocabulary_(vocabulary), unk_(unk), max_chars_(max_chars) {}

  void Write(const std::vector<WordChar>& word) {
    const std::size_t before = tokens_.size();
    if (word.size() <= max_chars_ && Match(word)) return;
    tokens_.resize(before);
    tokens_.push_back({unk_, word.front().begin, word.back().end});
  }

  std::vector<Token> Finish() { return std::move(tokens_); }

 private:
  // False when some rest of the word starts with no piece.
  bool Match(const std::vector<WordChar>& word) {
    bytes_.clear();
    char_ends_.clear();
    for (const WordChar& c : word) {
      AppendUtf8(c.value, &bytes_);
      char_ends_.push_back(bytes_.size());
    }
    std::size_t first = 0;  // the first character of the next piece
    for (std::size_t at = 0; at < bytes_.size();) {
      const std::string_view rest = std::string_view(bytes_).substr(at);
      const Vocabulary::Match match =
          at == 0 ? vocabulary_.LongestStart(rest) : vocabulary_.LongestContinuation(rest);
      if (match.id < 0) return false;
      at += match.bytes;
      std::size_t last = first;
      while (char_ends_[last] < at) ++last;
      tokens_.push_back({match.id, word[first].begin, word[last].end});
      first = last + 1;
    }
    return true;
  }

  const Vocabulary& vocabulary_;
  const std::int32_t unk_;
  const std::size_t max_chars_;
  std::string bytes_;                   // the word in UTF-8
  std::vector<std::size_t> char_ends_;  // where its characters end in bytes_
  std::vector<Token> tokens_;
};

}  // namespace

Result<WordPiece> WordPiece::Make(std::string vocabulary, const WordPieceOptions& options) {
  if (options.max_word_chars < 1)
    return Status(
        Code::kInvalidArgument,
        "max_word_chars is " + std::to_string(options.max_word_chars) + ", but must be at least 1");
  Result<Vocabulary> made = Vocabulary::Make(std::move(vocabulary));
  if (!made.ok()) return made.status();
  WordPiece words(*std::move(made), options);
  const std::pair<const char*, std::int32_t*> needed[] = {
      {"[UNK]", &words.unk_}, {"[CLS]", &words.cls_}, {"[SEP]", &words.sep_}};
  for (const auto& [token, id] : needed) {
    *id = words.vocabulary_.Find(token);
    if (*id < 0)
      return Status(Code::kBadInput, std::string("vocabulary: none of its ") +
                                         std::to_string(words.vocabulary_.size()) + " tokens is " +
                                         token + ", which BERT needs");
  }
  return words;
}

std::vector<Token> WordPiece::Tokenise(std::string_view text) const {
  const auto max_chars = static_cast<std::size_t>(options_.max_word_chars);
  PieceWriter writer(vocabulary_, unk_, max_chars);
  ForEachWord(text, {options_.lower_case, max_chars},
              [&writer](const std::vector<WordChar>& word) { writer.Write(word); });
  return writer.Finish();
}

Result<Sentence> WordPiece::Frame(std::string_view text, std::size_t max_tokens) const {
  if (max_tokens < 2)
    return Status(Code::kInvalidArgument, "a sentence of at most " + std::to_string(max_tokens) +
                                              " tokens has no room for [CLS] and [SEP]");
  Sentence sentence{Tokenise(text)};
  std::vector<Token>& tokens = sentence.tokens;
  if (tokens.size() > max_tokens - 2) {
    sentence.left_out = tokens.size() - (max_tokens - 2);
    tokens.resize(max_tokens - 2);
  }
  const std::size_t end = tokens.empty() ? 0 : tokens.back().end;
  tokens.insert(tokens.begin(), {cls_, 0, 0});
  tokens.push_back({sep_, end, end});
  return sentence;
}

}  // namespace gestus::models
