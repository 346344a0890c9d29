// Lines of a vocabulary, sorted so that one walk over a text finds the longest token it starts
// with.
#include "models/text/vocabulary.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "models/text/unicode.h"

namespace gestus::models {
namespace {

Status Bad(const std::string& what) { return {Code::kBadInput, "vocabulary: " + what}; }

std::string LineName(std::int32_t id) { return "line " + std::to_string(id + 1); }

}  // namespace

Result<Vocabulary> Vocabulary::Make(std::string bytes) {
  if (bytes.size() > kMaxBytes)
    return Bad(std::to_string(bytes.size()) + " bytes are more than the " +
               std::to_string(kMaxBytes) + " allowed");
  Vocabulary vocabulary;
  vocabulary.bytes_ = std::move(bytes);
  GESTUS_RETURN_IF_ERROR(vocabulary.ReadLines());
  GESTUS_RETURN_IF_ERROR(vocabulary.SortLines());
  return vocabulary;
}

Status Vocabulary::ReadLines() {
  const std::string_view all = bytes_;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t newline = std::min(all.find('\n', begin), all.size());
    std::string_view line = all.substr(begin, newline - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) return Bad(LineName(size()) + " is empty, but each must hold a token");
    if (!IsUtf8(line)) return Bad(LineName(size()) + " is not UTF-8");
    lines_.push_back({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(line.size())});
    begin = newline + 1;
  }
  return {};
}

Status Vocabulary::SortLines() {
  sorted_.resize(lines_.size());
  std::iota(sorted_.begin(), sorted_.end(), 0);
  std::sort(sorted_.begin(), sorted_.end(), [this](std::int32_t a, std::int32_t b) {
    const int order = token(a).compare(token(b));
    return order != 0 ? order < 0 : a < b;
  });
  const auto twin =
      std::adjacent_find(sorted_.begin(), sorted_.end(),
                         [this](std::int32_t a, std::int32_t b) { return token(a) == token(b); });
  if (twin != sorted_.end())
    return Bad(LineName(twin[1]) + " repeats the token of " + LineName(twin[0]) +
               ", but each must be there once");
  all_ = {0, sorted_.size()};
  continuing_ = Narrow(Narrow(all_, 0, '#'), 1, '#');
  return {};
}

std::string_view Vocabulary::token(std::int32_t id) const {
  const Line& line = lines_[static_cast<std::size_t>(id)];
  return std::string_view(bytes_).substr(line.begin, line.size);
}

std::int32_t Vocabulary::Find(std::string_view wanted) const {
  const auto found =
      std::lower_bound(sorted_.begin(), sorted_.end(), wanted,
                       [this](std::int32_t id, std::string_view w) { return token(id) < w; });
  return found != sorted_.end() && token(*found) == wanted ? *found : -1;
}

// Those tokens of `range` whose byte at `depth` is `byte`; all of the range share the bytes before.
Vocabulary::Range Vocabulary::Narrow(Range range, std::size_t depth, char byte) const {
  const auto wanted = static_cast<unsigned char>(byte);
  const auto at_depth = [this, depth](std::int32_t id) {
    const std::string_view t = token(id);
    return t.size() > depth ? static_cast<unsigned char>(t[depth]) : -1;
  };
  const auto begin = sorted_.begin() + static_cast<std::ptrdiff_t>(range.begin);
  const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(range.end);
  const auto low =
      std::partition_point(begin, end, [&](std::int32_t id) { return at_depth(id) < wanted; });
  const auto high =
      std::partition_point(low, end, [&](std::int32_t id) { return at_depth(id) == wanted; });
  return {static_cast<std::size_t>(low - sorted_.begin()),
          static_cast<std::size_t>(high - sorted_.begin())};
}

// A token that ends at this depth is the first of its range.  The text and the tokens are UTF-8, so
// no match ends inside a character.
Vocabulary::Match Vocabulary::Longest(Range range, std::size_t depth, std::string_view text) const {
  Match best;
  for (std::size_t i = 0; i < text.size(); ++i) {
    range = Narrow(range, depth + i, text[i]);
    if (range.begin == range.end) break;
    const std::int32_t first = sorted_[range.begin];
    if (token(first).size() == depth + i + 1) best = {first, i + 1};
  }
  return best;
}

}  // namespace gestus::models
