// What the fuzz targets share: a broken promise that libFuzzer sees, and files in memory for
// readers that take paths.
#ifndef GESTUS_TESTS_FUZZ_FUZZ_H_
#define GESTUS_TESTS_FUZZ_FUZZ_H_

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "engine/status.h"

namespace gestus::fuzz {

/// Ends the program, which libFuzzer reports with the input that did it, unless `holds`.
inline void Require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

/// An error is one sentence of sensible length, and begins with the name of the file.
inline void RequireSentence(const Status& status, std::string_view file) {
  const std::string& text = status.message();
  Require(text.starts_with(std::string(file) + ": "), text.c_str());
  Require(text.size() > file.size() + 10 && text.size() < file.size() + 1000, text.c_str());
}

/// A file without a name in a folder, whose content is replaced with each input.
class MemoryFile {
 public:
  MemoryFile() : fd_(memfd_create("gestus", 0)) { Require(fd_ >= 0, "memfd_create works"); }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// The path of a file with this content.
  std::string Write(const std::uint8_t* data, std::size_t size) {
    Require(ftruncate(fd_, 0) == 0, "ftruncate works");
    Require(pwrite(fd_, data, size, 0) == static_cast<ssize_t>(size), "pwrite works");
    return "/proc/self/fd/" + std::to_string(fd_);
  }

 private:
  int fd_;
};

}  // namespace gestus::fuzz

/// What libFuzzer calls with each input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

#endif  // GESTUS_TESTS_FUZZ_FUZZ_H_
