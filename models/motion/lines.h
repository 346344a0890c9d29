// The lines of a text file, one at a time, so that memory does not grow with the file.  A private
// header of the readers.
#ifndef GESTUS_MODELS_MOTION_LINES_H_
#define GESTUS_MODELS_MOTION_LINES_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/status.h"
#include "models/io/file.h"

namespace gestus::motion {

/// Longest line that is read: OpenFace writes some 7 kB.
constexpr std::size_t kMaxLine = 1 << 18;

class LineReader {
 public:
  /// The path is left for the caller to name, here and in Next().
  static Result<LineReader> Open(const std::string& path);

  /// The next line without its end (LF or CR LF), valid until the next call; false at the end.
  Result<bool> Next(std::string_view* line);
  /// Of the line read last, from 1.
  std::int64_t number() const { return number_; }

 private:
  Status Fill();

  InputFile file_;
  std::string buffer_;
  std::size_t begin_ = 0;  // of what has not been handed out
  bool at_end_ = false;
  std::int64_t number_ = 0;
};

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_LINES_H_
