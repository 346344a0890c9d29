// Runs a network on the input in its own file.
#include "models/self_test.h"

#include <cmath>

#include "weights_generated.h"

namespace gestus::models {
namespace {

Array ToArray(const TensorView& view) {
  Array a;
  a.dtype = view.dtype;
  for (int i = 0; i < view.shape.rank(); ++i) a.shape.push_back(view.shape[i]);
  const auto n = static_cast<std::size_t>(view.shape.NumElements());
  if (view.dtype == DType::kI32) a.i32.assign(view.i32(), view.i32() + n);
  if (view.dtype == DType::kF32) a.f32.assign(view.f32(), view.f32() + n);
  return a;
}

}  // namespace

void UseSelfTest(Binder& binder, const fb::Network& network) {
  const fb::SelfTest* test = network.self_test();
  if (test == nullptr) return;
  for (const flatbuffers::String* name : *test->inputs()) binder.Use(name->str());
  binder.Use(test->output()->str());
}

Result<SelfTestReport> RunSelfTest(const WeightsFile& file, const std::string& name,
                                   Network& network, const RunOptions& options) {
  const fb::Network* record = file.FindNetwork(name);
  SelfTestReport report;
  if (record == nullptr || record->self_test() == nullptr) return report;
  const fb::SelfTest& test = *record->self_test();
  const auto error = [&](const std::string& what) {
    return Status(Code::kBadWeights, file.path() + ": self-test: " + what);
  };
  if (test.inputs()->size() != test.input_names()->size())
    return error("as many input names as inputs are expected");
  Arrays inputs;
  for (flatbuffers::uoffset_t i = 0; i < test.inputs()->size(); ++i) {
    const WeightsFile::Entry* tensor = file.Find(test.inputs()->Get(i)->string_view());
    if (tensor == nullptr) return error("tensor " + test.inputs()->Get(i)->str() + " is missing");
    inputs[test.input_names()->Get(i)->str()] = ToArray(tensor->view);
  }
  const WeightsFile::Entry* want = file.Find(test.output()->string_view());
  if (want == nullptr || want->view.dtype != DType::kF32)
    return error("tensor " + test.output()->str() + " is missing or not float32");

  Result<Arrays> outputs = network.Run(inputs, options, nullptr);
  if (!outputs.ok()) return outputs.status().In(file.path() + ": self-test");
  const auto got = outputs->find(test.output_name()->str());
  const auto n = static_cast<std::size_t>(want->view.shape.NumElements());
  if (got == outputs->end() || got->second.f32.size() != n)
    return error("output " + test.output_name()->str() + " has another size than expected");
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = want->view.f32()[i];
    worst = std::max(worst, std::fabs(got->second.f32[i] - w));
    largest = std::max(largest, std::fabs(w));
  }
  report.present = true;
  report.relative_error = largest > 0 ? worst / largest : worst;
  report.tolerance = test.relative_tolerance();
  return report;
}

}  // namespace gestus::models
