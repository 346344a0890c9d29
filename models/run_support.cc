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
  const Sampling& s = options.sampling;
  if (!(s.temperature >= 0 && s.temperature <= 100))
    return Status(Code::kInvalidArgument,
                  "temperature: " + std::to_string(s.temperature) + ", expected 0 to 100");
  if (s.top_k < 0)
    return Status(Code::kInvalidArgument,
                  "top-k: " + std::to_string(s.top_k) + ", expected 0 or more");
  return {};
}

Status CheckSameRows(const Arrays& inputs, const std::string& name, const std::string& other,
                     const std::string& rows) {
  const std::int64_t found = inputs.at(name).shape[0], expected = inputs.at(other).shape[0];
  if (found == expected) return {};
  return Status(Code::kBadInput, name + ": " + std::to_string(found) + " " + rows +
                                     ", expected those of " + other + ", " +
                                     std::to_string(expected));
}

SessionOptions SessionOptionsOf(const RunOptions& options) {
  SessionOptions made;
  made.threads = options.threads;
  made.profile = options.profile;
  made.least_shared_flops = options.least_shared_flops;
  return made;
}

Status NotPlanned() {
  return Status(Code::kInvalidArgument,
                "network: made without a plan, expected NetworkOptions::plan to run it");
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

Array MakeArray(std::vector<std::int64_t> shape, DType dtype) {
  Array a;
  std::size_t n = 1;
  for (std::int64_t d : shape) n *= static_cast<std::size_t>(d);
  if (dtype == DType::kI32)
    a.i32.resize(n);
  else
    a.f32.resize(n);
  a.dtype = dtype;
  a.shape = std::move(shape);
  return a;
}

ArraySpec Spec(const std::string& name, std::vector<std::int64_t> shape,
               std::vector<std::string> axes, const std::string& unit, const std::string& meaning) {
  ArraySpec spec;
  spec.name = name;
  spec.shape = std::move(shape);
  spec.axes = std::move(axes);
  spec.unit = unit;
  spec.meaning = meaning;
  return spec;
}

void CopyIn(const ValueView& to, const float* from) {
  const auto cols = static_cast<std::size_t>(to.shape.Cols());
  for (std::int64_t r = 0; r < to.shape.Rows(); ++r)
    std::memcpy(to.f32 + r * to.row_stride, from + r * to.shape.Cols(), cols * sizeof(float));
}

void CopyOut(float* to, const ValueView& from) {
  const auto cols = static_cast<std::size_t>(from.shape.Cols());
  for (std::int64_t r = 0; r < from.shape.Rows(); ++r)
    std::memcpy(to + r * from.shape.Cols(), from.f32 + r * from.row_stride, cols * sizeof(float));
}

void CopyOut(std::int32_t* to, const ValueView& from) {
  const auto cols = static_cast<std::size_t>(from.shape.Cols());
  for (std::int64_t r = 0; r < from.shape.Rows(); ++r)
    std::memcpy(to + r * from.shape.Cols(), from.i32 + r * from.row_stride,
                cols * sizeof(std::int32_t));
}

void AddNote(RunReport* report, const std::string& note) {
  if (report != nullptr && !note.empty()) report->notes.push_back(note);
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
    CopyOut(a.f32.data(), view);
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
