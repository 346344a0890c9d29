#include "models/io/reading.h"

#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "models/io/file.h"
#include "models/io/text.h"

namespace gestus {

Result<std::string> ReadFile(const std::string& path, std::uint64_t max_bytes) {
  Result<InputFile> file = OpenInput(path);
  if (!file.ok()) return file.status().In(path);
  if (file->size > max_bytes) {
    return Status(Code::kBadInput,
                  path + ": has " + Bytes(file->size) + ", expected at most " + Bytes(max_bytes));
  }
  std::string content(static_cast<std::size_t>(file->size), '\0');
  std::size_t have = 0;
  while (have < content.size()) {
    const ssize_t n = ::read(file->fd.get(), content.data() + have, content.size() - have);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      return Status(Code::kIo, path + ": cannot be read (" + std::strerror(errno) + ")");
    }
    if (n == 0) break;  // it has become shorter
    have += static_cast<std::size_t>(n);
  }
  content.resize(have);
  return content;
}

std::string_view Trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

bool ParseNumber(std::string_view text, double* value) {
  text = Trim(text);
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  // from_chars also takes "inf" and "nan".
  if (text.empty() || text.find_first_not_of("0123456789.eE+-") != std::string_view::npos) {
    return false;
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(*value);
}

}  // namespace gestus
