// The stages allocate when they are made and never again, so that the length of a recording costs
// no memory.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "models/prosody/swipe.h"
#include "models/prosody/voice_quality.h"
#include "tests/prosody/signals.h"

namespace {
std::atomic<long> allocations{0};
}  // namespace

// Not inlined, or the compiler sees free() behind new and warns.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  void* p = std::malloc(size > 0 ? size : 1);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace gestus::prosody {
namespace {

template <class Stage>
long AllocationsOf(Stage& stage) {
  const test::Samples x = test::Pulses(16000, 3, 120, 0.003, 0.02);
  test::Samples rows((stage.MaxRows(2 * x.size()) + stage.MaxRowsAtFinish()) * Stage::kColumns);
  const long before = allocations;
  std::size_t count = stage.Push(x.data(), x.size(), rows.data());
  for (const float& sample : x)
    count += stage.Push(&sample, 1, rows.data() + count * Stage::kColumns);
  count += stage.Finish(rows.data() + count * Stage::kColumns);
  EXPECT_EQ(count, 600u);
  return allocations - before;
}

TEST(MemoryTest, NothingIsAllocatedWhileRunning) {
  const long before = allocations;
  auto swipe = Swipe::Make({});
  auto quality = VoiceQuality::Make({});
  EXPECT_GT(allocations, before);
  EXPECT_EQ(AllocationsOf(*swipe), 0);
  EXPECT_EQ(AllocationsOf(*quality), 0);
}

}  // namespace
}  // namespace gestus::prosody
