// The pieces that a WordPiece tokeniser may emit, and the search for the longest that fits.
#ifndef GESTUS_MODELS_TEXT_VOCABULARY_H_
#define GESTUS_MODELS_TEXT_VOCABULARY_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/status.h"

namespace gestus::models {

/// Immutable; any number of threads may read it.
class Vocabulary {
 public:
  /// More bytes than these are refused; the largest published vocabularies have about 5 MB.
  static constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

  struct Match {
    std::int32_t id = -1;   ///< -1 when no piece fits
    std::size_t bytes = 0;  ///< of the text, without "##"
  };

  /// One token a line, the first has id 0.  Lines end with LF or CR LF; the last end may be absent.
  static Result<Vocabulary> Make(std::string bytes);

  std::int32_t size() const { return static_cast<std::int32_t>(lines_.size()); }
  /// The token of an id in [0, size()).
  std::string_view token(std::int32_t id) const;
  /// -1 when there is none.
  std::int32_t Find(std::string_view token) const;
  /// The longest token that `text` starts with.
  Match LongestStart(std::string_view text) const { return Longest(all_, 0, text); }
  /// The longest token of the form "##x" where `text` starts with x.
  Match LongestContinuation(std::string_view text) const { return Longest(continuing_, 2, text); }

 private:
  struct Line {
    std::uint32_t begin, size;
  };
  // A range of sorted_.
  struct Range {
    std::size_t begin, end;
  };

  Vocabulary() = default;
  Status ReadLines();
  Status SortLines();
  Range Narrow(Range range, std::size_t depth, char byte) const;
  Match Longest(Range range, std::size_t depth, std::string_view text) const;

  std::string bytes_;
  std::vector<Line> lines_;           // by id
  std::vector<std::int32_t> sorted_;  // ids in the order of their tokens' bytes
  Range all_{}, continuing_{};
};

}  // namespace gestus::models

#endif  // GESTUS_MODELS_TEXT_VOCABULARY_H_
