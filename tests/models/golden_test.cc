// Every alternative reading of the specification, engine against PyTorch: tests/goldens holds tiny
// networks with inputs, outputs and taps that converters/goldens.py computed (README.md there).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "models/cli/npz.h"
#include "models/network.h"
#include "models/self_test.h"

namespace gestus::models {
namespace {

namespace fs = std::filesystem;

// Relative to the largest absolute value: the bound that full-size networks are held to as well.
constexpr double kTolerance = 1e-4;

std::vector<std::string> Cases(const std::string& folder = "") {
  std::vector<std::string> cases;
  for (const auto& entry : fs::directory_iterator(std::string(GESTUS_GOLDENS) + folder)) {
    if (entry.path().extension() == ".fb") cases.push_back(entry.path().stem().string());
  }
  std::sort(cases.begin(), cases.end());
  return cases;
}

/// Integers are read as what they are: what the signature says, and the options that are counts.
DType TypeOf(const Signature& signature, const std::string& name) {
  for (const auto* list : {&signature.inputs, &signature.outputs}) {
    for (const ArraySpec& spec : *list) {
      if (spec.name == name) return spec.dtype;
    }
  }
  return name == "option/top_k" || name == "option/seed" ? DType::kI32 : DType::kF32;
}

Arrays ReadAll(const std::string& path, const Signature& signature) {
  const Result<std::vector<std::string>> names = cli::ListNpz(path);
  EXPECT_TRUE(names.ok()) << names.status().message();
  std::vector<ArraySpec> wanted;
  for (const std::string& name : *names) {
    ArraySpec spec;
    spec.name = name;
    spec.dtype = TypeOf(signature, name);
    wanted.push_back(spec);
  }
  Result<cli::NpzContents> contents = cli::ReadNpz(path, wanted);
  EXPECT_TRUE(contents.ok()) << contents.status().message();
  return std::move(contents->arrays);
}

/// Compares the rows that `got` has: where only the first rows of a value are needed, the engine
/// computes no others.
void ExpectClose(const std::string& name, const Array& got, const Array& want,
                 double tolerance = kTolerance) {
  if (got.dtype == DType::kI32) {
    EXPECT_EQ(got.shape, want.shape) << name;
    EXPECT_EQ(got.i32, want.i32) << name;
    return;
  }
  ASSERT_LE(got.f32.size(), want.f32.size()) << name;
  ASSERT_EQ(got.shape.back(), want.shape.back()) << name;
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < got.f32.size(); ++i) {
    worst = std::max(worst, std::fabs(double{got.f32[i]} - want.f32[i]));
    largest = std::max(largest, std::fabs(double{want.f32[i]}));
  }
  EXPECT_LE(worst, tolerance * largest) << name << ": relative error " << worst / largest;
  EXPECT_GT(largest, 0) << name << ": expected values are all zero and prove nothing";
}

Arrays InputsOf(const Network& network, const Arrays& golden) {
  Arrays inputs;
  for (const ArraySpec& spec : network.signature().inputs) {
    const auto it = golden.find(spec.name);
    if (it != golden.end()) inputs.insert(*it);
  }
  // A golden holds the style it expects under the name of the input; the clip decides.
  if (inputs.count("style_speech") != 0) inputs.erase("style");
  return inputs;
}

/// Arrays "option/..." are options of the run.
Sampling SamplingOf(const Arrays& golden) {
  Sampling sampling;
  if (const auto it = golden.find("option/temperature"); it != golden.end())
    sampling.temperature = it->second.f32.at(0);
  if (const auto it = golden.find("option/top_k"); it != golden.end())
    sampling.top_k = it->second.i32.at(0);
  if (const auto it = golden.find("option/seed"); it != golden.end())
    sampling.seed = static_cast<std::uint32_t>(it->second.i32.at(0));
  return sampling;
}

std::size_t Taps(const Arrays& arrays) {
  return static_cast<std::size_t>(std::count_if(
      arrays.begin(), arrays.end(), [](const auto& a) { return a.first.rfind("tap/", 0) == 0; }));
}

class GoldenTest : public testing::TestWithParam<std::tuple<std::string, kernels::Isa>> {};

TEST_P(GoldenTest, AgreesWithPyTorch) {
  const auto& [name, isa] = GetParam();
  const kernels::KernelTable* table = kernels::TableFor(isa);
  if (table == nullptr) GTEST_SKIP() << "no " << kernels::IsaName(isa) << " on this machine";
  const std::string stem = std::string(GESTUS_GOLDENS) + "/" + name;

  const auto file = WeightsFile::Open(stem + ".fb");
  ASSERT_TRUE(file.ok()) << file.status().message();
  auto network = MakeNetwork(*file, "", {.kernels = table});
  ASSERT_TRUE(network.ok()) << network.status().message();
  const Arrays golden = ReadAll(stem + ".npz", (*network)->signature());
  const Arrays inputs = InputsOf(**network, golden);

  for (const bool taps : {false, true}) {
    RunReport report;
    const auto outputs =
        (*network)->Run(inputs, {.sampling = SamplingOf(golden), .taps = taps}, &report);
    ASSERT_TRUE(outputs.ok()) << outputs.status().message();
    std::size_t compared = 0, tapped = 0;
    for (const auto& [output, array] : *outputs) {
      const auto want = golden.find(output);
      if (want == golden.end()) continue;
      ExpectClose(output, array, want->second);
      ++compared;
      tapped += output.rfind("tap/", 0) == 0;
    }
    EXPECT_EQ(compared - tapped, (*network)->signature().outputs.size());
    // What the reference taps and the engine does not would be compared by nobody.
    EXPECT_EQ(tapped, taps ? Taps(golden) : 0);
  }

  const auto self_test = RunSelfTest(**file, "", **network);
  ASSERT_TRUE(self_test.ok()) << self_test.status().message();
  if (self_test->present) {
    EXPECT_TRUE(self_test->passed()) << self_test->relative_error;
  }
}

using IsaCase = testing::TestParamInfo<std::tuple<std::string, kernels::Isa>>;
std::string NameOf(const IsaCase& test) {
  std::string name = std::get<0>(test.param) + "_" + kernels::IsaName(std::get<1>(test.param));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

// The same networks with small weights, which `converters quantise` made: the outputs stay within
// half as much again as the guard that it kept, on every instruction set.
class QuantisedGoldenTest : public GoldenTest {};

TEST_P(QuantisedGoldenTest, IsNearTheOriginal) {
  const auto& [name, isa] = GetParam();
  const kernels::KernelTable* table = kernels::TableFor(isa);
  if (table == nullptr) GTEST_SKIP() << "no " << kernels::IsaName(isa) << " on this machine";
  const std::size_t dot = name.find('.');
  const double tolerance = name.substr(dot) == ".int8" ? 0.045 : 0.015;
  const auto file = WeightsFile::Open(std::string(GESTUS_GOLDENS) + "/quantised/" + name + ".fb");
  ASSERT_TRUE(file.ok()) << file.status().message();
  auto network = MakeNetwork(*file, "", {.kernels = table});
  ASSERT_TRUE(network.ok()) << network.status().message();
  const Arrays golden = ReadAll(std::string(GESTUS_GOLDENS) + "/" + name.substr(0, dot) + ".npz",
                                (*network)->signature());
  const auto outputs =
      (*network)->Run(InputsOf(**network, golden), {.sampling = SamplingOf(golden)}, nullptr);
  ASSERT_TRUE(outputs.ok()) << outputs.status().message();
  std::size_t compared = 0;
  for (const auto& [output, array] : *outputs) {
    const auto want = golden.find(output);
    if (want == golden.end()) continue;
    ExpectClose(output, array, want->second, tolerance);
    ++compared;
  }
  EXPECT_EQ(compared, (*network)->signature().outputs.size());
  const auto self_test = RunSelfTest(**file, "", **network);
  ASSERT_TRUE(self_test.ok()) << self_test.status().message();
  EXPECT_TRUE(self_test->present && self_test->passed()) << self_test->relative_error;
}

INSTANTIATE_TEST_SUITE_P(All, QuantisedGoldenTest,
                         testing::Combine(testing::ValuesIn(Cases("/quantised")),
                                          testing::ValuesIn(kernels::kAllIsas)),
                         NameOf);

INSTANTIATE_TEST_SUITE_P(All, GoldenTest,
                         testing::Combine(testing::ValuesIn(Cases()),
                                          testing::ValuesIn(kernels::kAllIsas)),
                         NameOf);

}  // namespace
}  // namespace gestus::models
