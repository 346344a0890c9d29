// Archives of arrays, and bare arrays.
#include <cmath>

#include "models/cli/npz.h"
#include "tests/fuzz/fuzz.h"

namespace gestus::fuzz {
namespace {

constexpr std::uint64_t kMaxBytes = 1 << 24;

void Read(const std::string& path, const std::string& name, DType dtype) {
  const auto contents =
      cli::ReadNpz(path, {{.name = name, .dtype = dtype}}, {.max_bytes = kMaxBytes});
  if (!contents.ok()) return RequireSentence(contents.status(), path);
  const models::Array& array = contents->arrays.at(name);
  Require(array.dtype == dtype, "the type that was asked for");
  std::size_t elements = 1;
  for (const std::int64_t d : array.shape) elements *= static_cast<std::size_t>(d);
  Require(elements == array.f32.size() + array.i32.size(), "as many elements as the shape says");
  Require(elements * 4 <= kMaxBytes, "no more than allowed");
  for (const float v : array.f32) Require(std::isfinite(v), "finite numbers");
}

}  // namespace
}  // namespace gestus::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gestus;  // NOLINT: this is a test of that library
  static fuzz::MemoryFile file;
  const std::string path = file.Write(data, size);
  // A bare array answers to any name.
  std::vector<std::string> names = {"x"};
  if (const auto list = cli::ListNpz(path); list.ok()) {
    names.insert(names.end(), list->begin(), list->end());
  } else {
    fuzz::RequireSentence(list.status(), path);
  }
  if (names.size() > 12) names.resize(12);
  for (const std::string& name : names) {
    for (const DType dtype : {DType::kF32, DType::kI32}) fuzz::Read(path, name, dtype);
  }
  return 0;
}
