// Shared parts of the networks' array interface.
#include "models/run_support.h"

#include <chrono>
#include <cmath>
#include <cstring>

#include "engine/plan.h"

namespace gestus::models {

Status CheckInputs(const Signature& signature, const Arrays& inputs) {
  for (const ArraySpec& spec : signature.inputs) {
    const auto it = inputs.find(spec.name);
    if (it == inputs.end()) {
      if (!spec.required) continue;
      return Status(Code::kBadInput, spec.name + ": missing, expected " + spec.meaning);
    }
    GESTUS_RETURN_IF_ERROR(CheckArray(spec, it->second));
    GESTUS_RETURN_IF_ERROR(CheckFinite(spec.name, it->second, Code::kBadInput));
  }
  return {};
}

Status CheckOptions(const RunOptions& options) {
  if (options.repeat < 1)
    return Status(Code::kInvalidArgument,
                  "repeat: " + std::to_string(options.repeat) + ", expected 1 or more");
  if (options.threads < 1 || options.threads > kMaxThreads)
    return Status(Code::kInvalidArgument, "threads: " + std::to_string(options.threads) +
                                              ", expected 1 to " + std::to_string(kMaxThreads));
  return {};
}

Status CheckFinite(const std::string& name, const Array& array, Code code) {
  const std::int64_t cols = array.shape.empty() ? 1 : array.shape.back();
  for (std::size_t i = 0; i < array.f32.size(); ++i) {
    if (std::isfinite(array.f32[i])) continue;
    const auto at = static_cast<std::int64_t>(i);
    return Status(code, name + ": " + (std::isnan(array.f32[i]) ? "NaN" : "infinity") + " at row " +
                            std::to_string(at / cols) + ", column " + std::to_string(at % cols) +
                            ", expected finite values");
  }
  return {};
}

Array MakeArray(std::vector<std::int64_t> shape) {
  Array a;
  std::int64_t n = 1;
  for (std::int64_t d : shape) n *= d;
  a.f32.resize(static_cast<std::size_t>(n));
  a.shape = std::move(shape);
  return a;
}

void TimedRun(const RunOptions& options, RunReport* report, const std::function<void()>& run) {
  using Clock = std::chrono::steady_clock;
  for (int i = 0; i < options.repeat; ++i) {
    const Clock::time_point begin = Clock::now();
    run();
    if (report != nullptr)
      report->segment_seconds.push_back(
          std::chrono::duration<double>(Clock::now() - begin).count());
  }
}

void CopyTaps(const Session& session, Arrays* outputs) {
  for (const NamedValue& out : session.plan().outputs()) {
    if (out.name.rfind("tap/", 0) != 0) continue;
    const ValueView view = session.Output(out.name);
    const std::int64_t rows = view.shape.Rows(), cols = view.shape.Cols();
    Array a = MakeArray({rows, cols});
    for (std::int64_t r = 0; r < rows; ++r)
      std::memcpy(a.f32.data() + r * cols, view.f32 + r * view.row_stride,
                  static_cast<std::size_t>(cols) * sizeof(float));
    (*outputs)[out.name] = std::move(a);
  }
}

void AddProfiles(std::initializer_list<const Session*> sessions, RunReport* report) {
  if (report == nullptr) return;
  for (const Session* session : sessions) {
    for (OpProfile& op : session->Profile()) {
      if (op.runs > 0) report->ops.push_back(std::move(op));
    }
  }
}

}  // namespace gestus::models
