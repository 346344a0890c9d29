#include "models/motion/lines.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "models/io/text.h"

namespace gestus::motion {

Result<LineReader> LineReader::Open(const std::string& path) {
  Result<InputFile> file = OpenInput(path);
  if (!file.ok()) return file.status();
  LineReader reader;
  reader.file_ = *std::move(file);
  return reader;
}

// Drops what has been handed out and reads more.
Status LineReader::Fill() {
  constexpr std::size_t kBlock = 1 << 16;
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t have = buffer_.size();
  buffer_.resize(have + kBlock);
  ssize_t n = 0;
  do {
    n = ::read(file_.fd.get(), buffer_.data() + have, kBlock);
  } while (n < 0 && errno == EINTR);
  if (n < 0) {
    return Status(Code::kIo, std::string("cannot be read (") + std::strerror(errno) + ")");
  }
  buffer_.resize(have + static_cast<std::size_t>(n));
  at_end_ = n == 0;
  return Status();
}

Result<bool> LineReader::Next(std::string_view* line) {
  ++number_;
  std::size_t searched = begin_;
  std::size_t end = buffer_.find('\n', searched);
  while (end == std::string::npos && !at_end_) {
    searched = buffer_.size() - begin_;
    if (searched > kMaxLine) {
      return Status(Code::kBadInput, "line " + std::to_string(number_) + ": has more than " +
                                         Bytes(kMaxLine) + ", expected a line of numbers");
    }
    GESTUS_RETURN_IF_ERROR(Fill());
    end = buffer_.find('\n', searched);
  }
  if (end == std::string::npos && begin_ == buffer_.size()) return false;
  const bool ends_with_file = end == std::string::npos;
  if (ends_with_file) end = buffer_.size();
  *line = std::string_view(buffer_).substr(begin_, end - begin_);
  if (line->ends_with('\r')) line->remove_suffix(1);
  begin_ = ends_with_file ? end : end + 1;
  return true;
}

}  // namespace gestus::motion
