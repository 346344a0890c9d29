// Writes JSON, indented, members in the order of the calls.
//
//   JsonWriter json;
//   json.BeginObject().Key("frames").Value(64).Key("notes").BeginArray().EndArray().EndObject();
#ifndef GESTUS_MODELS_CLI_JSON_H_
#define GESTUS_MODELS_CLI_JSON_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gestus::cli {

class JsonWriter {
 public:
  JsonWriter& BeginObject() { return Open('{'); }
  JsonWriter& EndObject() { return Close('}'); }
  JsonWriter& BeginArray() { return Open('['); }
  JsonWriter& EndArray() { return Close(']'); }
  JsonWriter& Key(std::string_view key);

  JsonWriter& Value(std::string_view text);
  JsonWriter& Value(const char* text) { return Value(std::string_view(text)); }
  JsonWriter& Value(bool value) { return Raw(value ? "true" : "false"); }
  JsonWriter& Value(int value) { return Raw(std::to_string(value)); }
  JsonWriter& Value(std::int64_t value) { return Raw(std::to_string(value)); }
  JsonWriter& Value(std::uint64_t value) { return Raw(std::to_string(value)); }
  /// Null when not finite: JSON has no word for that.
  JsonWriter& Value(double value);

  template <class T>
  JsonWriter& Member(std::string_view key, const T& value) {
    return Key(key).Value(value);
  }
  template <class T>
  JsonWriter& Member(std::string_view key, const std::vector<T>& values) {
    Key(key).BeginArray();
    for (const T& value : values) Value(value);
    return EndArray();
  }

  const std::string& text() const { return text_; }

 private:
  JsonWriter& Open(char bracket);
  JsonWriter& Close(char bracket);
  JsonWriter& Raw(std::string_view token);
  void Separate();

  std::string text_;
  std::size_t depth_ = 0;
  bool first_ = true;  // in its object or array
  bool after_key_ = false;
};

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_JSON_H_
