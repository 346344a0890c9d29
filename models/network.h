// What the command line, the tests and the benches know of a network: named arrays in, named
// arrays out.  Each model's own header offers the typed, allocation-free way for programs that
// embed gestus.
#ifndef GESTUS_MODELS_NETWORK_H_
#define GESTUS_MODELS_NETWORK_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/session.h"
#include "engine/status.h"
#include "engine/tensor.h"
#include "engine/weights_file.h"
#include "kernels/kernels.h"

namespace gestus::models {

/// An array that owns its elements: `f32` or `i32` holds them, as `dtype` says.
struct Array {
  DType dtype = DType::kF32;
  std::vector<std::int64_t> shape;
  std::vector<float> f32;
  std::vector<std::int32_t> i32;
};
using Arrays = std::map<std::string, Array>;

/// What a network takes or gives under one name.
struct ArraySpec {
  static constexpr std::int64_t kAny = -1;  ///< a dimension that the input decides

  std::string name;
  DType dtype = DType::kF32;
  std::vector<std::int64_t> shape;  ///< kAny where any length is taken
  std::vector<std::string> axes;    ///< what each dimension counts: "frames", "mel bins"
  bool required = true;
  std::string unit;     ///< "ln power", "pixels / 167 per shoulder", "-"
  std::string meaning;  ///< one line
};

struct Signature {
  std::vector<ArraySpec> inputs;
  std::vector<ArraySpec> outputs;
};

/// How networks that choose among tokens choose.
struct Sampling {
  float temperature = 0;   ///< 0: the likeliest token; higher: more variety
  int top_k = 0;           ///< how many of the likeliest tokens may be drawn; 0: all
  std::uint32_t seed = 0;  ///< the same seed draws the same tokens
};

struct RunOptions {
  int threads = 1;
  int repeat = 1;        ///< how often each segment runs; the report holds every time
  bool profile = false;  ///< fills RunReport::ops
  Sampling sampling{};
  /// A plan of less work runs on the caller's thread alone.
  double least_shared_flops = kLeastSharedFlops;
  bool taps = false;  ///< adds every named intermediate to the outputs, as "tap/<name>"
  /// Called after each segment, from the calling thread.
  std::function<void(std::size_t done, std::size_t total)> progress{};
};

struct RunReport {
  std::vector<double> segment_seconds;  ///< one for each run of each segment
  std::size_t frames = 0;               ///< of output
  double frame_rate = 0;
  std::vector<std::string> notes;  ///< what was padded, assumed or left out; one line each
  std::vector<OpProfile> ops;      ///< summed over segments, in the order of execution
};

class Network {
 public:
  virtual ~Network() = default;

  virtual const char* kind() const = 0;  ///< "ZS-MSTM 1.0"
  virtual const Signature& signature() const = 0;
  /// Checks `inputs` against the signature, runs them, and returns the outputs.
  virtual Result<Arrays> Run(const Arrays& inputs, const RunOptions& options,
                             RunReport* report) = 0;
  /// The plans of this network's graphs as text: ops, shapes, arena offsets, bytes, FLOPs.  Empty
  /// without a plan.
  virtual std::string PlanText() const = 0;
};

struct NetworkOptions {
  const kernels::KernelTable* kernels = nullptr;  ///< null: BestTable()
  std::uint64_t max_arena_bytes = std::uint64_t{4} << 30;
  /// False: only kind and signature are wanted; nothing is packed, Run is an error and PlanText
  /// empty.
  bool plan = true;
};

/// Builds the network called `name` (empty: the only one) of `file`: checks its configuration,
/// binds its tensors, plans its graphs for the largest declared input.
Result<std::unique_ptr<Network>> MakeNetwork(std::shared_ptr<const WeightsFile> file,
                                             const std::string& name,
                                             const NetworkOptions& options = {});

/// "x (2, 3) float32, expected (T, 128)": checks one array against its specification.
Status CheckArray(const ArraySpec& spec, const Array& array);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_NETWORK_H_
