// Memory of weights: what is packed is given back, several plans share it, and nothing of that
// changes a bit of any output.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "engine/plan.h"
#include "engine/session.h"
#include "tests/engine/dense.h"
#include "tests/engine/temp_file.h"
#include "tests/engine/weights_builder.h"

namespace gestus::test {
namespace {

constexpr std::int64_t kRows = 1024, kCols = 1024, kLayers = 6;  // 4 MiB each
constexpr double kMb = 1e-6;

std::string NameOf(std::int64_t layer) { return "n.w" + std::to_string(layer); }

/// Square matrices, and between them biases, which are read where they lie.
Bytes WeightsBytes() {
  FileSpec spec = GoodFile();
  spec.tensors.clear();
  for (std::int64_t i = 0; i < kLayers; ++i) {
    std::vector<float> weight = Noise(kRows * kCols, static_cast<std::uint32_t>(i));
    for (float& w : weight) w *= 0.05f;
    spec.tensors.push_back({NameOf(i), {kRows, kCols}, std::move(weight)});
    spec.tensors.push_back({"n.b" + std::to_string(i), {kRows}, Noise(kRows, 100)});
  }
  return spec.Build();
}

TensorView Weight(const WeightsFile& file, std::int64_t layer) {
  return file.Find(NameOf(layer))->view;
}

/// A chain of products; `split`: the first in two halves, as the last block of AST is.
Graph Chain(const WeightsFile& file, bool split = false) {
  Graph g;
  Value x = g.Input("x", {3, kCols});
  for (std::int64_t i = 0; i < kLayers; ++i) {
    const TensorView weight = Weight(file, i);
    const TensorView bias = file.Find("n.b" + std::to_string(i))->view;
    if (!split || i > 0) {
      x = g.Linear(x, {weight, bias}, Activation::kTanh);
      continue;
    }
    std::vector<Value> halves;
    for (const std::int64_t begin : {std::int64_t{0}, kRows / 2}) {
      TensorView part = bias;
      part.shape = {kRows / 2};
      part.data = bias.f32() + begin;
      halves.push_back(g.Linear(x, {weight.Rows(begin, kRows / 2), part}, Activation::kTanh));
    }
    x = g.Concat(halves);
  }
  g.Output("y", x);
  return g;
}

std::vector<float> OutputOf(const std::shared_ptr<const Plan>& plan) {
  auto session = Session::Create(plan);
  EXPECT_TRUE(session.ok());
  const std::vector<float> x = Noise(3 * kCols, 7);
  std::copy(x.begin(), x.end(), (*session)->Input("x").f32);
  (*session)->Run();
  const ValueView y = (*session)->Output("y");
  std::vector<float> result;
  for (std::int64_t row = 0; row < 3; ++row)
    result.insert(result.end(), y.f32 + row * y.row_stride, y.f32 + row * y.row_stride + kRows);
  return result;
}

/// The least instruction set of this machine; where there is but one, the best.
const kernels::KernelTable& LeastTable() {
  for (const kernels::Isa isa : kernels::kAllIsas) {
    if (const kernels::KernelTable* table = kernels::TableFor(isa)) return *table;
  }
  return kernels::BestTable();
}

/// Bytes that are resident, by /proc.
double Resident() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

std::vector<float> Expected(const Bytes& bytes) {
  const auto file = WeightsFile::FromMemory(bytes.data(), bytes.size(), "memory");
  EXPECT_TRUE(file.ok());
  WeightCache cache(kernels::BestTable(), nullptr);  // gives nothing back
  const auto plan = Plan::Make(Chain(**file), cache);
  EXPECT_TRUE(plan.ok());
  return OutputOf(*plan);
}

class WeightsMemoryTest : public testing::TestWithParam<Residence> {
 protected:
  static void SetUpTestSuite() {
    bytes_ = WeightsBytes();
    expected_ = Expected(bytes_);
  }
  std::shared_ptr<const WeightsFile> Open() const {
    auto file = WeightsFile::Open(temp_.path(), {.residence = GetParam()});
    EXPECT_TRUE(file.ok()) << file.status().message();
    return *file;
  }
  static Result<std::shared_ptr<const Plan>> PlanOf(
      const std::shared_ptr<const WeightsFile>& file, bool split = false,
      const kernels::KernelTable& kernels = kernels::BestTable()) {
    WeightCache cache(kernels, file);
    return Plan::Make(Chain(*file, split), cache);
  }

