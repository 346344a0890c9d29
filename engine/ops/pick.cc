// Choosing a token: the largest logit, or a draw from the softmax.  Rows are short and a draw is
// sequential, so part 0 does it alone.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/ops/bind.h"

namespace gestus {
namespace {

class PickOp final : public BoundOp {
 public:
  explicit PickOp(const Binding& b)
      : logits_(b.in[0].f32),
        size_(b.in[0].cols),
        controls_(b.in[1].f32),
        u_(b.in[2].f32),
        ordered_(b.shared_scratch),
        out_(reinterpret_cast<std::int32_t*>(b.out.f32)) {}

  void Run(const Part& part) const noexcept override {
    if (part.index != 0) return;
    *out_ = !Comparable()      ? -1
            : controls_[0] > 0 ? static_cast<std::int32_t>(Draw())
                               : static_cast<std::int32_t>(Largest());
  }

 private:
  /// False for NaN, which must not reach a comparison that orders, and for +inf, whose softmax is
  /// NaN.
  bool Comparable() const {
    return std::all_of(logits_, logits_ + size_,
                       [](float x) { return x < std::numeric_limits<float>::infinity(); });
  }

  std::size_t Largest() const {
    return static_cast<std::size_t>(std::max_element(logits_, logits_ + size_) - logits_);
  }

  std::size_t Draw() const {
    std::copy_n(logits_, size_, ordered_);
    const float top_k = controls_[1];
    const bool all = !(top_k >= 1 && top_k < static_cast<float>(size_));
    const std::size_t kept = all ? size_ : static_cast<std::size_t>(top_k);
    std::nth_element(ordered_, ordered_ + (kept - 1), ordered_ + size_, std::greater<>());
    const float least = ordered_[kept - 1];
    const float most = *std::max_element(ordered_, ordered_ + kept);
    // Of the logits that equal the least one kept, those with the lowest index stay.
    const auto equals = static_cast<std::size_t>(std::count(ordered_, ordered_ + kept, least));

    const auto walk = [&](double enough) {
      double sum = 0;
      std::size_t ties = 0, last = 0;
      for (std::size_t i = 0; i < size_; ++i) {
        if (!(logits_[i] > least || (logits_[i] == least && ties++ < equals))) continue;
        sum += std::exp((double{logits_[i]} - double{most}) / double{controls_[0]});
        last = i;
        if (sum > enough) break;
      }
      return std::pair(sum, last);
    };
    const double total = walk(std::numeric_limits<double>::infinity()).first;
    return walk(double{*u_} * total).second;
  }

  const float* logits_;
  std::size_t size_;
  const float *controls_, *u_;
  float* ordered_;
  std::int32_t* out_;
};

}  // namespace

std::unique_ptr<BoundOp> BindPick(const Binding& b) { return std::make_unique<PickOp>(b); }

}  // namespace gestus
