// Ops whose output row depends on the input row alone, so parts are of rows.
#include "engine/ops/bind.h"

namespace gestus {
namespace {

class RowwiseOp final : public BoundOp {
 public:
  explicit RowwiseOp(const Binding& b)
      : kernels_(*b.kernels), node_(*b.node), x_(b.in[0]), out_(b.out) {
    if (b.in.size() > 1) other_ = b.in[1];
    repeat_other_ = other_.rows * other_.batch == 1;
  }

  void Run(const Part& part) const noexcept override {
    const Part::Range range = part.Of(x_.batch * x_.rows);
    // Rows of one matrix at a time: matrices of a batch need not be evenly spaced.
    for (std::size_t at = range.begin; at < range.end;) {
      const std::size_t b = at / x_.rows, row = at % x_.rows;
      const std::size_t left = x_.rows - row;
      const std::size_t rows = range.end - at < left ? range.end - at : left;
      RunRows(b, row, rows);
      at += rows;
    }
  }

 private:
  void RunRows(std::size_t b, std::size_t row, std::size_t rows) const {
    float* y = out_.at(b, row);
    const float* x = x_.at(b, row);
    const std::ptrdiff_t ys = out_.row_stride, xs = x_.row_stride;
    const std::size_t cols = x_.cols;
    switch (node_.op) {
      case Op::kLayerNorm:
        kernels_.f32_layer_norm(y, ys, x, xs, node_.weight.f32(), node_.bias.f32(), node_.eps, rows,
                                cols);
        break;
      case Op::kSoftmax:
        kernels_.f32_softmax(y, ys, x, xs, rows, cols);
        break;
      case Op::kActivate:
        kernels_.f32_activate(y, ys, x, xs, rows, cols, node_.act, node_.alpha);
        break;
      case Op::kAdd:
        kernels_.f32_add(y, ys, x, xs, repeat_other_ ? other_.f32 : other_.at(b, row),
                         repeat_other_ ? 0 : other_.row_stride, rows, cols);
        break;
      default:
        kernels_.f32_affine(y, ys, x, xs, node_.weight.f32(), node_.bias.f32(), rows, cols);
    }
  }

  const kernels::KernelTable& kernels_;
  const Node& node_;
  Ref x_, other_, out_;
  bool repeat_other_ = false;
};

}  // namespace

std::unique_ptr<BoundOp> BindRowwise(const Binding& b) { return std::make_unique<RowwiseOp>(b); }

}  // namespace gestus
