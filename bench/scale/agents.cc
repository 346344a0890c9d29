// Agents of ZS-MSTM 1.0 with BERT, as a host of many speakers runs them: each has a session and a
// style of its own, and every 64 frames the words and the sound of one more segment.
//
//   gestus_agents busy|paced ZS_MSTM.fb BERT.fb AGENTS SEGMENTS WORKERS SEED
//
// `busy` runs SEGMENTS segments one after the other, each of another agent, so that an agent's own
// memory has left the caches when its turn comes; it prints the milliseconds of each.  `paced` runs
// in real time: an agent's segments arrive every 64 / 15 s from a random moment on and wait in line
// for their worker; it prints the milliseconds from arrival to completion of each.  Each of WORKERS
// threads, pinned to a processor of its own where there are as many, serves its share of agents.
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "engine/plan.h"
#include "engine/session.h"
#include "models/bert/bert.h"
#include "models/zs_mstm/zs_mstm.h"
#include "weights_generated.h"

namespace gestus::bench {
namespace {

// Words of 4.27 s: eleven, in fourteen pieces between [CLS] and [SEP].
constexpr std::int64_t kTokens = 16;

struct Options {
  bool paced = false;
  int agents = 0, segments = 0, workers = 0;
  unsigned seed = 0;
};

double Now() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

void SleepUntil(double time) {
  timespec until;
  until.tv_sec = static_cast<time_t>(time);
  until.tv_nsec = static_cast<long>((time - static_cast<double>(until.tv_sec)) * 1e9);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

Result<std::shared_ptr<const Plan>> PlanBert(const std::shared_ptr<const WeightsFile>& file) {
  const fb::Network* record = file->FindNetwork("");
  if (record == nullptr || record->config_as_BertConfig() == nullptr)
    return Status(Code::kBadWeights, file->path() + ": no BERT");
  const auto config = models::ReadBertConfig(*record->config_as_BertConfig(), "bert");
  if (!config.ok()) return config.status();
  models::BertWeights weights;
  Binder binder(*file, record->prefix()->str());
  models::BindBert(binder, *config, &weights);
  if (!binder.status().ok()) return binder.status();
  Graph g;
  g.Output("hidden", models::Bert(g, *config, weights, g.Input("ids", {kTokens}, DType::kI32)));
  WeightCache cache(kernels::BestTable(), file);
  return Plan::Make(std::move(g), cache);
}

struct Models {
  std::shared_ptr<const models::ZsMstm> zs_mstm;
  std::shared_ptr<const Plan> bert;
};

/// One thread with its share of the agents.
class Server {
 public:
  Status Init(const Models& from, int agents);
  void Busy(int segments);
  void Paced(int segments, double begin, unsigned seed);
  const std::vector<double>& times() const { return times_; }

 private:
  /// Words to X_text, X_text to frames, frames to poses.
  void RunSegment(models::ZsMstmAgent& agent);

  std::vector<std::unique_ptr<models::ZsMstmAgent>> agents_;
  std::unique_ptr<Session> bert_;
  std::vector<float> speech_, text_, pose_;
  std::int64_t frames_ = 0, d_text_ = 0;
  double period_ = 0;
  std::vector<double> times_;  // milliseconds
};

Status Server::Init(const Models& from, int agents) {
  const models::ZsMstmConfig& c = from.zs_mstm->config();
  frames_ = c.WindowFrames();
  d_text_ = c.d_text;
  period_ = static_cast<double>(frames_) / c.frame_rate;
  const auto values = [&](std::int64_t width) {
    return std::vector<float>(static_cast<std::size_t>(frames_ * width), 0.5f);
  };
  speech_ = values(c.ast_content.mel_bins);
  text_ = values(d_text_);
  pose_ = values(c.d_pose);
  auto bert = Session::Create(from.bert);
  if (!bert.ok()) return bert.status();
  bert_ = *std::move(bert);
  std::fill_n(bert_->Input("ids").i32, kTokens, 2000);
  const std::vector<float> style(static_cast<std::size_t>(c.StyleWidth()), 0.1f);
  for (int i = 0; i < agents; ++i) {
    auto agent = models::ZsMstm::NewAgent(from.zs_mstm);
    if (!agent.ok()) return agent.status();
    (*agent)->SetStyle(style.data());
    agents_.push_back(*std::move(agent));
  }
  return {};
}

void Server::RunSegment(models::ZsMstmAgent& agent) {
  bert_->Run();
  const ValueView hidden = bert_->Output("hidden");
  for (std::int64_t frame = 0; frame < frames_; ++frame) {
    const std::int64_t piece = 1 + frame * (kTokens - 2) / frames_;
    std::memcpy(text_.data() + frame * d_text_, hidden.f32 + piece * hidden.row_stride,
                static_cast<std::size_t>(d_text_) * sizeof(float));
  }
  agent.Generate(speech_.data(), text_.data(), pose_.data());
}

void Server::Busy(int segments) {
  for (int i = 0; i < segments; ++i) {
    const double begin = Now();
    RunSegment(*agents_[static_cast<std::size_t>(i) % agents_.size()]);
    times_.push_back((Now() - begin) * 1e3);
  }
}

void Server::Paced(int segments, double begin, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> phase(0, period_);
  std::vector<std::pair<double, models::ZsMstmAgent*>> first;
  for (const auto& agent : agents_) first.emplace_back(begin + phase(random), agent.get());
  std::sort(first.begin(), first.end());
  for (int i = 0; i < segments; ++i) {
    const auto& [at, agent] = first[static_cast<std::size_t>(i) % first.size()];
    const double arrival = at + period_ * static_cast<double>(i / static_cast<int>(first.size()));
    if (Now() < arrival) SleepUntil(arrival);
    RunSegment(*agent);
    times_.push_back((Now() - arrival) * 1e3);
  }
}

void Pin(int processor) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0 || CPU_COUNT(&allowed) <= processor)
    return;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &allowed) || processor-- > 0) continue;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(cpu, &one);
    pthread_setaffinity_np(pthread_self(), sizeof one, &one);
    return;
  }
}

