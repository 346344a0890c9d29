// Text and bytes as they may stand in HTML, SVG and JSON.  A private header of models/player.
#ifndef GESTUS_MODELS_PLAYER_TEXT_H_
#define GESTUS_MODELS_PLAYER_TEXT_H_

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gestus::player {

/// `text` in the content or a quoted attribute of HTML or XML.  What is not UTF-8 and what XML
/// knows no character for becomes U+FFFD.
std::string Escaped(std::string_view text);

std::string Base64(std::string_view bytes);

/// Compact JSON that may stand in a <script> element: it holds none of < > &.
class ScriptJson {
 public:
  ScriptJson& BeginObject() { return Open('{'); }
  ScriptJson& EndObject() { return Close('}'); }
  ScriptJson& BeginArray() { return Open('['); }
  ScriptJson& EndArray() { return Close(']'); }
  ScriptJson& Key(std::string_view key);

  ScriptJson& Text(std::string_view text);
  ScriptJson& Flag(bool value) { return Token(value ? "true" : "false"); }
  /// With at most six digits behind the point; 0 when not finite.
  ScriptJson& Number(double value);
  /// The shortest text that reads back as `value`; 0 when not finite.
  ScriptJson& Exact(double value);
  ScriptJson& Integer(std::int64_t value) { return Token(std::to_string(value)); }
  /// As base64 of little-endian numbers.
  ScriptJson& Packed(std::span<const std::uint8_t> values);
  ScriptJson& Packed(std::span<const std::int16_t> values);

  const std::string& text() const { return text_; }

 private:
  ScriptJson& Open(char bracket);
  ScriptJson& Close(char bracket);
  ScriptJson& Token(std::string_view token);

  std::string text_;
  bool comma_ = false;  // before the next token
};

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_TEXT_H_
