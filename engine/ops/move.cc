// Ops that put rows in other places.  They move little, so part 0 does them alone.
#include <algorithm>
#include <cstring>

#include "engine/ops/bind.h"

namespace gestus {
namespace {

class MoveOp final : public BoundOp {
 public:
  explicit MoveOp(const Binding& b)
      : kernels_(*b.kernels), node_(*b.node), in_(b.in), out_(b.out) {}

  void Run(const Part& part) const noexcept override {
    if (part.index != 0) return;
    const Ref& x = in_[0];
    const auto step = static_cast<std::size_t>(part.step);
    switch (node_.op) {
      case Op::kConcat:
        return Concat();
      case Op::kConcatRows:
        return ConcatRows();
      case Op::kRepeatRows:
        return Copy(out_.f32, out_.row_stride, x.f32, 0, out_.rows, out_.cols);
      case Op::kMeanRows:
        return kernels_.f32_mean_rows(out_.f32, x.f32, x.row_stride, x.rows, x.cols);
      case Op::kGather:
        return Gather();
      case Op::kPatches:
        return Patches();
      case Op::kPadRows:
        return PadRows();
      case Op::kStoreRows: {
        const std::size_t rows = std::min(x.rows, step + 1), first = x.rows - rows;
        return Copy(out_.at(0, step + 1 - rows), out_.row_stride, x.at(0, first), x.row_stride,
                    rows, out_.cols);
      }
      case Op::kLastRows: {
        const std::size_t rows = std::min(out_.rows, step + 1), first = out_.rows - rows;
        Zero(0, 0, first);
        return Copy(out_.at(0, first), out_.row_stride, x.at(0, step + 1 - rows), x.row_stride,
                    rows, out_.cols);
      }
      case Op::kStepRow:
        return Copy(out_.f32, 0, x.at(0, step), 0, 1, out_.cols);
      default:
        return PreviousRow(step);
    }
  }

 private:
  void Copy(float* y, std::ptrdiff_t ys, const float* x, std::ptrdiff_t xs, std::size_t rows,
            std::size_t cols) const {
    kernels_.f32_copy_rows(y, ys, x, xs, rows, cols);
  }

  // Parts that already lie where the whole does were put there by the planner.
  void Concat() const {
    std::size_t column = 0;
    for (const Ref& part : in_) {
      for (std::size_t b = 0; b < part.batch && part.f32 != out_.f32 + column; ++b)
        Copy(out_.at(b, 0) + column, out_.row_stride, part.at(b, 0), part.row_stride, part.rows,
             part.cols);
      column += part.cols;
    }
  }

  void ConcatRows() const {
    std::size_t row = 0;
    for (const Ref& part : in_) {
      if (part.f32 != out_.at(0, row))
        Copy(out_.at(0, row), out_.row_stride, part.f32, part.row_stride, part.rows, part.cols);
      row += part.rows;
    }
  }

  void Gather() const {
    const auto vocabulary = static_cast<std::size_t>(node_.weight.shape[0]);
    if (const kernels::ProductKernels* typed = ProductsOf(kernels_, node_.weight.dtype))
      return typed->gather(out_.f32, out_.row_stride, node_.weight.data, node_.weight.scale,
                           in_[0].i32(), out_.rows, out_.cols, vocabulary, node_.scale);
    kernels_.f32_gather(out_.f32, out_.row_stride, node_.weight.f32(),
                        static_cast<std::ptrdiff_t>(out_.cols), in_[0].i32(), out_.rows, out_.cols,
                        vocabulary, node_.scale);
  }

  // x (T, F) is an image of F rows and T columns.
  void Patches() const {
    const Ref& x = in_[0];
    const auto patch = static_cast<std::size_t>(node_.patches.patch);
    const auto stride = static_cast<std::size_t>(node_.patches.stride);
    kernels::PatchArgs args;
    args.out = out_.f32;
    args.out_stride = out_.row_stride;
    args.image = x.f32;
    args.stride_h = 1;
    args.stride_w = x.row_stride;
    args.kh = args.kw = patch;
    args.step_h = args.step_w = stride;
    args.ph = (x.cols - patch) / stride + 1;
    args.pw = (x.rows - patch) / stride + 1;
    kernels_.f32_patches(args);
  }

  void PadRows() const {
    const Ref& x = in_[0];
    const auto before = static_cast<std::size_t>(node_.before);
    for (std::size_t b = 0; b < x.batch; ++b) {
      Zero(b, 0, before);
      Copy(out_.at(b, before), out_.row_stride, x.at(b, 0), x.row_stride, x.rows, x.cols);
      Zero(b, before + x.rows, out_.rows);
    }
  }

  void Zero(std::size_t b, std::size_t from, std::size_t to) const {
    for (std::size_t row = from; row < to; ++row)
      std::memset(out_.at(b, row), 0, out_.cols * sizeof(float));
  }

  void PreviousRow(std::size_t step) const {
    if (step > 0) return Copy(out_.f32, 0, in_[0].at(0, step - 1), 0, 1, out_.cols);
    if (in_.size() > 1) return Copy(out_.f32, 0, in_[1].f32, 0, 1, out_.cols);
    Zero(0, 0, 1);
  }

  const kernels::KernelTable& kernels_;
  const Node& node_;
  std::vector<Ref> in_;
  Ref out_;
};

}  // namespace

std::unique_ptr<BoundOp> BindMove(const Binding& b) { return std::make_unique<MoveOp>(b); }

}  // namespace gestus
