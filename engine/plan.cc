// Fusion, packing, lifetimes and the arena.
#include "engine/plan.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <limits>

#include "engine/fuse.h"
#include "engine/graph_shapes.h"
#include "engine/ops/ops.h"

namespace gestus {
namespace {

std::size_t Index(int id) { return static_cast<std::size_t>(id); }

std::uint64_t Aligned(std::uint64_t bytes) {
  return (bytes + kBufferAlign - 1) / kBufferAlign * kBufferAlign;
}

/// A value whose only job is to be found by name: taps become outputs.
std::vector<NamedValue> WantedOutputs(const Graph& graph, bool taps) {
  std::vector<NamedValue> outputs = graph.outputs();
  if (taps) {
    for (const NamedValue& tap : graph.taps()) outputs.push_back({"tap/" + tap.name, tap.id});
  }
  return outputs;
}

std::vector<WeightCache::Request> ToPack(const std::vector<Node>& nodes) {
  std::vector<WeightCache::Request> requests;
  for (const Node& node : nodes) {
    if (NeedsPacking(node)) requests.push_back({node.weight, node.layout});
  }
  return requests;
}

/// Tensors that sessions read where they lie.
std::vector<TensorView> ReadInPlace(const std::vector<Node>& nodes,
                                    const std::vector<ValueInfo>& values) {
  std::vector<TensorView> views;
  for (const Node& node : nodes) {
    if (!NeedsPacking(node)) views.push_back(node.weight);
    views.push_back(node.bias);
  }
  for (const ValueInfo& value : values) {
    if (value.constant != nullptr)
      views.push_back({value.dtype, value.shape, value.constant, nullptr});
  }
  return views;
}

// Rows this many bytes apart fall into few sets of an L1 cache, or into one.
constexpr std::int64_t kCrowdedRows = 2048;
constexpr std::ptrdiff_t kRowGap = kBufferAlign / sizeof(float);

/// Moves the rows of values apart that only pass from product to product, where their distance
/// would crowd the rows of a tile into the same sets of the cache.  What is seen from outside, or
/// by views, keeps its layout.
void SpreadRows(const std::vector<Node>& nodes, const std::vector<NamedValue>& outputs,
                std::vector<ValueInfo>& values) {
  std::vector<bool> inner(values.size(), false);
  for (const Node& node : nodes) inner[Index(node.output)] = node.op == Op::kLinear;
  for (const Node& node : nodes) {
    for (const int in : node.inputs) {
      if (node.op != Op::kLinear) inner[Index(in)] = false;
    }
  }
  for (const ValueInfo& v : values) {
    if (v.base >= 0) inner[Index(v.base)] = false;
  }
  for (const NamedValue& output : outputs) inner[Index(output.id)] = false;
  for (std::size_t id = 0; id < values.size(); ++id) {
    ValueInfo& v = values[id];
    const std::int64_t bytes = v.shape.Cols() * static_cast<std::int64_t>(SizeOf(v.dtype));
    if (!inner[id] || v.base >= 0 || v.buffer || bytes % kCrowdedRows != 0) continue;
    v.row_stride += kRowGap;
    v.batch_stride = v.row_stride * RowsOf(v.shape);
  }
}

}  // namespace

int Plan::Root(int id) const {
  while (values_[Index(id)].base >= 0) id = values_[Index(id)].base;
  return id;
}

Result<std::shared_ptr<const Plan>> Plan::Make(Graph graph, WeightCache& weights,
                                               const PlanOptions& options) {
  if (!graph.status().ok()) return graph.status();
  std::shared_ptr<Plan> plan(new Plan);
  plan->kernels_ = &weights.kernels();
  plan->file_ = weights.file();
  plan->inputs_ = graph.inputs();
  plan->outputs_ = WantedOutputs(graph, options.taps);
  plan->values_ = graph.values();
  plan->loops_ = graph.loops();
  plan->owned_ = graph.owned();
  std::vector<Node> nodes = graph.nodes();
  const FusibleGraph rewritten{nodes, plan->values_, plan->loops_, plan->outputs_};
  DropUnused(rewritten);
  if (options.fuse) Fuse(rewritten);
  SpreadRows(nodes, plan->outputs_, plan->values_);

  auto packed = weights.Pack(ToPack(nodes), ReadInPlace(nodes, plan->values_));
  if (!packed.ok()) return packed.status();
  auto next = packed->begin();
  plan->steps_.reserve(nodes.size());
  for (Node& node : nodes) {
    Step step;
    step.node = std::move(node);
    if (NeedsPacking(step.node)) step.packed = *next++;
    step.cost = CostOf(step.node, plan->values_);
    plan->part_bytes_ = std::max<std::uint64_t>(
        plan->part_bytes_,
        Aligned(PartScratch(step.node, plan->values_, *plan->kernels_) * sizeof(float)));
    plan->steps_.push_back(std::move(step));
  }
  plan->FindLifetimes();
  GESTUS_RETURN_IF_ERROR(plan->PlaceInArena(options.max_arena_bytes));
  return std::shared_ptr<const Plan>(std::move(plan));
}

void Plan::FindLifetimes() {
  const int end = static_cast<int>(steps_.size());
  storage_.resize(values_.size());
  for (Storage& s : storage_) {
    s.first = end;
    s.last = -1;
  }
  const auto touch = [&](int id, int at) {
    Storage& s = storage_[Index(Root(id))];
    s.first = std::min(s.first, at);
    s.last = std::max(s.last, at);
  };
  for (int i = 0; i < end; ++i) {
    for (int in : steps_[Index(i)].node.inputs) touch(in, i);
    touch(steps_[Index(i)].node.output, i);
  }
  // Inputs may be written once and run often, outputs are read after the run.
  for (const NamedValue& in : inputs_) {
    touch(in.id, 0);
    touch(in.id, end);
  }
  for (const NamedValue& out : outputs_) touch(out.id, end);
  // What exists before a loop is needed in each of its steps; so are buffers.
  for (const Loop& loop : loops_) {
    const int begin = static_cast<int>(loop.begin), last = static_cast<int>(loop.end) - 1;
    for (std::size_t id = 0; id < values_.size(); ++id) {
      Storage& s = storage_[id];
      const bool inside = s.first <= last && s.last >= begin;
      if (!inside || !(s.first < begin || values_[id].buffer)) continue;
      s.first = std::min(s.first, begin);
      s.last = std::max(s.last, last);
    }
  }
}

Status Plan::PlaceInArena(std::uint64_t max_bytes) {
  struct Item {
    std::uint64_t bytes;
    int first, last;
    std::uint64_t* offset;
  };
  std::vector<Item> items;
  for (std::size_t id = 0; id < values_.size(); ++id) {
    Storage& s = storage_[id];
    const ValueInfo& v = values_[id];
    if (v.base >= 0 || v.constant != nullptr || s.last < 0) continue;
    s.in_arena = true;
    const std::int64_t elements = v.batch_stride * BatchOf(v.shape);
    s.bytes = Aligned(static_cast<std::uint64_t>(elements) * SizeOf(v.dtype));
    items.push_back({s.bytes, s.first, s.last, &s.offset});
  }
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const std::size_t floats = SharedScratch(steps_[i].node, values_);
    if (floats == 0) continue;
    const int at = static_cast<int>(i);
    items.push_back({Aligned(floats * sizeof(float)), at, at, &steps_[i].scratch_offset});
  }
  std::vector<std::uint64_t> change(steps_.size() + 2);  // of the bytes in use, at each step
  for (const Item& item : items) {
    change[Index(item.first)] += item.bytes;
    change[Index(item.last) + 1] -= item.bytes;
  }
  std::uint64_t live = 0;
  for (const std::uint64_t bytes : change) live_bytes_ = std::max(live_bytes_, live += bytes);
  // Largest first, each at the lowest place that is free for its whole life.
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.bytes > b.bytes; });
  std::vector<const Item*> placed;  // by offset
  for (const Item& item : items) {
    std::uint64_t at = 0;
    for (const Item* other : placed) {
      const bool meet = other->first <= item.last && item.first <= other->last;
      if (!meet) continue;
      if (at + item.bytes <= *other->offset) break;
      at = std::max(at, *other->offset + other->bytes);
    }
    if (item.bytes > max_bytes || at > max_bytes - item.bytes)
      return Status(Code::kResourceExhausted, "activations need more than " +
                                                  std::to_string(max_bytes) +
                                                  " bytes, the limit that was set");
    *item.offset = at;
    arena_bytes_ = std::max(arena_bytes_, at + item.bytes);
    placed.insert(
        std::upper_bound(placed.begin(), placed.end(), &item,
                         [](const Item* a, const Item* b) { return *a->offset < *b->offset; }),
        &item);
  }
  return {};
}

