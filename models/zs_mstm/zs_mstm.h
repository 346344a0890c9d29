// ZS-MSTM 1.0 and 2.0 for programs that embed it: speech and words of one segment, and a speaker's
// style, to upper-body poses and, in 2.0, facial landmarks.
//
//   auto file  = WeightsFile::Open("weights.fb", {.residence = Residence::kCopied});
//   auto model = ZsMstm::Make(*file, "");
//   auto agent = ZsMstm::NewAgent(*model, {.threads = 1});
//   (*agent)->AddStyleSegment({speech, text, pose});   // a clip of the speaker, once
//   (*agent)->Generate(speech, text, pose_out);        // every segment, no allocation
//
// The model is immutable and shared; an agent belongs to one thread at a time.
#ifndef GESTUS_MODELS_ZS_MSTM_ZS_MSTM_H_
#define GESTUS_MODELS_ZS_MSTM_ZS_MSTM_H_

#include <memory>
#include <string>
#include <vector>

#include "engine/plan.h"
#include "engine/session.h"
#include "engine/weights_file.h"
#include "models/zs_mstm/config.h"

namespace gestus::models {

class ZsMstmAgent;

struct ZsMstmOptions {
  const kernels::KernelTable* kernels = nullptr;  ///< null: BestTable()
  PlanOptions plan;
};

class ZsMstm {
 public:
  /// Plans both graphs of network `name` (empty: the only one of the file).
  static Result<std::shared_ptr<const ZsMstm>> Make(std::shared_ptr<const WeightsFile> file,
                                                    const std::string& name,
                                                    const ZsMstmOptions& options = {});
  static Result<std::unique_ptr<ZsMstmAgent>> NewAgent(std::shared_ptr<const ZsMstm> model,
                                                       const SessionOptions& options = {});

  const ZsMstmConfig& config() const { return config_; }
  const std::shared_ptr<const WeightsFile>& file() const { return file_; }
  const std::shared_ptr<const Plan>& style_plan() const { return style_plan_; }
  const std::shared_ptr<const Plan>& generator_plan() const { return generator_plan_; }

 private:
  ZsMstm() = default;
  std::shared_ptr<const WeightsFile> file_;
  ZsMstmConfig config_;
  ZsMstmWeights weights_;
  std::shared_ptr<const Plan> style_plan_, generator_plan_;
};

/// One segment of a target speaker: `frames` rows of each, row-major and contiguous.
struct StyleSegment {
  const float* speech = nullptr;  ///< ln power of the mel bins
  const float* text = nullptr;
  const float* pose = nullptr;
  const float* face = nullptr;  ///< 2.0 alone
  const float* tags = nullptr;  ///< 2.0 alone: one row, 1 for each dialog act of the segment
};

class ZsMstmAgent {
 public:
  /// Runs one segment.  The style in use is the mean over all segments added since ResetStyle.
  void AddStyleSegment(const StyleSegment& segment) noexcept;
  void ResetStyle() noexcept;
  /// Takes a style that was kept, StyleWidth() values.
  void SetStyle(const float* style) noexcept;
  /// The style in use: StyleWidth() values, zeros before any was given.
  const float* style() const { return style_; }

  /// Runs one window: WindowFrames() rows of speech and text -> as many rows of d_pose and, in 2.0,
  /// of d_face values, in the units of their statistics.  `face` may be null.
  void Generate(const float* speech, const float* text, float* pose,
                float* face = nullptr) noexcept;

  const ZsMstm& model() const { return *model_; }
  Session& style_session() { return *style_session_; }
  Session& generator_session() { return *generator_session_; }

 private:
  friend class ZsMstm;
  ZsMstmAgent() = default;

  std::shared_ptr<const ZsMstm> model_;
  std::unique_ptr<Session> style_session_, generator_session_;
  ValueView style_speech_, style_text_, style_pose_, style_face_, style_tags_, style_out_;
  ValueView speech_, text_, pose_, face_;
  float* style_ = nullptr;  // input of the generator, which keeps it over runs
  std::int64_t style_segments_ = 0;
};

}  // namespace gestus::models

#endif  // GESTUS_MODELS_ZS_MSTM_ZS_MSTM_H_
