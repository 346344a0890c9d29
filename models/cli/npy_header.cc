// The header of a .npy file is a Python dictionary literal.  This is a parser of exactly the
// literals that such a header may hold; a search for "'shape':" would misread keys in another
// order, other white space and nested tuples.
#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "models/cli/npy.h"

namespace gestus::cli {
namespace {

constexpr std::size_t kMaxRank = 32;  // numpy's own limit

// A cursor over the literal.  Every method takes what it names or leaves the cursor in place.
class Scanner {
 public:
  Scanner(std::string_view text, bool allow_long) : text_(text), allow_long_(allow_long) {}

  void SkipSpace() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != text_.npos) ++at_;
  }
  bool AtEnd() {
    SkipSpace();
    return at_ == text_.size();
  }
  bool Take(char c) {
    SkipSpace();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  bool TakeWord(std::string_view word) {
    SkipSpace();
    if (text_.substr(at_, word.size()) != word) return false;
    const std::size_t end = at_ + word.size();
    if (end < text_.size() && IsWordCharacter(text_[end])) return false;
    at_ = end;
    return true;
  }
  /// A quoted string without escapes.
  std::optional<std::string_view> TakeString() {
    SkipSpace();
    if (at_ == text_.size() || (text_[at_] != '\'' && text_[at_] != '"')) return std::nullopt;
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    if (end == text_.npos) return std::nullopt;
    const std::string_view body = text_.substr(at_ + 1, end - at_ - 1);
    if (body.find_first_of("\\\n\r") != body.npos) return std::nullopt;
    at_ = end + 1;
    return body;
  }
  /// A decimal number without sign or leading zeros; "10L" where Python 2 may have written it.
  std::optional<std::int64_t> TakeNumber() {
    SkipSpace();
    std::size_t end = at_;
    std::int64_t value = 0;
    for (; end < text_.size() && text_[end] >= '0' && text_[end] <= '9'; ++end) {
      if (value > (std::numeric_limits<std::int64_t>::max() - 9) / 10) return std::nullopt;
      value = value * 10 + (text_[end] - '0');
    }
    if (end == at_ || (text_[at_] == '0' && end - at_ > 1)) return std::nullopt;
    if (allow_long_ && end < text_.size() && text_[end] == 'L') ++end;
    if (end < text_.size() && IsWordCharacter(text_[end])) return std::nullopt;
    at_ = end;
    return value;
  }
  std::size_t position() const { return at_; }

 private:
  static bool IsWordCharacter(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '.';
  }

  std::string_view text_;
  bool allow_long_;
  std::size_t at_ = 0;
};

// Why a dtype that numpy knows cannot be read; empty when it is simply unknown.
std::string WhyNot(std::string_view code) {
  switch (code.empty() ? '\0' : code[0]) {
    case 'O':
      return " (Python objects)";
    case 'S':
    case 'a':
    case 'U':
      return " (strings)";
    case 'c':
      return " (complex numbers)";
    case 'V':
      return " (raw bytes)";
    case 'M':
    case 'm':
      return " (dates)";
    default:
      return "";
  }
}

// "<f4": byte order, kind, bytes of one element.
Status ParseDescr(std::string_view descr, NpyHeader* header) {
  std::string_view code = descr;
  char order = '=';
  if (!code.empty() && std::string_view("<>|=").find(code[0]) != code.npos) {
    order = code[0];
    code.remove_prefix(1);
  }
  static constexpr std::string_view kCodes[] = {"f2", "f4", "f8", "i1", "i2", "i4",
                                                "i8", "u1", "u2", "u4", "u8", "b1"};
  const bool known = std::find(std::begin(kCodes), std::end(kCodes), code) != std::end(kCodes);
  const auto item_size = known ? static_cast<std::size_t>(code[1] - '0') : 0;
  if (!known || (order == '|' && item_size > 1)) {
    return BadInput("dtype '" + std::string(descr.substr(0, 40)) + "'" + WhyNot(code) +
                    ", expected float16 to 64, int8 to 64, uint8 to 64 or bool");
  }
  header->kind = static_cast<NpyKind>(code[0]);
  header->item_size = item_size;
  header->big_endian = order == '>' || (order == '=' && std::endian::native == std::endian::big);
  return Status();
}

// "(3, 4)", "(3,)" or "()"; a single number needs its comma, as in Python.
Status ParseShape(Scanner* scanner, NpyHeader* header) {
  const Status bad =
      BadInput("header: malformed 'shape' at byte " + std::to_string(scanner->position()) +
               ", expected a tuple of whole numbers such as (64, 768) or (64,)");
  if (!scanner->Take('(')) return bad;
  bool comma = true;
  while (!scanner->Take(')')) {
    const std::optional<std::int64_t> dim = scanner->TakeNumber();
    if (!comma || !dim) return bad;
    header->shape.push_back(*dim);
    comma = scanner->Take(',');
  }
  if (header->shape.size() == 1 && !comma) return bad;
  if (header->shape.size() > kMaxRank) {
    return BadInput("header: " + std::to_string(header->shape.size()) +
                    " dimensions, expected at most " + std::to_string(kMaxRank));
  }
  return Status();
}

// Counts the elements.  Dimensions of 0 take no part in the overflow check, as in numpy, which
// refuses (0, 2^62, 2^62) too.
Status CountElements(NpyHeader* header) {
  auto left = std::numeric_limits<std::uint64_t>::max() / 2 / header->item_size;
  header->elements = 1;
  bool empty = false;
  for (const std::int64_t dim : header->shape) {
    const auto size = static_cast<std::uint64_t>(dim);
    empty |= size == 0;
    if (size == 0) continue;
    if (size > left) {
      return BadInput("shape " + ShapeText(header->shape) + ", expected less than 2^63 bytes");
    }
    left /= size;
    header->elements *= size;
  }
  if (empty) header->elements = 0;
  return Status();
}

Status ParseEntry(Scanner* scanner, NpyHeader* header, unsigned* seen) {
  const std::optional<std::string_view> key = scanner->TakeString();
  if (!key || !scanner->Take(':')) {
    return BadInput("header: malformed at byte " + std::to_string(scanner->position()) +
                    ", expected 'key': value");
  }
  const unsigned bit = *key == "descr"           ? 1U
                       : *key == "fortran_order" ? 2U
                       : *key == "shape"         ? 4U
                                                 : 0U;
  if (bit == 0 || (*seen & bit) != 0) {
    return BadInput("header: key '" + std::string(key->substr(0, 40)) + "' " +
                    (bit == 0 ? "is unknown" : "comes twice") +
                    ", expected descr, fortran_order and shape, once each");
  }
  *seen |= bit;
  if (bit == 1U) {
    const std::optional<std::string_view> descr = scanner->TakeString();
    if (!descr) return BadInput("dtype is not a string (structured?), expected plain numbers");
    return ParseDescr(*descr, header);
  }
  if (bit == 4U) return ParseShape(scanner, header);
  header->fortran_order = scanner->TakeWord("True");
  if (!header->fortran_order && !scanner->TakeWord("False")) {
    return BadInput("header: malformed 'fortran_order', expected True or False");
  }
  return Status();
}

}  // namespace

