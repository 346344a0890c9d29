// Segments of several agents in one run: does AST's encoder take less time for each of B segments
// when its products have 62 B rows?
//
//   gestus_batch AST.fb THREADS ROUNDS
//
// Runs the blocks of AST, from the tokens on, for B = 1, 2, 4 and 8 in turns and prints one line of
// JSON: the median milliseconds of a segment for each B.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "engine/plan.h"
#include "engine/session.h"
#include "models/ast/ast.h"
#include "weights_generated.h"

namespace gestus::bench {
namespace {

constexpr std::int64_t kBatches[] = {1, 2, 4, 8};

/// x (B, N, D) through all blocks, each of which computes every row.
Graph Encoder(const models::AstConfig& c, const models::AstWeights& w, std::int64_t batch) {
  Graph g;
  const std::int64_t n = 2 + c.Patches(), d = c.d_model;
  Value x = g.Input("x", {batch, n, d});
  for (const models::AstWeights::Block& block : w.blocks) {
    const Value qkv = g.Linear(g.LayerNorm(x, block.norm1), block.qkv);
    const Value att = g.Attention(g.Columns(qkv, 0, d), g.Columns(qkv, d, d),
                                  g.Columns(qkv, 2 * d, d), {.heads = static_cast<int>(c.heads)});
    x = g.Add(x, g.Linear(att, block.proj));
    const Value hidden = g.Linear(g.LayerNorm(x, block.norm2), block.fc1, Activation::kGeluErf);
    x = g.Add(x, g.Linear(hidden, block.fc2));
  }
  g.Output("y", x);
  return g;
}

Result<std::vector<std::unique_ptr<Session>>> MakeSessions(const std::string& path, int threads) {
  auto file = WeightsFile::Open(path, {.residence = Residence::kCopied});
  if (!file.ok()) return file.status();
  const fb::Network* record = (*file)->FindNetwork("");
  if (record == nullptr || record->config_as_AstConfig() == nullptr)
    return Status(Code::kBadWeights, path + ": no AST");
  const auto config = models::ReadAstConfig(*record->config_as_AstConfig(), "ast");
  if (!config.ok()) return config.status();
  Binder binder(**file, record->prefix()->str());
  models::AstWeights weights;
  models::BindAst(binder, *config, &weights);
  if (!binder.status().ok()) return binder.status();
  WeightCache cache(kernels::BestTable(), *file);
  std::vector<std::unique_ptr<Session>> sessions;
  for (const std::int64_t batch : kBatches) {
    auto plan = Plan::Make(Encoder(*config, weights, batch), cache);
    if (!plan.ok()) return plan.status();
    auto session = Session::Create(*plan, {.threads = threads});
    if (!session.ok()) return session.status();
    const ValueView x = (*session)->Input("x");
    for (std::int64_t i = 0; i < x.shape.NumElements(); ++i)
      x.f32[i] = static_cast<float>(i % 31) * 0.1f - 1.5f;
    sessions.push_back(*std::move(session));
  }
  return sessions;
}

Status Measure(const std::string& path, int threads, int rounds) {
  auto sessions = MakeSessions(path, threads);
  if (!sessions.ok()) return sessions.status();
  std::vector<std::vector<double>> times(sessions->size());
  for (int round = -1; round < rounds; ++round) {  // the first warms up
    for (std::size_t i = 0; i < sessions->size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      (*sessions)[i]->Run();
      const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - begin;
      if (round >= 0) times[i].push_back(ms.count() / static_cast<double>(kBatches[i]));
    }
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto middle = times[i].begin() + static_cast<std::ptrdiff_t>(times[i].size() / 2);
    std::nth_element(times[i].begin(), middle, times[i].end());
    std::printf("%s\"%d\": %.3f", i == 0 ? "{" : ", ", static_cast<int>(kBatches[i]), *middle);
  }
  std::printf("}\n");
  return {};
}

}  // namespace
}  // namespace gestus::bench

int main(int argc, char** argv) {
  const int threads = argc == 4 ? std::atoi(argv[2]) : 0,
            rounds = argc == 4 ? std::atoi(argv[3]) : 0;
  if (threads < 1 || rounds < 1) {
    std::fprintf(stderr, "usage: gestus_batch AST.fb THREADS ROUNDS\n");
    return 2;
  }
  const gestus::Status status = gestus::bench::Measure(argv[1], threads, rounds);
  if (status.ok()) return 0;
  std::fprintf(stderr, "gestus_batch: %s\n", status.message().c_str());
  return 1;
}
