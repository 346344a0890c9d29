// Binds a plan to memory and walks its list of ops.
#include "engine/session.h"

#include <chrono>

#include "engine/aligned_buffer.h"
#include "engine/denormals.h"
#include "engine/ops/ops.h"
#include "engine/plan.h"
#include "engine/thread_pool.h"

namespace gestus {
struct Session::Impl {
  AlignedBuffer arena, scratch;
  std::vector<std::unique_ptr<BoundOp>> ops;
  std::vector<OpProfile> profile;
  std::shared_ptr<ThreadPool> pool;  // null with one thread

  std::byte* AddressOf(const Plan& plan, int id) const;
  Ref RefOf(const Plan& plan, int id) const;
  void BindOps(const Plan& plan);
  template <class Runner>
  void Walk(const Plan& plan, Runner run_op) const noexcept;
  void RunOp(std::size_t op, std::int32_t step, Crew& crew) const noexcept;
  void RunTimed(const Plan& plan, std::size_t op, std::int32_t step, Crew& crew) noexcept;
};

std::byte* Session::Impl::AddressOf(const Plan& plan, int id) const {
  // Offsets add up from view to view; only the root has a place of its own.
  std::ptrdiff_t elements = 0;
  for (int at = id;; at = plan.values()[static_cast<std::size_t>(at)].base) {
    const ValueInfo& v = plan.values()[static_cast<std::size_t>(at)];
    elements += v.offset;
    if (v.base >= 0) continue;
    const auto* constant = static_cast<const std::byte*>(v.constant);
    std::byte* root = constant != nullptr
                          ? const_cast<std::byte*>(constant)
                          : arena.data() + plan.storage()[static_cast<std::size_t>(at)].offset;
    return root + elements * static_cast<std::ptrdiff_t>(SizeOf(v.dtype));
  }
}

Ref Session::Impl::RefOf(const Plan& plan, int id) const {
  const ValueInfo& v = plan.values()[static_cast<std::size_t>(id)];
  Ref ref;
  ref.f32 = reinterpret_cast<float*>(AddressOf(plan, id));
  const int rank = v.shape.rank();
  ref.batch = rank == 3 ? static_cast<std::size_t>(v.shape[0]) : 1;
  ref.rows = rank >= 2 ? static_cast<std::size_t>(v.shape[rank - 2]) : 1;
  ref.cols = static_cast<std::size_t>(v.shape.Cols());
  ref.row_stride = v.row_stride;
  ref.batch_stride = v.batch_stride;
  return ref;
}

void Session::Impl::BindOps(const Plan& plan) {
  for (const Plan::Step& step : plan.steps()) {
    Binding b;
    b.kernels = &plan.kernels();
    b.node = &step.node;
    for (int in : step.node.inputs) b.in.push_back(RefOf(plan, in));
    b.out = RefOf(plan, step.node.output);
    b.packed = step.packed.get();
    b.shared_scratch = reinterpret_cast<float*>(arena.data() + step.scratch_offset);
    b.part_scratch = scratch.f32();
    b.part_scratch_stride = plan.part_bytes() / sizeof(float);
    ops.push_back(Bind(b));
  }
}

template <class Runner>
void Session::Impl::Walk(const Plan& plan, Runner run_op) const noexcept {
  std::size_t next_loop = 0;
  for (std::size_t i = 0; i < ops.size();) {
    const bool loops = next_loop < plan.loops().size() && plan.loops()[next_loop].begin == i;
    const std::size_t end = loops ? plan.loops()[next_loop].end : i + 1;
    const std::int64_t count = loops ? plan.loops()[next_loop].count : 1;
    for (std::int32_t step = 0; step < count; ++step) {
      for (std::size_t op = i; op < end; ++op) run_op(op, step);
    }
    if (loops) ++next_loop;
    i = end;
  }
}

void Session::Impl::RunOp(std::size_t op, std::int32_t step, Crew& crew) const noexcept {
  const BoundOp& bound = *ops[op];
  const std::size_t phases = bound.phases();
  for (std::size_t phase = 0; phase < phases; ++phase) {
    crew.Phase([&](int index, int count) { bound.Run({index, count, step, phase}); });
  }
}

void Session::Impl::RunTimed(const Plan& plan, std::size_t op, std::int32_t step,
                             Crew& crew) noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  RunOp(op, step, crew);
  if (crew.thread() != 0) return;
  OpProfile& p = profile[op];
  p.seconds += std::chrono::duration<double>(Clock::now() - begin).count();
  p.flops += plan.steps()[op].cost.flops;
  p.bytes += plan.steps()[op].cost.bytes;
  ++p.runs;
}

