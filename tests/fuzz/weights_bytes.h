// Weights files whose metadata libFuzzer changes, and which are opened all the same.
#ifndef GESTUS_TESTS_FUZZ_WEIGHTS_BYTES_H_
#define GESTUS_TESTS_FUZZ_WEIGHTS_BYTES_H_

#include "tests/engine/weights_builder.h"

namespace gestus::fuzz {

/// Sizes and checksum in the header as the file's length and content ask for: they would stop every
/// input otherwise.
void MendHeader(test::Bytes* bytes);

}  // namespace gestus::fuzz

#endif  // GESTUS_TESTS_FUZZ_WEIGHTS_BYTES_H_
