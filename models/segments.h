// Cutting streams of any length into the windows that a fixed graph takes.
//
// Windows follow each other without overlap.  When the last one is not full it is moved back so
// that it ends with the stream: it then sees real frames only, and just its new frames are kept.  A
// stream shorter than one window is filled up by repeating its last row, and the surplus is
// dropped.
#ifndef GESTUS_MODELS_SEGMENTS_H_
#define GESTUS_MODELS_SEGMENTS_H_

#include <cstdint>
#include <string>
#include <vector>

namespace gestus::models {

struct Window {
  std::int64_t begin;  ///< first frame of the window in the stream
  std::int64_t keep;   ///< first row of the window whose result is kept
};

/// The windows of `length` frames that cover `total` frames; none when total is 0.
std::vector<Window> Windows(std::int64_t total, std::int64_t length);

/// Rows [begin, begin + length) of x (total, cols), the last row repeated past the end.
void CopyWindow(const float* x, std::int64_t total, std::int64_t cols, std::int64_t begin,
                std::int64_t length, float* to);

/// What Windows did to a last partial window, in words; empty when it was full.
std::string DescribeLastWindow(const std::string& stream, std::int64_t total, std::int64_t length);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_SEGMENTS_H_
