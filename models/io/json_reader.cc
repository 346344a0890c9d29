#include "models/io/json_reader.h"

#include <string>

namespace gestus {
namespace {

// Deeper nesting than any transcript or pose file has; it bounds what a small file can cost.
constexpr int kMaxDepth = 64;

// Where the parser stopped, kept without an exception.
class Position : public nlohmann::json_sax<Json> {
 public:
  std::string problem;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool key(string_t&) override { return true; }
  bool start_object(std::size_t) override { return Enter(); }
  bool start_array(std::size_t) override { return Enter(); }
  bool end_object() override { return Leave(); }
  bool end_array() override { return Leave(); }
  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception&) override {
    problem = "is not JSON at byte " + std::to_string(position);
    return false;
  }

 private:
  bool Enter() {
    if (++depth_ <= kMaxDepth) return true;
    problem = "nests more than " + std::to_string(kMaxDepth) + " levels deep";
    return false;
  }
  bool Leave() {
    --depth_;
    return true;
  }

  int depth_ = 0;
};

}  // namespace

Result<Json> ParseJson(std::string_view text) {
  Position position;
  if (!Json::sax_parse(text.begin(), text.end(), &position)) {
    return Status(Code::kBadInput, position.problem + ", expected a JSON document");
  }
  return Json::parse(text.begin(), text.end(), nullptr, /*allow_exceptions=*/false);
}

const Json* Member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

}  // namespace gestus
