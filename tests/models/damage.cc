// One flipped bit a file.
#include "tests/models/damage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/weights_file.h"

namespace gestus::test {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSlow = true;
#else
constexpr bool kSlow = false;
#endif

void ExpectSound(const models::Arrays& outputs, std::size_t bit) {
  for (const auto& [name, array] : outputs) {
    for (const float v : array.f32) ASSERT_TRUE(std::isfinite(v)) << name << ", bit " << bit;
    for (const std::int32_t v : array.i32) ASSERT_GE(v, 0) << name << ", bit " << bit;
  }
}

}  // namespace

void FlipMetadata(const Bytes& good, const models::Arrays& inputs, std::size_t step,
                  Damage* damage) {
  const auto bits = static_cast<std::size_t>(Get<std::uint64_t>(good, kMetadataSizeAt)) * 8;
  if (kSlow) step = 8 * step + 1;
  for (std::size_t bit = 0; bit < bits; bit += step) {
    Bytes bytes = good;
    std::uint8_t& byte = bytes[kMetadataAt + bit / 8];
    byte = static_cast<std::uint8_t>(byte ^ (1u << bit % 8));
    RefreshChecksum(&bytes);
    const auto file = WeightsFile::FromMemory(bytes.data(), bytes.size(), "flipped");
    if (!file.ok()) {
      ++damage->refused;
      continue;
    }
    const auto network = models::MakeNetwork(*file, "", {.max_arena_bytes = 1 << 24});
    if (!network.ok()) {
      ASSERT_FALSE(network.status().message().empty()) << "bit " << bit;
      ++damage->refused;
      continue;
    }
    const auto outputs = (*network)->Run(inputs, {}, nullptr);
    if (!outputs.ok()) {
      ASSERT_FALSE(outputs.status().message().empty()) << "bit " << bit;
      ++damage->failed;
      continue;
    }
    ++damage->ran;
    ExpectSound(*outputs, bit);
    if (testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace gestus::test
