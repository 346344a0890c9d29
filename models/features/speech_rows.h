// X_speech of a recording: a row of log-mel or of the filter bank for every frame, in order.
#ifndef GESTUS_MODELS_FEATURES_SPEECH_ROWS_H_
#define GESTUS_MODELS_FEATURES_SPEECH_ROWS_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/audio/frames.h"
#include "models/audio/stage.h"
#include "models/features/samples.h"
#include "models/features/spec.h"

namespace gestus::features {

/// Rows (mel_bins) before normalisation, as the spec says.  Log-mel rows follow the motion's frames
/// (spec.frame_rate); there are int(seconds * frame_rate) of them, at least one.  With RowPlacement
/// kPats every segment begins at its own time and goes on by PATS' stride.  Rows of the filter bank
/// are taken the same way, by time; or, with spec.every_row, all 100 of a second, and then a
/// recording shorter than one segment is filled up with zeros, as AST's loader does (features.md
/// 5.3).
class SpeechRows {
 public:
  /// Errors begin with the path; one of them is a recording without samples.
  static Result<SpeechRows> Open(const std::string& path, const FeatureSpec& spec);

  std::int64_t total() const { return total_; }
  int width() const { return stage_->width(); }
  /// Appends the next `count` rows to `rows`; behind the last row there are none.
  Status Read(std::int64_t count, std::vector<float>* rows);

  /// As Samples has them.
  std::string Description() const { return samples_.Description(); }
  const std::vector<std::string>& notes() const { return samples_.notes(); }

 private:
  SpeechRows(Samples samples, const FeatureSpec& spec)
      : samples_(std::move(samples)), spec_(spec) {}
  Status MakeStage();
  void CountRows(double seconds);
  std::int64_t ExactRow(std::int64_t frame) const;
  std::int64_t RowOf(std::int64_t frame) const;
  Status Fill(std::int64_t row);

  Samples samples_;
  FeatureSpec spec_;
  std::unique_ptr<audio::Stage> stage_;
  audio::RowPlan exact_, pats_;  // exact_ counts thousandths of frames
  std::vector<float> made_;     // rows of the last piece
  std::vector<float> pending_;  // rows first_pending_ and on
  std::int64_t first_pending_ = 0;
  std::int64_t kept_ = 1;  // rows behind the last one asked for that may be asked for again
  bool ended_ = false;
  std::int64_t next_ = 0, total_ = 0;
};

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_SPEECH_ROWS_H_
