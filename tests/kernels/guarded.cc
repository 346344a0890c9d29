// Guarded memory by mmap and mprotect: over-reads fault in every build type, not only under ASan.
#include "tests/kernels/guarded.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <random>
#include <utility>

namespace gestus::test {
namespace {

// A quiet NaN with a payload that no arithmetic produces.
constexpr std::uint32_t kPoison = 0x7fc0dead;

}  // namespace

GuardedFloats::GuardedFloats(std::size_t count, std::size_t alignment) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t bytes = (count * sizeof(float) + alignment - 1) / alignment * alignment;
  const std::size_t usable = (bytes + page - 1) / page * page;
  map_bytes_ = usable + page;
  map_ = mmap(nullptr, map_bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (map_ == MAP_FAILED) std::abort();
  char* end = static_cast<char*>(map_) + usable;
  if (mprotect(end, page, PROT_NONE) != 0) std::abort();
  data_ = reinterpret_cast<float*>(end - bytes);
  std::fill_n(data_, count, std::bit_cast<float>(kPoison));
}

GuardedFloats::~GuardedFloats() {
  if (map_ != nullptr) munmap(map_, map_bytes_);
}

GuardedFloats::GuardedFloats(GuardedFloats&& other) noexcept
    : map_(std::exchange(other.map_, nullptr)), map_bytes_(other.map_bytes_), data_(other.data_) {}

GuardedFloats& GuardedFloats::operator=(GuardedFloats&& other) noexcept {
  std::swap(map_, other.map_);
  std::swap(map_bytes_, other.map_bytes_);
  std::swap(data_, other.data_);
  return *this;
}

Matrix::Matrix(std::size_t rows, std::size_t cols, std::size_t gap)
    : rows_(rows),
      cols_(cols),
      pitch_(cols + gap),
      floats_(rows == 0 ? 0 : (rows - 1) * (cols + gap) + cols) {}

Matrix Matrix::Random(std::size_t rows, std::size_t cols, std::size_t gap, std::uint32_t seed,
                      float size) {
  Matrix m(rows, cols, gap);
  m.seed_ = seed;
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(-size, size);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < cols; ++j) m(i, j) = uniform(generator);
  }
  return m;
}

Matrix Matrix::Copy(std::size_t gap) const {
  Matrix m(rows_, cols_, gap);
  m.seed_ = seed_;
  for (std::size_t i = 0; i < rows_; ++i) {
    for (std::size_t j = 0; j < cols_; ++j) m(i, j) = (*this)(i, j);
  }
  return m;
}

void Matrix::Fill(float value) {
  for (std::size_t i = 0; i < rows_; ++i) std::fill_n(data() + i * pitch_, cols_, value);
}

std::ptrdiff_t Matrix::TouchedGap() const {
  for (std::size_t i = 0; i + 1 < rows_; ++i) {
    for (std::size_t j = cols_; j < pitch_; ++j) {
      if (std::bit_cast<std::uint32_t>((*this)(i, j)) != kPoison) {
        return static_cast<std::ptrdiff_t>(i * pitch_ + j);
      }
    }
  }
  return -1;
}

}  // namespace gestus::test
