// Weights files: opened, their networks made, planned and run once.  Sizes and checksum in the
// header are made to fit, or they would stop everything.
#include <cmath>

#include "engine/weights_file.h"
#include "models/features/spec.h"
#include "models/features/word_encoder.h"
#include "models/run_support.h"
#include "models/self_test.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/weights_bytes.h"

namespace gestus::fuzz {
namespace {

using models::Array;
using models::Arrays;

constexpr char kName[] = "fuzzed";

// Small values of the shapes that the network asks for.
Arrays MakeInputs(const models::Signature& signature) {
  constexpr std::size_t kMostElements = 1 << 20;
  Arrays inputs;
  for (const models::ArraySpec& spec : signature.inputs) {
    std::vector<std::int64_t> shape = spec.shape;
    std::size_t elements = 1;
    for (std::int64_t& d : shape) {
      if (d == models::ArraySpec::kAny) d = 3;
      Require(d > 0, "a signature has no empty dimensions");
      if (static_cast<std::size_t>(d) > kMostElements / elements) return {};
      elements *= static_cast<std::size_t>(d);
    }
    Array array = models::MakeArray(std::move(shape), spec.dtype);
    for (std::size_t i = 0; i < array.f32.size(); ++i)
      array.f32[i] = static_cast<float>(i % 17) * 0.125f - 1.0f;
    for (std::size_t i = 0; i < array.i32.size(); ++i) array.i32[i] = static_cast<int>(i % 3);
    inputs[spec.name] = std::move(array);
  }
  return inputs;
}

void Run(const WeightsFile& file, const std::string& name, models::Network& network) {
  const auto self_test = models::RunSelfTest(file, name, network);
  if (!self_test.ok()) RequireSentence(self_test.status(), kName);
  const Arrays inputs = MakeInputs(network.signature());
  if (inputs.empty()) return;
  models::RunReport report;
  const auto outputs = network.Run(inputs, {}, &report);
  if (!outputs.ok()) return Require(!outputs.status().message().empty(), "errors have a sentence");
  for (const auto& [output, array] : *outputs) {
    for (const float v : array.f32) Require(std::isfinite(v), "outputs are finite");
    for (const std::int32_t v : array.i32) Require(v >= 0, "tokens are not negative");
  }
}

void Use(const std::shared_ptr<const WeightsFile>& file) {
  features::FindTextNetworks(*file);
  for (const fb::Network* record : *file->root().networks()) {
    const std::string name = record->name()->str();
    const auto spec = features::ReadFeatureSpec(*record);
    if (!spec.ok()) Require(!spec.status().message().empty(), "errors have a sentence");
    const auto tokeniser = features::ReadTokeniser(*file, *record);
    if (!tokeniser.ok()) RequireSentence(tokeniser.status(), kName);
    const auto network = models::MakeNetwork(file, name, {.max_arena_bytes = 1 << 22});
    if (!network.ok()) {
      RequireSentence(network.status(), kName);
      continue;
    }
    Require(!(*network)->PlanText().empty(), "a planned network has a plan");
    Run(*file, name, **network);
  }
}

}  // namespace
}  // namespace gestus::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gestus;  // NOLINT: this is a test of that library
  test::Bytes bytes(data, data + size);
  fuzz::MendHeader(&bytes);
  const auto file = WeightsFile::FromMemory(bytes.data(), bytes.size(), fuzz::kName);
  if (file.ok()) {
    fuzz::Use(*file);
  } else {
    fuzz::RequireSentence(file.status(), fuzz::kName);
  }
  return 0;
}