Session::Session(std::shared_ptr<const Plan> plan)
    : plan_(std::move(plan)), impl_(std::make_unique<Impl>()) {}
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::Create(std::shared_ptr<const Plan> plan,
                                                 const SessionOptions& options) {
  if (options.threads < 1 || options.threads > kMaxThreads)
    return Status(Code::kInvalidArgument, "threads: " + std::to_string(options.threads) +
                                              ", expected 1 to " + std::to_string(kMaxThreads));
  std::unique_ptr<Session> session(new Session(std::move(plan)));
  const Plan& p = *session->plan_;
  Impl& impl = *session->impl_;
  const bool alone = p.flops() < options.least_shared_flops;
  const auto threads = static_cast<std::size_t>(alone ? 1 : options.threads);
  impl.arena = AlignedBuffer(p.arena_bytes());
  impl.scratch = AlignedBuffer(p.part_bytes() * threads);
  if (impl.arena.data() == nullptr || impl.scratch.data() == nullptr)
    return Status(Code::kResourceExhausted,
                  "session: no memory for " +
                      std::to_string(p.arena_bytes() + p.part_bytes() * threads) + " bytes");
  if (options.threads > 1 && (!alone || options.pool != nullptr)) {
    auto pool =
        options.pool != nullptr ? options.pool : std::make_shared<ThreadPool>(options.threads);
    if (!pool->complete() || pool->threads() != options.threads)
      return Status(Code::kResourceExhausted,
                    "session: " + std::to_string(options.threads) + " threads are not to be had");
    if (!alone) impl.pool = std::move(pool);
  }
  impl.BindOps(p);
  if (options.profile) {
    for (const Plan::Step& step : p.steps())
      impl.profile.push_back({step.node.scope + " " + NameWithType(step.node), 0, 0, 0, 0});
  }
  return session;
}

namespace {

int FindId(const std::vector<NamedValue>& list, std::string_view name) {
  for (const NamedValue& v : list) {
    if (v.name == name) return v.id;
  }
  return -1;
}

}  // namespace

ValueView Session::Input(std::string_view name) const {
  const int id = FindId(plan_->inputs(), name);
  if (id < 0) return {};
  const Ref ref = impl_->RefOf(*plan_, id);
  return {ref.f32, reinterpret_cast<std::int32_t*>(ref.f32),
          plan_->values()[static_cast<std::size_t>(id)].shape, ref.row_stride};
}

ValueView Session::Output(std::string_view name) const {
  const int id = FindId(plan_->outputs(), name);
  if (id < 0) return {};
  const Ref ref = impl_->RefOf(*plan_, id);
  return {ref.f32, reinterpret_cast<std::int32_t*>(ref.f32),
          plan_->values()[static_cast<std::size_t>(id)].shape, ref.row_stride};
}

int Session::threads() const { return impl_->pool != nullptr ? impl_->pool->threads() : 1; }

void Session::Run() noexcept {
  const auto task = [](void* self, Crew crew) {
    const auto& session = *static_cast<Session*>(self);
    const Plan& plan = *session.plan_;
    Impl& impl = *session.impl_;
    const FlushDenormals flush;
    if (impl.profile.empty())
      impl.Walk(plan, [&](std::size_t op, std::int32_t step) { impl.RunOp(op, step, crew); });
    else
      impl.Walk(plan,
                [&](std::size_t op, std::int32_t step) { impl.RunTimed(plan, op, step, crew); });
  };
  if (impl_->pool == nullptr)
    task(this, Crew{});
  else
    impl_->pool->Run(task, this);
}

std::uint64_t Session::arena_bytes() const { return impl_->arena.size() + impl_->scratch.size(); }

std::vector<OpProfile> Session::Profile() const { return impl_->profile; }

void Session::ResetProfile() {
  for (OpProfile& op : impl_->profile) op.runs = 0, op.seconds = op.flops = op.bytes = 0;
}

}  // namespace gestus
