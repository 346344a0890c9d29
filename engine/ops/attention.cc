// Multi-head attention: heads and blocks of query rows are independent work items.  The blocks do
// not depend on the number of threads, so neither do the results.
#include "engine/ops/bind.h"

namespace gestus {
namespace {

// Each block packs all keys and values once more, which 256 rows make small.
constexpr std::size_t kQueryBlock = 256;

bool UsesBf16(const Node& node, const kernels::KernelTable& kernels) {
  return node.narrow && kernels.bf16 != nullptr && kernels.bf16->attention != nullptr;
}

class AttentionOp final : public BoundOp {
 public:
  explicit AttentionOp(const Binding& b)
      : attention_(UsesBf16(*b.node, *b.kernels) ? b.kernels->bf16->attention
                                                 : b.kernels->f32_attention),
        q_(b.in[0]),
        k_(b.in[1]),
        v_(b.in[2]),
        out_(b.out),
        key_bias_(b.in.size() > 3 ? b.in[3].f32 : nullptr),
        heads_(static_cast<std::size_t>(b.node->heads)),
        scale_(b.node->scale),
        causal_(b.node->causal),
        by_step_(b.node->by_step),
        scratch_(b.part_scratch),
        scratch_stride_(b.part_scratch_stride) {}

  void Run(const Part& part) const noexcept override {
    const std::size_t blocks = (q_.rows + kQueryBlock - 1) / kQueryBlock;
    const Part::Range items = part.Of(q_.batch * heads_ * blocks);
    for (std::size_t i = items.begin; i < items.end; ++i) {
      RunItem(i / (heads_ * blocks), i / blocks % heads_, i % blocks * kQueryBlock, part);
    }
  }

 private:
  void RunItem(std::size_t batch, std::size_t head, std::size_t first, const Part& part) const {
    kernels::AttentionArgs args;
    args.head_dim = q_.cols / heads_;
    args.value_dim = v_.cols / heads_;
    args.rows = q_.rows - first < kQueryBlock ? q_.rows - first : kQueryBlock;
    args.keys = by_step_ ? static_cast<std::size_t>(part.step) + 1 : k_.rows;
    args.q = q_.at(batch, first) + head * args.head_dim;
    args.q_stride = q_.row_stride;
    args.k = k_.at(batch, 0) + head * args.head_dim;
    args.k_stride = k_.row_stride;
    args.v = v_.at(batch, 0) + head * args.value_dim;
    args.v_stride = v_.row_stride;
    args.out = out_.at(batch, first) + head * args.value_dim;
    args.out_stride = out_.row_stride;
    args.key_bias = key_bias_;
    args.scale = scale_;
    args.causal = causal_;
    args.first_row = first;
    args.scratch = scratch_ + static_cast<std::size_t>(part.index) * scratch_stride_;
    attention_(args);
  }

  void (*attention_)(const kernels::AttentionArgs&);
  Ref q_, k_, v_, out_;
  const float* key_bias_;
  std::size_t heads_;
  float scale_;
  bool causal_, by_step_;
  float* scratch_;
  std::size_t scratch_stride_;
};

}  // namespace

std::size_t AttentionScratch(const Node& node, const std::vector<ValueInfo>& values,
                             const kernels::KernelTable& kernels) {
  const auto shape = [&](std::size_t input) -> const Shape& {
    return values[static_cast<std::size_t>(node.inputs[input])].shape;
  };
  const Shape &q = shape(0), &k = shape(1), &v = shape(2);
  const auto rows = static_cast<std::size_t>(q[q.rank() - 2]);
  const auto scratch =
      UsesBf16(node, kernels) ? kernels.bf16->attention_scratch : kernels.f32_attention_scratch;
  return scratch(rows < kQueryBlock ? rows : kQueryBlock, static_cast<std::size_t>(k[k.rank() - 2]),
                 static_cast<std::size_t>(q.Cols() / node.heads),
                 static_cast<std::size_t>(v.Cols() / node.heads));
}

std::unique_ptr<BoundOp> BindAttention(const Binding& b) {
  return std::make_unique<AttentionOp>(b);
}

}  // namespace gestus