double Plan::flops() const {
  double sum = 0;
  for (const Step& step : steps_) {
    const int loop = step.node.loop;
    sum += step.cost.flops * (loop >= 0 ? static_cast<double>(loops_[Index(loop)].count) : 1.0);
  }
  return sum;
}

std::string Plan::ToString() const {
  std::string text;
  char line[256];
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Node& n = steps_[i].node;
    std::string what = NameWithType(n);
    if (n.op == Op::kLinear && n.bias.data != nullptr) what += "+bias";
    if (n.act != Activation::kNone && n.op == Op::kLinear) what += "+act";
    if (n.residual) what += "+residual";
    const int root = Root(n.output);
    const Storage& s = storage_[Index(root)];
    std::snprintf(line, sizeof line, "%4zu  %-28s %-24s %-16s at %10" PRIu64 "  %10.3f MFLOP%s\n",
                  i, n.scope.c_str(), what.c_str(),
                  values_[Index(n.output)].shape.ToString().c_str(), s.offset,
                  steps_[i].cost.flops * 1e-6, n.loop >= 0 ? "  x loop" : "");
    text += line;
  }
  std::uint64_t sum = 0;
  for (const Storage& s : storage_) sum += s.in_arena ? s.bytes : 0;
  std::snprintf(
      line, sizeof line,
      "      %zu ops, %.3f GFLOP, arena %.2f MiB (at once %.2f, values %.2f MiB), scratch "
      "%.2f MiB a thread\n",
      steps_.size(), flops() * 1e-9, static_cast<double>(arena_bytes_) / 1048576.0,
      static_cast<double>(live_bytes_) / 1048576.0, static_cast<double>(sum) / 1048576.0,
      static_cast<double>(part_bytes_) / 1048576.0);
  return text + line;
}

}  // namespace gestus
