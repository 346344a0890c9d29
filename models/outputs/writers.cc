// Numbers, names and files of all formats.  std::to_chars is used throughout: printf would follow
// the locale.
#include "models/outputs/writers.h"

#include <array>
#include <charconv>

namespace gestus::outputs {
namespace {

constexpr std::size_t kBuffer = 1 << 16;

}  // namespace

void AppendFixed(std::string* text, double value, int digits) {
  std::array<char, 400> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::fixed, digits);
  std::string_view number(buffer.data(), static_cast<std::size_t>(result.ptr - buffer.data()));
  if (number.find_first_not_of("-0.") == std::string_view::npos && number.front() == '-')
    number.remove_prefix(1);
  text->append(number);
}

void AppendExact(std::string* text, float value) {
  std::array<char, 64> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  text->append(buffer.data(), result.ptr);
}

std::string Exact(double value) {
  std::array<char, 64> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), result.ptr);
}

std::string ClipName(const std::string& path, const FormatOptions& options) {
  std::string name = options.name;
  if (name.empty()) {
    std::string trimmed = path;
    while (trimmed.size() > 1 && trimmed.back() == '/') trimmed.pop_back();
    name = trimmed.substr(trimmed.rfind('/') + 1);
    const std::size_t point = name.rfind('.');
    if (point != std::string::npos && point > 0) name.resize(point);
  }
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ' || c == '\x7f' || c == '/') c = '_';
  }
  return name.empty() ? "motion" : name;
}

Result<TextFile> TextFile::Create(const std::string& path) {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file.ok()) return file.status();
  return TextFile(*std::move(file));
}

Status TextFile::Add(std::string_view text) {
  buffer_ += text;
  return buffer_.size() < kBuffer ? Status() : Flush();
}

Status TextFile::Flush() {
  GESTUS_RETURN_IF_ERROR(file_.Write(buffer_.data(), buffer_.size()));
  buffer_.clear();
  return Status();
}

Status TextFile::Commit() {
  GESTUS_RETURN_IF_ERROR(Flush());
  return file_.Commit();
}

}  // namespace gestus::outputs
