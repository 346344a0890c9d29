// The tokeniser: a vocabulary up to the first zero byte, or a fixed one, and a text.
#include "models/text/wordpiece.h"
#include "tests/fuzz/fuzz.h"

namespace gestus::fuzz {
namespace {

void Tokenise(const models::WordPiece& words, std::string_view text) {
  std::size_t begin = 0, end = 0;
  for (const models::Token& token : words.Tokenise(text)) {
    Require(token.id >= 0 && token.id < words.vocabulary().size(), "tokens of the vocabulary");
    Require(token.begin >= begin && token.end >= end && token.begin <= token.end, "in order");
    Require(token.end <= text.size(), "within the text");
    begin = token.begin;
    end = token.end;
  }
  const auto sentence = words.Frame(text, 8);
  Require(sentence.ok(), "every text can be framed");
  Require(sentence->tokens.size() >= 2 && sentence->tokens.size() <= 8, "framed as asked for");
  Require(sentence->tokens.front().id == words.cls() && sentence->tokens.back().id == words.sep(),
          "between its marks");
}

}  // namespace
}  // namespace gestus::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gestus;  // NOLINT: this is a test of that library
  static const models::WordPiece fixed = *models::WordPiece::Make(
      "[PAD]\n[UNK]\n[CLS]\n[SEP]\n.\n,\na\nb\ne\ns\nthe\ncafe\n##a\n##b\n##e\n##s\n##ing\n"
      "\u03C3\n\u03C2\n##\u03C3\n##\u03C2\n\u4E2D\ni\n##i\n\u1100\n##\u1161\n##\u11A8");
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const bool lower_case : {true, false}) {
    const std::size_t end = bytes.find('\0');
    const auto made =
        models::WordPiece::Make(std::string(bytes.substr(0, end)), {.lower_case = lower_case});
    if (!made.ok()) fuzz::Require(!made.status().message().empty(), "errors have a sentence");
    if (made.ok() && end < size) fuzz::Tokenise(*made, bytes.substr(end + 1));
  }
  fuzz::Tokenise(fixed, bytes);
  return 0;
}
