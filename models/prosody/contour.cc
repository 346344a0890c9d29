#include "models/prosody/contour.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "models/io/text.h"
#include "models/prosody/range.h"

namespace gestus::prosody {
namespace {

// A word's values, by the number of their row in the recording.
struct WordRows {
  float* hz;
  std::size_t first;
  float& operator[](std::size_t row) const { return hz[row - first]; }
};

// f0 and, for every row, where the next voiced one is, so that a word costs no more than the values
// it gets, however long it is and however many overlap.
class Contour {
 public:
  Contour(const float* f0, std::size_t rows, std::size_t stride, const ContourOptions& options)
      : f0_(f0), rows_(rows), stride_(stride), options_(options), next_voiced_(rows + 1, rows) {
    for (std::size_t j = rows; j-- > 0;) {
      const float hz = At(j);
      next_voiced_[j] = hz > 0 && std::isfinite(hz) ? j : next_voiced_[j + 1];
    }
  }

  // The first row at `seconds` or later.
  std::size_t RowAt(double seconds) const {
    // Times are decimals: 0.29 s is row 29 of 0.01 s, though 0.29 / 0.01 is a little more.
    const double row = std::ceil(seconds / options_.hop_seconds - 1e-6);
    return row < static_cast<double>(rows_) ? static_cast<std::size_t>(row) : rows_;
  }

  // Rows [first, first + count) of a word that goes on to `last`; false when no row of it is
  // voiced.
  bool Fill(std::size_t first, std::size_t count, std::size_t last, float* out) const {
    const WordRows hz{out, first};
    std::size_t voiced = next_voiced_[first];
    if (voiced >= last) return false;
    std::size_t before = voiced;  // the voiced row before, or this one again
    std::size_t after = NextWithin(voiced, last);
    const std::size_t end = first + count;
    Extend(voiced, after, first, std::min(voiced, end), hz);
    while (voiced < end) {
      hz[voiced] = At(voiced);
      if (after == voiced) break;
      Line(voiced, after, voiced + 1, std::min(after, end), hz);
      before = voiced;
      voiced = after;
      after = NextWithin(voiced, last);
    }
    if (voiced < end) Extend(voiced, before, voiced + 1, end, hz);
    return true;
  }

 private:
  float At(std::size_t row) const { return f0_[row * stride_]; }

  // The next voiced row of the word, or `row` when there is none.
  std::size_t NextWithin(std::size_t row, std::size_t last) const {
    const std::size_t next = next_voiced_[row + 1];
    return next < last ? next : row;
  }

  // The line through rows a and b, on rows [begin, end) of `hz`.
  void Line(std::size_t a, std::size_t b, std::size_t begin, std::size_t end, WordRows hz) const {
    const double from = static_cast<double>(a), start = double{At(a)};
    const double slope = (double{At(b)} - start) / (static_cast<double>(b) - from);
    for (std::size_t j = begin; j < end; ++j)
      hz[j] = static_cast<float>(start + slope * (static_cast<double>(j) - from));
  }

  // Beyond the outermost voiced row; `inner` is the one next to it, or itself.
  void Extend(std::size_t outer, std::size_t inner, std::size_t begin, std::size_t end,
              WordRows hz) const {
    if (begin >= end) return;
    if (options_.ends == ContourEnds::kNearest || inner == outer) {
      for (std::size_t j = begin; j < end; ++j) hz[j] = At(outer);
      return;
    }
    Line(outer, inner, begin, end, hz);
    for (std::size_t j = begin; j < end; ++j)
      hz[j] = std::clamp(hz[j], static_cast<float>(options_.min_hz),
                         static_cast<float>(options_.max_hz));
  }

  const float* f0_;
  const std::size_t rows_, stride_;
  const ContourOptions options_;
  std::vector<std::size_t> next_voiced_;
};

Status Check(const std::vector<WordSpan>& words, const ContourOptions& o) {
  if (!(o.hop_seconds > 0 && std::isfinite(o.hop_seconds)))
    return OutOfRange("hop_seconds", o.hop_seconds, "more than 0");
  if (o.values < 1 || o.values > 1 << 16)
    return OutOfRange("values", static_cast<double>(o.values), "1 to 65,536");
  if (!(o.min_hz > 0 && std::isfinite(o.min_hz)))
    return OutOfRange("min_hz", o.min_hz, "more than 0");
  if (!(o.max_hz > o.min_hz && std::isfinite(o.max_hz)))
    return OutOfRange("max_hz", o.max_hz, "more than min_hz, " + Plain(o.min_hz));
  for (std::size_t w = 0; w < words.size(); ++w) {
    const auto [start, end] = words[w];
    if (!(start >= 0 && start <= end && std::isfinite(end)))
      return Status(Code::kBadInput, "word " + std::to_string(w + 1) + ": from " + Plain(start) +
                                         " to " + Plain(end) + " s, expected 0 <= start <= end");
  }
  return Status();
}

}  // namespace

Result<WordContours> ContoursOfWords(const float* f0, std::size_t rows, std::size_t stride,
                                     const std::vector<WordSpan>& words,
                                     const ContourOptions& options) {
  GESTUS_RETURN_IF_ERROR(Check(words, options));
  const Contour contour(f0, rows, stride, options);
  WordContours out;
  out.hz.resize(words.size() * options.values);
  out.count.resize(words.size());
  std::size_t cut = 0, unvoiced = 0, outside = 0;
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::size_t first = contour.RowAt(words[w].start), last = contour.RowAt(words[w].end);
    out.count[w] = std::min(last - first, options.values);
    cut += last - first > options.values;
    outside += first == rows && words[w].end > words[w].start;
    if (first < last)
      unvoiced += !contour.Fill(first, out.count[w], last, out.hz.data() + w * options.values);
  }
  const std::string all = " of " + Count(words.size(), "word");
  if (cut > 0)
    out.notes.push_back(std::to_string(cut) + all + " last longer than " +
                        std::to_string(options.values) + " f0 values and were cut");
  if (unvoiced > 0)
    out.notes.push_back(std::to_string(unvoiced) + all + " have no voiced frame; their f0 is 0");
  if (outside > 0)
    out.notes.push_back(std::to_string(outside) + all + " begin behind the end of the recording");
  return out;
}

}  // namespace gestus::prosody
