// Commas, indentation and escapes of JSON; numbers go through std::to_chars, which knows no locale.
#include "models/cli/json.h"

#include <array>
#include <charconv>
#include <cmath>

#include "models/io/text.h"

namespace gestus::cli {
namespace {

// Bytes that are not UTF-8 arrive as "\xff", the way messages show them.
std::string Quote(std::string_view text) {
  std::string out = "\"";
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    for (const char c : OneLine(text.substr(begin, end - begin), std::string::npos)) {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
    if (end < text.size()) out += "\\n";
    begin = end + 1;
  }
  return out + "\"";
}

}  // namespace

void JsonWriter::Separate() {
  if (!after_key_ && depth_ > 0) {
    text_ += (first_ ? "\n" : ",\n") + std::string(2 * depth_, ' ');
  }
  after_key_ = false;
  first_ = false;
}

JsonWriter& JsonWriter::Raw(std::string_view token) {
  Separate();
  text_ += token;
  return *this;
}

JsonWriter& JsonWriter::Open(char bracket) {
  Separate();
  text_ += bracket;
  ++depth_;
  first_ = true;
  return *this;
}

JsonWriter& JsonWriter::Close(char bracket) {
  --depth_;
  if (!first_) text_ += "\n" + std::string(2 * depth_, ' ');
  text_ += bracket;
  first_ = false;
  if (depth_ == 0) text_ += '\n';
  return *this;
}

JsonWriter& JsonWriter::Key(std::string_view key) {
  Raw(Quote(key) + ": ");
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::Value(std::string_view text) { return Raw(Quote(text)); }

JsonWriter& JsonWriter::Value(double value) {
  if (!std::isfinite(value)) return Raw("null");
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return Raw(std::string_view(buffer.data(), static_cast<std::size_t>(end - buffer.data())));
}

}  // namespace gestus::cli
