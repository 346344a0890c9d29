// Matrix products with packed weights: one GEMM for each matrix of a batch (one for all when their
// rows are evenly spaced), a GEMV for a single row.
#include "engine/ops/bind.h"

namespace gestus {
namespace {

class LinearOp final : public BoundOp {
 public:
  explicit LinearOp(const Binding& b)
      : block_(b.kernels->gemm_block_n),
        scratch_(b.part_scratch),
        scratch_stride_(b.part_scratch_stride) {
    const kernels::ProductKernels* products = ProductsOf(*b.kernels, b.node->weight.dtype);
    gemm_ = products != nullptr ? products->gemm : b.kernels->f32_gemm;
    gemv_ = products != nullptr ? products->gemv : b.kernels->f32_gemv;
    const Ref& x = b.in[0];
    const Ref* residual = b.node->residual ? &b.in[1] : nullptr;
    const bool repeat = residual != nullptr && residual->rows * residual->batch == 1;
    const bool merge =
        x.tall() && b.out.tall() && (residual == nullptr || repeat || residual->tall());
    batch_ = merge ? 1 : x.batch;
    args_.m = merge ? x.batch * x.rows : x.rows;
    args_.n = b.out.cols;
    args_.k = x.cols;
    args_.out = b.out.f32;
    args_.out_stride = b.out.row_stride;
    args_.a = x.f32;
    args_.a_stride = x.row_stride;
    args_.packed = b.packed;
    args_.epilogue.bias = b.node->bias.f32();
    args_.epilogue.act = b.node->act;
    args_.epilogue.alpha = b.node->alpha;
    if (residual != nullptr) {
      args_.epilogue.residual = residual->f32;
      args_.epilogue.residual_stride = repeat ? 0 : residual->row_stride;
      residual_batch_stride_ = repeat ? 0 : residual->batch_stride;
    }
    a_batch_stride_ = x.batch_stride;
    out_batch_stride_ = b.out.batch_stride;
  }

  void Run(const Part& part) const noexcept override {
    for (std::size_t i = 0; i < batch_; ++i) {
      const auto b = static_cast<std::ptrdiff_t>(i);
      kernels::GemmArgs args = args_;
      args.scratch = scratch_ + static_cast<std::size_t>(part.index) * scratch_stride_;
      args.a += b * a_batch_stride_;
      args.out += b * out_batch_stride_;
      if (args.epilogue.residual != nullptr) args.epilogue.residual += b * residual_batch_stride_;
      RunOne(args, part);
    }
  }

 private:
  // Wide outputs are divided by columns, so that each part streams its own weights; tall and
  // narrow ones by rows.
  void RunOne(kernels::GemmArgs args, const Part& part) const {
    const auto count = static_cast<std::size_t>(part.count);
    const std::size_t panels = (args.n + block_ - 1) / block_;
    if (panels >= 2 * count || args.m < 8 * count) {
      const Part::Range cols = part.Of(args.n, block_);
      if (cols.empty()) return;
      args.n_begin = cols.begin;
      args.n_end = cols.end;
      (args.m == 1 ? gemv_ : gemm_)(args);
      return;
    }
    const Part::Range rows = part.Of(args.m);
    if (rows.empty()) return;
    const auto first = static_cast<std::ptrdiff_t>(rows.begin);
    args.m = rows.end - rows.begin;
    args.a += first * args.a_stride;
    args.out += first * args.out_stride;
    if (args.epilogue.residual != nullptr)
      args.epilogue.residual += first * args.epilogue.residual_stride;
    args.n_begin = 0;
    args.n_end = args.n;
    gemm_(args);
  }

  void (*gemm_)(const kernels::GemmArgs& args);
  void (*gemv_)(const kernels::GemmArgs& args);
  std::size_t block_;
  float* scratch_;
  std::size_t scratch_stride_;
  std::size_t batch_;
  kernels::GemmArgs args_;
  std::ptrdiff_t a_batch_stride_ = 0, out_batch_stride_ = 0, residual_batch_stride_ = 0;
};

}  // namespace

std::unique_ptr<BoundOp> BindLinear(const Binding& b) { return std::make_unique<LinearOp>(b); }

}  // namespace gestus
