// The recurrence of an LSTM layer; the products with its input are a Linear before it, batched over
// time.  Workers divide the hidden units and meet after each step.
#include <cstring>

#include "engine/ops/bind.h"

namespace gestus {
namespace {

// Below this many units a step is shorter than a meeting of threads.
constexpr std::size_t kMinUnitsToDivide = 256;

class LstmOp final : public BoundOp {
 public:
  explicit LstmOp(const Binding& b)
      : block_(b.kernels->lstm_block),
        scratch_(b.worker_scratch),
        scratch_stride_(b.worker_scratch_stride),
        proj_(b.in[0]),
        out_(b.out),
        packed_(b.packed),
        reverse_(b.node->reverse),
        cell_(b.shared_scratch),
        zeros_(b.shared_scratch + b.out.cols) {
    const kernels::ProductKernels* products = ProductsOf(*b.kernels, b.node->weight.dtype);
    step_ = products != nullptr ? products->lstm_step : b.kernels->f32_lstm_step;
  }

  void Run(const Worker& worker) const noexcept override {
    if (out_.cols < kMinUnitsToDivide) {
      if (worker.index == 0) RunUnits({0, out_.cols}, Worker{});
    } else {
      RunUnits(worker.Part(out_.cols, block_), worker);
    }
  }

 private:
  void RunUnits(Worker::Range units, const Worker& worker) const {
    kernels::LstmStepArgs args;
    args.packed = packed_;
    args.scratch = scratch_ + static_cast<std::size_t>(worker.index) * scratch_stride_;
    args.c = cell_;
    args.hidden = out_.cols;
    args.unit_begin = units.begin;
    args.unit_end = units.end;
    for (std::size_t b = 0; b < out_.batch; ++b) {
      Clear(cell_, units);
      Clear(zeros_, units);
      worker.Meet();
      const float* h = zeros_;
      for (std::size_t i = 0; i < out_.rows; ++i) {
        const std::size_t t = reverse_ ? out_.rows - 1 - i : i;
        args.h_in = h;
        args.h_out = out_.at(b, t);
        args.x_proj = proj_.at(b, t);
        args.backward = i % 2 != 0;
        if (!units.empty()) step_(args);
        worker.Meet();
        h = args.h_out;
      }
    }
  }

  static void Clear(float* x, Worker::Range units) {
    if (!units.empty()) std::memset(x + units.begin, 0, (units.end - units.begin) * sizeof(float));
  }

  void (*step_)(const kernels::LstmStepArgs& args);
  std::size_t block_;
  float* scratch_;
  std::size_t scratch_stride_;
  Ref proj_, out_;
  const void* packed_;
  bool reverse_;
  float *cell_, *zeros_;
};

}  // namespace

std::unique_ptr<BoundOp> BindLstm(const Binding& b) { return std::make_unique<LstmOp>(b); }

}  // namespace gestus