  static Bytes bytes_;
  static std::vector<float> expected_;
  TempFile temp_{bytes_};
};
Bytes WeightsMemoryTest::bytes_;
std::vector<float> WeightsMemoryTest::expected_;

INSTANTIATE_TEST_SUITE_P(Both, WeightsMemoryTest,
                         testing::Values(Residence::kMapped, Residence::kCopied),
                         [](const auto& test) {
                           return test.param == Residence::kMapped ? "Mapped" : "Copied";
                         });

TEST_P(WeightsMemoryTest, HoldsEachWeightOnce) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(GESTUS_EMULATED)
  GTEST_SKIP() << "memory of sanitizers and emulators";
#endif
  const double before = Resident();
  const auto file = Open();
  const auto plan = PlanOf(file);
  ASSERT_TRUE(plan.ok());
  const double grown = Resident() - before;
  const auto size = static_cast<double>(bytes_.size());
  EXPECT_LT(grown, size + 4e6) << "file of " << size * kMb << " MB, grown by " << grown * kMb;
  EXPECT_GT(grown, 0.9 * size);
  EXPECT_EQ(OutputOf(*plan), expected_);
}

TEST_P(WeightsMemoryTest, ModelsOfOneFileShareWhatIsPacked) {
  const auto file = Open();
  WeightCache first(kernels::BestTable(), file), second(kernels::BestTable(), file);
  const auto one = Plan::Make(Chain(*file), first), other = Plan::Make(Chain(*file), second);
  ASSERT_TRUE(one.ok() && other.ok());
  EXPECT_GE(first.packed_bytes(), static_cast<std::size_t>(kLayers * kRows * kCols) * 4);
  EXPECT_EQ(second.packed_bytes(), 0u);
  EXPECT_EQ(OutputOf(*one), expected_);
  EXPECT_EQ(OutputOf(*other), expected_);
}

TEST_P(WeightsMemoryTest, PlansThatComeLaterAreTheSame) {
  const auto file = Open();
  for (int i = 0; i < 3; ++i) {
    const auto plan = PlanOf(file);
    ASSERT_TRUE(plan.ok());
    EXPECT_EQ(OutputOf(*plan), expected_) << "plan " << i;
  }
}

TEST_P(WeightsMemoryTest, OtherPartsAndOtherKernelsGetThemBack) {
  const auto file = Open();
  const auto whole = PlanOf(file);
  ASSERT_TRUE(whole.ok());
  const auto halves = PlanOf(file, /*split=*/true);
  ASSERT_TRUE(halves.ok()) << halves.status().message();
  EXPECT_EQ(OutputOf(*halves), expected_);
  const auto least = PlanOf(file, false, LeastTable());
  ASSERT_TRUE(least.ok()) << least.status().message();
  const std::vector<float> got = OutputOf(*least);
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_NEAR(got[i], expected_[i], 1e-3f);
}

TEST_P(WeightsMemoryTest, WhatIsReadWhereItLiesStays) {
  const auto file = Open();
  const std::vector<float> first(Weight(*file, 0).f32(), Weight(*file, 0).f32() + kCols);
  const auto tied = [&](bool product_first) {
    Graph g;
    const Value ids = g.Input("ids", {2}, DType::kI32);
    const Value x = g.Input("x", {3, kCols});
    const TensorView table = Weight(*file, 0);
    if (product_first) g.Output("y", g.Linear(x, {table, {}}));
    g.Output("row", g.Embedding(ids, table));
    return g;
  };
  // Packed and read in place by one graph; then read in place after it was packed and given back.
  WeightCache cache(kernels::BestTable(), file);
  for (int round = 0; round < 2; ++round) {
    const auto plan = Plan::Make(tied(round == 0), cache);
    ASSERT_TRUE(plan.ok());
    ASSERT_TRUE(PlanOf(file).ok());
    auto session = Session::Create(*plan);
    ASSERT_TRUE(session.ok());
    (*session)->Input("ids").i32[0] = (*session)->Input("ids").i32[1] = 0;
    (*session)->Run();
    const float* row = (*session)->Output("row").f32;
    EXPECT_EQ(std::vector<float>(row, row + kCols), first);
  }
}

TEST(WeightsMemoryOfACopyTest, RawReadersAfterGivingBackGetThemBack) {
  const TempFile temp(WeightsBytes());
  const auto file = WeightsFile::Open(temp.path(), {.residence = Residence::kCopied});
  ASSERT_TRUE(file.ok());
  const std::vector<float> first(Weight(**file, 3).f32(), Weight(**file, 3).f32() + kCols);
  WeightCache cache(kernels::BestTable(), *file);
  ASSERT_TRUE(Plan::Make(Chain(**file), cache).ok());
  Graph g;
  g.Output("row", g.Embedding(g.Input("ids", {1}, DType::kI32), Weight(**file, 3)));
  const auto plan = Plan::Make(std::move(g), cache);
  ASSERT_TRUE(plan.ok());
  auto session = Session::Create(*plan);
  ASSERT_TRUE(session.ok());
  (*session)->Input("ids").i32[0] = 0;
  (*session)->Run();
  const float* row = (*session)->Output("row").f32;
  EXPECT_EQ(std::vector<float>(row, row + kCols), first);
}

// A private copy does not feel what becomes of its file; what it would have to read again, for
// other kernels, it refuses rather than take other bytes.
TEST(WeightsMemoryOfACopyTest, AFileThatChangesIsNoticedOrOfNoEffect) {
  const Bytes bytes = WeightsBytes();
  const std::vector<float> expected = Expected(bytes);
  const auto damage = {+[](const std::string& path) { return truncate(path.c_str(), 100); },
                       +[](const std::string& path) {
                         std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
                         file.seekp(1 << 20);
                         file << std::string(4, 'x');
                         return file.good() ? 0 : -1;
                       }};
  for (const auto& change : damage) {
    const TempFile temp(bytes);
    const auto file = WeightsFile::Open(temp.path(), {.residence = Residence::kCopied});
    ASSERT_TRUE(file.ok());
    ASSERT_EQ(change(temp.path()), 0);
    for (int i = 0; i < 2; ++i) {
      WeightCache cache(kernels::BestTable(), *file);
      const auto plan = Plan::Make(Chain(**file), cache);
      ASSERT_TRUE(plan.ok()) << plan.status().message();
      EXPECT_EQ(OutputOf(*plan), expected);
    }
    if (&LeastTable() == &kernels::BestTable()) continue;
    WeightCache least(LeastTable(), *file);
    const auto plan = Plan::Make(Chain(**file), least);
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.status().code(), Code::kBadWeights);
    EXPECT_NE(plan.status().message().find("file has changed since it was opened"),
              std::string::npos);
    // The plans that are there go on.
    WeightCache again(kernels::BestTable(), *file);
    const auto good = Plan::Make(Chain(**file), again);
    ASSERT_TRUE(good.ok());
    EXPECT_EQ(OutputOf(*good), expected);
  }
}

}  // namespace
}  // namespace gestus::test
