// Makes the inputs of the network in the weights named first, from the recording and the words
// named after them.
#include <cstdio>

#include "models/features/front_end.h"

int main(int argc, char** argv) {
  using namespace gestus;
  if (argc != 4) return 2;
  const auto fail = [](const Status& s) {
    return std::fprintf(stderr, "%s\n", s.message().c_str()), 1;
  };
  const auto file = WeightsFile::Open(argv[1]);
  if (!file.ok()) return fail(file.status());
  const auto front_end = features::FrontEnd::Make(*file, "", {});
  if (!front_end.ok()) return fail(front_end.status());
  features::Account account;
  const auto stream = (*front_end)->Open({.audio = argv[2], .transcript = argv[3]}, &account);
  if (!stream.ok()) return fail(stream.status());
  const auto inputs = (*stream)->Next((*stream)->total());
  if (!inputs.ok()) return fail(inputs.status());
  for (const auto& [name, array] : *inputs)
    std::printf("%s: %zu values\n", name.c_str(), array.f32.size());
  return inputs->count("speech") == 1 ? 0 : 1;
}
