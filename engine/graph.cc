// Declaring values: inputs, constants, views, loops, outputs.  The ops are in graph_ops.cc.
#include "engine/graph.h"

#include "engine/graph_shapes.h"

namespace gestus {

Graph::Scope::Scope(Graph& g, const std::string& name) : g_(g), length_(g.scope_.size()) {
  if (!g.scope_.empty()) g.scope_ += '/';
  g.scope_ += name;
}

void Graph::Fail(const std::string& message) {
  if (!status_.ok()) return;
  status_ = Status(Code::kBadWeights, scope_.empty() ? message : scope_ + ": " + message);
}

bool Graph::Expect(bool holds, const std::string& message) {
  if (!holds) Fail(message);
  return status_.ok();
}

const Shape& Graph::shape(Value x) const {
  static const Shape kNone;
  return status_.ok() && Exists(x) ? info(x).shape : kNone;
}

bool Graph::Bad(Value x) { return !Expect(Exists(x), "a value is used that was never made"); }

bool Graph::GoodShape(const char* op, const Shape& shape) {
  bool good = shape.rank() <= 3;
  for (int i = 0; i < shape.rank(); ++i) good = good && shape[i] > 0;
  return Expect(good, std::string(op) + ": shape " + shape.ToString() +
                          ", expected up to three dimensions of at least 1");
}

Value Graph::NewValue(Shape shape, DType dtype) {
  ValueInfo v;
  v.dtype = dtype;
  v.shape = shape;
  v.row_stride = shape.Cols();
  v.batch_stride = shape.Cols() * RowsOf(shape);
  values_.push_back(v);
  return Value{static_cast<int>(values_.size()) - 1};
}

Value Graph::View(Value x, Shape shape, std::ptrdiff_t offset, std::ptrdiff_t row_stride,
                  std::ptrdiff_t batch_stride) {
  ValueInfo v = info(x);
  v.base = v.base < 0 ? x.id : v.base;
  v.offset += offset;
  v.shape = shape;
  v.row_stride = row_stride;
  v.batch_stride = batch_stride;
  v.input = v.buffer = false;
  values_.push_back(v);
  return Value{static_cast<int>(values_.size()) - 1};
}

Node Graph::NewNode(Op op, std::vector<int> inputs) const {
  Node node{};
  node.op = op;
  node.inputs = std::move(inputs);
  node.scope = scope_;
  node.loop = loop_;
  return node;
}

Value Graph::Emit(Node node, Shape shape, DType dtype) {
  for (std::size_t i = 0; i < node.inputs.size(); ++i) {
    const DType found = info({node.inputs[i]}).dtype;
    // Ids are looked up; rows are moved as what they are.
    const DType wanted =
        node.op == Op::kGather ? DType::kI32
        : node.op == Op::kPreviousRow || node.op == Op::kLastRows || node.op == Op::kStoreRows
            ? dtype
            : DType::kF32;
    if (!Expect(found == wanted, std::string(gestus::Name(node.op)) + ": input is " +
                                     gestus::Name(found) + ", expected " + gestus::Name(wanted)))
      return {};
  }
  if (!Expect(nodes_.size() < kMaxNodes,
              "more than " + std::to_string(kMaxNodes) + " ops, expected a smaller network"))
    return {};
  // An op that changes a buffer in place has its output already.
  if (node.output < 0) node.output = NewValue(shape, dtype).id;
  const Value out{node.output};
  nodes_.push_back(std::move(node));
  return out;
}

float* Graph::Own(std::size_t floats) {
  auto buffer = std::make_shared<AlignedBuffer>(floats * sizeof(float));
  if (buffer->data() == nullptr) {
    Fail("no memory for " + std::to_string(floats) + " constants");
    return nullptr;
  }
  owned_.push_back(buffer);
  return buffer->f32();
}

Value Graph::OwnedConstant(float* data, Shape shape) {
  if (data == nullptr) return {};
  return Constant(TensorView{DType::kF32, shape, data});
}

Value Graph::Input(const std::string& name, Shape shape, DType dtype) {
  if (!GoodShape("input", shape)) return {};
  const Value v = NewValue(shape, dtype);
  values_.back().input = true;
  inputs_.push_back({name, v.id});
  return v;
}

Value Graph::Constant(const TensorView& view) {
  if (!GoodShape("constant", view.shape)) return {};
  if (!Expect(view.dtype == DType::kF32 || view.dtype == DType::kI32,
              std::string("constant: ") + gestus::Name(view.dtype) + ", expected float32 or int32"))
    return {};
  const Value v = NewValue(view.shape, view.dtype);
  values_.back().constant = view.data;
  return v;
}

Value Graph::Zeros(Shape shape) {
  if (!GoodShape("zeros", shape)) return {};
  return OwnedConstant(Own(static_cast<std::size_t>(shape.NumElements())), shape);
}

Value Graph::Positions(std::int64_t length, std::int64_t d) {
  if (!GoodShape("positions", {length, d})) return {};
  float* data = Own(static_cast<std::size_t>(length * d));
  if (data != nullptr)
    kernels::sinusoidal_positions(data, static_cast<std::size_t>(length),
                                  static_cast<std::size_t>(d));
  return OwnedConstant(data, {length, d});
}

Value Graph::Rows(Value x, std::int64_t begin, std::int64_t count) {
  if (Bad(x)) return {};
  const ValueInfo v = info(x);
  if (!Expect(BatchOf(v.shape) == 1 && begin >= 0 && count > 0 && begin + count <= RowsOf(v.shape),
              "rows: " + std::to_string(begin) + " + " + std::to_string(count) + " of " +
                  v.shape.ToString()))
    return {};
  return View(x, {count, v.shape.Cols()}, begin * v.row_stride, v.row_stride, count * v.row_stride);
}

Value Graph::Columns(Value x, std::int64_t begin, std::int64_t count) {
  if (Bad(x)) return {};
  const ValueInfo v = info(x);
  if (!Expect(begin >= 0 && count > 0 && begin + count <= v.shape.Cols(),
              "columns: " + std::to_string(begin) + " + " + std::to_string(count) + " of " +
                  v.shape.ToString()))
    return {};
  return View(x, WithCols(v.shape, count), begin, v.row_stride, v.batch_stride);
}

Value Graph::Reshape(Value x, Shape to) {
  if (Bad(x)) return {};
  const ValueInfo v = info(x);
  const bool contiguous =
      (v.row_stride == v.shape.Cols() || RowsOf(v.shape) == 1) &&
      (BatchOf(v.shape) == 1 || v.batch_stride == v.shape.Cols() * RowsOf(v.shape));
  if (!GoodShape("reshape", to) ||
      !Expect(contiguous && to.NumElements() == v.shape.NumElements(),
              "reshape: " + v.shape.ToString() + " to " + to.ToString()))
    return {};
  return View(x, to, 0, to.Cols(), to.Cols() * RowsOf(to));
}

void Graph::BeginLoop(std::int64_t count) {
  if (!Expect(loop_ < 0 && count > 0, "loop: loops do not nest and run at least once")) return;
  loop_ = static_cast<int>(loops_.size());
  loops_.push_back({nodes_.size(), nodes_.size(), count});
}

void Graph::EndLoop() {
  if (!status_.ok() || !Expect(loop_ >= 0, "loop: ended before it began")) return;
  loops_[static_cast<std::size_t>(loop_)].end = nodes_.size();
  loop_ = -1;
}

Value Graph::Buffer(Shape shape, DType dtype) {
  if (!GoodShape("buffer", shape) || !Expect(loop_ < 0, "buffer: declare it before the loop"))
    return {};
  const Value v = NewValue(shape, dtype);
  values_.back().buffer = true;
  return v;
}

void Graph::Output(const std::string& name, Value x) {
  if (!Bad(x) && Expect(loop_ < 0, "output: declare it after the loop"))
    outputs_.push_back({name, x.id});
}

void Graph::Tap(const std::string& name, Value x) {
  if (!Bad(x)) taps_.push_back({scope_.empty() ? name : scope_ + '/' + name, x.id});
}

}  // namespace gestus
