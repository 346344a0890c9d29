// Windows over streams.
#include "models/segments.h"

#include <algorithm>
#include <cstring>

namespace gestus::models {

std::vector<Window> Windows(std::int64_t total, std::int64_t length) {
  std::vector<Window> windows;
  for (std::int64_t begin = 0; begin < total; begin += length) {
    const std::int64_t moved = std::max<std::int64_t>(0, std::min(begin, total - length));
    windows.push_back({moved, begin - moved});
  }
  return windows;
}

void CopyWindow(const float* x, std::int64_t total, std::int64_t cols, std::int64_t begin,
                std::int64_t length, float* to) {
  for (std::int64_t row = 0; row < length; ++row) {
    const std::int64_t from = std::min(begin + row, total - 1);
    std::memcpy(to + row * cols, x + from * cols, static_cast<std::size_t>(cols) * sizeof(float));
  }
}

std::string DescribeLastWindow(const std::string& stream, std::int64_t total, std::int64_t length) {
  const std::int64_t rest = total % length;
  if (rest == 0) return {};
  if (total < length)
    return stream + ": " + std::to_string(total) + " frames are fewer than the " +
           std::to_string(length) + " of a segment; the last one was repeated";
  return stream + ": the last " + std::to_string(rest) +
         " frames do not fill a segment; its window was moved back by " +
         std::to_string(length - rest) + " frames";
}

}  // namespace gestus::models
