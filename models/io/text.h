// Text for people: numbers with sensible digits, tables, and messages that stay on one line
// whatever a file put into them.  No function depends on the locale.
#ifndef GESTUS_MODELS_IO_TEXT_H_
#define GESTUS_MODELS_IO_TEXT_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gestus {

/// `text` with control characters and bytes that are not UTF-8 escaped ("\x1b"), shortened in the
/// middle to at most `max_bytes`.
std::string OneLine(std::string_view text, std::size_t max_bytes = 300);

/// `value` with `digits` after the point.
std::string Fixed(double value, int digits);
/// `value` with `digits` significant digits, without an exponent where that stays readable.
std::string Significant(double value, int digits);
/// "87.3 MB"
std::string Bytes(std::uint64_t bytes);
/// "87,303,168"
std::string Grouped(std::uint64_t value);
/// "1.25 ms"
std::string Seconds(double seconds);
/// "1 frame", "2 frames"
std::string Count(std::uint64_t n, const std::string& noun);

/// Lines of a table: columns as wide as their widest cell and two spaces apart; those in
/// `right_aligned` (indices of columns) end at a common edge.
std::string Table(const std::vector<std::vector<std::string>>& rows,
                  const std::vector<std::size_t>& right_aligned = {},
                  const std::string& indent = "  ");

}  // namespace gestus

#endif  // GESTUS_MODELS_IO_TEXT_H_