Status Serve(const std::string& zs_mstm, const std::string& bert, const Options& options) {
  auto file = WeightsFile::Open(zs_mstm, {.residence = Residence::kCopied});
  if (!file.ok()) return file.status();
  auto words = WeightsFile::Open(bert, {.residence = Residence::kCopied});
  if (!words.ok()) return words.status();
  auto model = models::ZsMstm::Make(*file, "");
  if (!model.ok()) return model.status();
  auto plan = PlanBert(*words);
  if (!plan.ok()) return plan.status();

  const auto workers = static_cast<std::size_t>(options.workers);
  std::vector<Server> servers(workers);
  for (std::size_t i = 0; i < workers; ++i)
    GESTUS_RETURN_IF_ERROR(
        servers[i].Init({*model, *plan}, (options.agents + static_cast<int>(i)) / options.workers));
  for (Server& server : servers) server.Busy(1);  // the first run is no measurement
  const double begin = Now() + 0.1;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < workers; ++i) {
    threads.emplace_back([&, i] {
      if (workers > 1) Pin(static_cast<int>(i));
      const int share = options.segments / options.workers;
      if (options.paced)
        servers[i].Paced(share, begin, options.seed + static_cast<unsigned>(i));
      else
        servers[i].Busy(share);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Server& server : servers) {
    for (std::size_t i = 1; i < server.times().size(); ++i) std::printf("%.3f ", server.times()[i]);
    std::printf("\n");
  }
  return {};
}

}  // namespace
}  // namespace gestus::bench

int main(int argc, char** argv) {
  gestus::bench::Options options;
  if (argc == 8) {
    options.paced = std::strcmp(argv[1], "paced") == 0;
    options.agents = std::atoi(argv[4]);
    options.segments = std::atoi(argv[5]);
    options.workers = std::atoi(argv[6]);
    options.seed = static_cast<unsigned>(std::atoi(argv[7]));
  }
  if (options.workers < 1 || options.agents < options.workers || options.segments < 1) {
    std::fprintf(
        stderr,
        "usage: gestus_agents busy|paced ZS_MSTM.fb BERT.fb AGENTS SEGMENTS WORKERS SEED\n");
    return 2;
  }
  const gestus::Status status = gestus::bench::Serve(argv[2], argv[3], options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "gestus_agents: %s\n", status.message().c_str());
  return 1;
}
