// Cuts a sentence into the tokens of a vocabulary made here.
#include <cstdio>

#include "models/text/wordpiece.h"

int main() {
  using namespace gestus;
  const auto words = models::WordPiece::Make("[UNK]\n[CLS]\n[SEP]\ncafe\n##s");
  if (!words.ok()) return std::fprintf(stderr, "%s\n", words.status().message().c_str()), 1;
  const auto sentence = words->Frame("Caf\u00E9s", 512);
  if (!sentence.ok()) return std::fprintf(stderr, "%s\n", sentence.status().message().c_str()), 1;
  std::printf("%zu tokens\n", sentence->tokens.size());
  return sentence->tokens.size() == 4 ? 0 : 1;
}
