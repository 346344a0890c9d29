// The recurrence of an LSTM layer; the products with its input are a Linear before it, batched over
// time.  The hidden units are divided into parts, and each step is a phase.
#include <cstring>

#include "engine/ops/bind.h"

namespace gestus {
namespace {

// Below this many units a step is shorter than threads need to hear of one another.
constexpr std::size_t kMinUnitsToDivide = 256;

class LstmOp final : public BoundOp {
 public:
  explicit LstmOp(const Binding& b)
      : block_(b.kernels->lstm_block),
        scratch_(b.part_scratch),
        scratch_stride_(b.part_scratch_stride),
        proj_(b.in[0]),
        out_(b.out),
        packed_(b.packed),
        reverse_(b.node->reverse),
        cell_(b.shared_scratch),
        zeros_(b.shared_scratch + b.out.cols) {
    const kernels::ProductKernels* products = ProductsOf(*b.kernels, b.node->weight.dtype);
    step_ = products != nullptr ? products->lstm_step : b.kernels->f32_lstm_step;
  }

  /// A sequence begins with a state of zeros, and then has a phase for each step.
  std::size_t phases() const override { return divided() ? out_.batch * (1 + out_.rows) : 1; }

  void Run(const Part& part) const noexcept override {
    if (divided()) {
      const Part::Range units = part.Of(out_.cols, block_);
      const std::size_t sequence = part.phase / (1 + out_.rows);
      const std::size_t phase = part.phase % (1 + out_.rows);
      if (units.empty()) return;
      if (phase == 0) return Begin(units);
      return Step(sequence, phase - 1, units, part.index);
    }
    if (part.index != 0) return;
    const Part::Range units{0, out_.cols};
    for (std::size_t b = 0; b < out_.batch; ++b) {
      Begin(units);
      for (std::size_t i = 0; i < out_.rows; ++i) Step(b, i, units, 0);
    }
  }

 private:
  bool divided() const { return out_.cols >= kMinUnitsToDivide; }

  void Begin(Part::Range units) const {
    for (float* state : {cell_, zeros_}) {
      std::memset(state + units.begin, 0, (units.end - units.begin) * sizeof(float));
    }
  }

  /// Step number i, counted in the order in which the layer goes through its rows.
  void Step(std::size_t b, std::size_t i, Part::Range units, int part) const {
    const std::size_t t = RowOf(i);
    kernels::LstmStepArgs args;
    args.packed = packed_;
    args.scratch = scratch_ + static_cast<std::size_t>(part) * scratch_stride_;
    args.c = cell_;
    args.hidden = out_.cols;
    args.unit_begin = units.begin;
    args.unit_end = units.end;
    args.h_in = i == 0 ? zeros_ : out_.at(b, RowOf(i - 1));
    args.h_out = out_.at(b, t);
    args.x_proj = proj_.at(b, t);
    args.backward = i % 2 != 0;
    step_(args);
  }

  std::size_t RowOf(std::size_t i) const { return reverse_ ? out_.rows - 1 - i : i; }

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