Result<NpyHeader> ParseNpyDict(std::string_view text, int version) {
  Scanner scanner(text, /*allow_long=*/version < 3);
  NpyHeader header;
  unsigned seen = 0;
  if (!scanner.Take('{')) return BadInput("header: no '{', expected a Python dictionary");
  bool comma = true;
  while (!scanner.Take('}')) {
    if (!comma) {
      return BadInput("header: malformed at byte " + std::to_string(scanner.position()) +
                      ", expected ',' or '}'");
    }
    GESTUS_RETURN_IF_ERROR(ParseEntry(&scanner, &header, &seen));
    comma = scanner.Take(',');
  }
  if (!scanner.AtEnd()) return BadInput("header: text after '}', expected only spaces");
  if (seen != 7U) return BadInput("header: lacks a key, expected descr, fortran_order and shape");
  GESTUS_RETURN_IF_ERROR(CountElements(&header));
  return header;
}

std::string NpyHeader::TypeName() const {
  if (kind == NpyKind::kBool) return "bool";
  const char* name = kind == NpyKind::kFloat ? "float" : kind == NpyKind::kInt ? "int" : "uint";
  return name + std::to_string(item_size * 8);
}

std::string ShapeText(const std::vector<std::int64_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::string NpyHeaderText(DType dtype, const std::vector<std::int64_t>& shape) {
  std::string dict = "{'descr': '";
  dict += dtype == DType::kF32 ? "<f4" : "<i4";
  dict += "', 'fortran_order': False, 'shape': " + ShapeText(shape) + ", }";
  constexpr std::size_t kPrefix = 10;  // magic, version, length
  const std::size_t padded = (kPrefix + dict.size() + 1 + 63) / 64 * 64;
  dict.append(padded - kPrefix - dict.size() - 1, ' ').push_back('\n');
  std::string header("\x93NUMPY\x01\x00", 8);
  header.push_back(static_cast<char>(dict.size() & 0xff));
  header.push_back(static_cast<char>(dict.size() >> 8));
  return header + dict;
}

}  // namespace gestus::cli
