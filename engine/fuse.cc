// Fusion by pattern: each rewrite looks at one node and the producers of its inputs.
#include "engine/fuse.h"

#include <cstddef>

namespace gestus {
namespace {

std::size_t Index(int id) { return static_cast<std::size_t>(id); }

void Remove(const std::vector<bool>& dead, FusibleGraph g) {
  std::vector<Node> kept;
  std::vector<std::size_t> moved(g.nodes.size() + 1);
  for (std::size_t i = 0; i < g.nodes.size(); ++i) {
    moved[i] = kept.size();
    if (!dead[i]) kept.push_back(std::move(g.nodes[i]));
  }
  moved[g.nodes.size()] = kept.size();
  for (Loop& loop : g.loops) {
    loop.begin = moved[loop.begin];
    loop.end = moved[loop.end];
  }
  g.nodes = std::move(kept);
}

class Fuser {
 public:
  explicit Fuser(FusibleGraph g) : g_(g), dead_(g.nodes.size(), false) {
    uses_.assign(g.values.size(), 0);
    producer_.assign(g.values.size(), -1);
    for (std::size_t i = 0; i < g.nodes.size(); ++i) {
      for (int in : g.nodes[i].inputs) ++uses_[Index(in)];
      if (g.nodes[i].output >= 0) producer_[Index(g.nodes[i].output)] = static_cast<int>(i);
    }
    for (const ValueInfo& v : g.values) {
      if (v.base >= 0) ++uses_[Index(v.base)];
    }
    for (const NamedValue& out : g.outputs) uses_[Index(out.id)] += 2;  // never fused away
  }

  void Run() {
    for (std::size_t i = 0; i < g_.nodes.size(); ++i) {
      if (g_.nodes[i].op == Op::kActivate) FuseActivation(i);
      if (g_.nodes[i].op == Op::kAdd) FuseResidual(i);
    }
    // The outer of two concatenations first: the inner one's parts then get the outer's strides.
    for (std::size_t i = g_.nodes.size(); i-- > 0;) {
      const Op op = g_.nodes[i].op;
      if (op == Op::kConcat || op == Op::kConcatRows) dead_[i] = PlaceParts(g_.nodes[i]);
    }
    Remove(dead_, g_);
  }

 private:
  /// The node that makes value `id` for node `user` alone, in the same loop; or -1.
  int SoleProducer(int id, const Node& user) const {
    const int p = producer_[Index(id)];
    if (p < 0 || uses_[Index(id)] != 1) return -1;
    return g_.nodes[Index(p)].loop == user.loop ? p : -1;
  }

  /// A product that `user` alone consumes and that still ends without activation and residual.
  int PlainLinear(int id, const Node& user) const {
    const int p = SoleProducer(id, user);
    if (p < 0) return -1;
    const Node& n = g_.nodes[Index(p)];
    return n.op == Op::kLinear && n.act == Activation::kNone && !n.residual ? p : -1;
  }

  bool ReadsBuffer(const Node& node) const {
    for (int in : node.inputs) {
      const int base = g_.values[Index(in)].base;
      if (g_.values[Index(base < 0 ? in : base)].buffer) return true;
    }
    return false;
  }

  void FuseActivation(std::size_t i) {
    Node& act = g_.nodes[i];
    const int p = PlainLinear(act.inputs[0], act);
    if (p < 0) return;
    Node& linear = g_.nodes[Index(p)];
    linear.act = act.act;
    linear.alpha = act.alpha;
    linear.output = act.output;
    producer_[Index(act.output)] = p;
    dead_[i] = true;
  }

  void FuseResidual(std::size_t i) {
    // The product moves to the place of the sum, where the other operand exists already.
    for (std::size_t which : {std::size_t{1}, std::size_t{0}}) {
      Node& add = g_.nodes[i];
      const int product = add.inputs[which], other = add.inputs[1 - which];
      const int p = SoleProducer(product, add);
      if (p < 0 || g_.nodes[Index(p)].op != Op::kLinear || g_.nodes[Index(p)].residual) continue;
      if (ReadsBuffer(g_.nodes[Index(p)])) continue;  // a row may be stored in between
      if (!(g_.values[Index(product)].shape == g_.values[Index(add.output)].shape)) continue;
      Node linear = g_.nodes[Index(p)];
      linear.inputs.push_back(other);
      linear.residual = true;
      linear.output = add.output;
      dead_[Index(p)] = true;
      g_.nodes[i] = std::move(linear);
      return;
    }
  }

  /// Makes each part of a concatenation that nobody else needs a view of the whole, and leaves the
  /// others to be copied.  True when there is nothing to copy.
  bool PlaceParts(const Node& concat) {
    const ValueInfo whole = g_.values[Index(concat.output)];
    std::ptrdiff_t at = 0;
    bool all = true;
    for (int id : concat.inputs) {
      ValueInfo& part = g_.values[Index(id)];
      const std::ptrdiff_t step =
          concat.op == Op::kConcat ? part.shape.Cols() : part.shape.Rows() * whole.row_stride;
      const bool movable = part.base < 0 && part.constant == nullptr && !part.input &&
                           !part.buffer && SoleProducer(id, concat) >= 0;
      if (movable) {
        part.base = concat.output;
        part.offset = at;
        part.row_stride = whole.row_stride;
        part.batch_stride = whole.batch_stride;
      }
      all = all && movable;
      at += step;
    }
    return all;
  }

  FusibleGraph g_;
  std::vector<bool> dead_;
  std::vector<int> uses_, producer_;
};

}  // namespace

void DropUnused(FusibleGraph g) {
  const auto root = [&](int id) {
    while (g.values[Index(id)].base >= 0) id = g.values[Index(id)].base;
    return Index(id);
  };
  std::vector<bool> needed(g.values.size(), false), dead(g.nodes.size(), true);
  for (const NamedValue& out : g.outputs) needed[root(out.id)] = true;
  // A loop may read at its top what it makes at its bottom, hence until nothing changes.
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = g.nodes.size(); i-- > 0;) {
      if (!dead[i] || !needed[root(g.nodes[i].output)]) continue;
      dead[i] = false;
      changed = true;
      for (int in : g.nodes[i].inputs) needed[root(in)] = true;
    }
  }
  Remove(dead, g);
}

void Fuse(FusibleGraph g) { Fuser(g).Run(); }

}  // namespace gestus
