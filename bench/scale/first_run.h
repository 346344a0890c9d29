// A network of any kind, ready for its first run with plausible inputs.
#ifndef GESTUS_BENCH_SCALE_FIRST_RUN_H_
#define GESTUS_BENCH_SCALE_FIRST_RUN_H_

#include <memory>
#include <vector>

#include "engine/plan.h"
#include "engine/session.h"
#include "engine/status.h"
#include "engine/weights_file.h"
#include "models/zs_mstm/zs_mstm.h"

namespace gestus::bench {

class FirstRun {
 public:
  Status Plan(const std::shared_ptr<const WeightsFile>& file);
  Status MakeSession(int threads);
  void Run();
  float FirstValue() const;

 private:
  // AST, and BERT on 32 tokens.
  std::shared_ptr<const gestus::Plan> plan_;
  std::unique_ptr<Session> session_;
  // ZS-MSTM 1.0: a segment whose style is kept.
  std::shared_ptr<const models::ZsMstm> model_;
  std::unique_ptr<models::ZsMstmAgent> agent_;
  std::vector<float> speech_, text_, pose_;
};

}  // namespace gestus::bench

#endif  // GESTUS_BENCH_SCALE_FIRST_RUN_H_
