// ZS-MSTM 1.0 for programs that embed it: speech and words of one segment, and a speaker's style,
// to upper-body poses.
//
//   auto file  = WeightsFile::Open("weights.fb", {.residence = Residence::kCopied});
//   auto model = ZsMstm1::Make(*file, "");
//   auto agent = ZsMstm1::NewAgent(*model, {.threads = 1});
//   (*agent)->AddStyleSegment(speech, text, pose);     // a clip of the speaker, once
//   (*agent)->Generate(speech, text, pose_out);        // every segment, no allocation
//
// The model is immutable and shared; an agent belongs to one thread at a time.
#ifndef GESTUS_MODELS_ZS_MSTM1_ZS_MSTM1_H_
#define GESTUS_MODELS_ZS_MSTM1_ZS_MSTM1_H_

#include <memory>
#include <string>
#include <vector>

#include "engine/plan.h"
#include "engine/session.h"
#include "engine/weights_file.h"
#include "models/zs_mstm1/config.h"

namespace gestus::models {

class ZsMstm1Agent;

struct ZsMstm1Options {
  const kernels::KernelTable* kernels = nullptr;  ///< null: BestTable()
  PlanOptions plan;
};

class ZsMstm1 {
 public:
  /// Plans both graphs of network `name` (empty: the only one of the file).
  static Result<std::shared_ptr<const ZsMstm1>> Make(std::shared_ptr<const WeightsFile> file,
                                                     const std::string& name,
                                                     const ZsMstm1Options& options = {});
  static Result<std::unique_ptr<ZsMstm1Agent>> NewAgent(std::shared_ptr<const ZsMstm1> model,
                                                        const SessionOptions& options = {});

  const ZsMstm1Config& config() const { return config_; }
  const std::shared_ptr<const WeightsFile>& file() const { return file_; }
  const std::shared_ptr<const Plan>& style_plan() const { return style_plan_; }
  const std::shared_ptr<const Plan>& generator_plan() const { return generator_plan_; }

 private:
  ZsMstm1() = default;
  std::shared_ptr<const WeightsFile> file_;
  ZsMstm1Config config_;
  ZsMstm1Weights weights_;
  std::shared_ptr<const Plan> style_plan_, generator_plan_;
};

class ZsMstm1Agent {
 public:
  /// Runs one segment of the target speaker, `frames` rows of speech (ln power of the mel bins),
  /// text and pose, row-major and contiguous.  The style in use is the mean over all segments added
  /// since ResetStyle.
  void AddStyleSegment(const float* speech, const float* text, const float* pose) noexcept;
  void ResetStyle() noexcept;
  /// Takes a style that was kept, StyleWidth() values.
  void SetStyle(const float* style) noexcept;
  /// The style in use: StyleWidth() values, zeros before any was given.
  const float* style() const { return style_; }

  /// Runs one window: WindowFrames() rows of speech and text -> as many rows of d_pose values, in
  /// the units of the pose statistics.
  void Generate(const float* speech, const float* text, float* pose) noexcept;

  const ZsMstm1& model() const { return *model_; }
  Session& style_session() { return *style_session_; }
  Session& generator_session() { return *generator_session_; }

 private:
  friend class ZsMstm1;
  ZsMstm1Agent() = default;

  std::shared_ptr<const ZsMstm1> model_;
  std::unique_ptr<Session> style_session_, generator_session_;
  ValueView style_speech_, style_text_, style_pose_, style_out_;
  ValueView speech_, text_, pose_;
  float* style_ = nullptr;  // input of the generator, which keeps it over runs
  std::int64_t style_segments_ = 0;
};

}  // namespace gestus::models

#endif  // GESTUS_MODELS_ZS_MSTM1_ZS_MSTM1_H_
