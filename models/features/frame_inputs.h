// Inputs frame by frame: X_speech and X_text of ZS-MSTM and of AST.
#ifndef GESTUS_MODELS_FEATURES_FRAME_INPUTS_H_
#define GESTUS_MODELS_FEATURES_FRAME_INPUTS_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/features/input_stream.h"
#include "models/features/spec.h"
#include "models/features/speech_rows.h"
#include "models/features/word_encoder.h"
#include "models/words/transcript.h"

namespace gestus::features {

/// What there is of one recording; whatever is absent is null or empty.
struct FrameSources {
  models::Arrays arrays;  ///< "speech", "text": taken as they are
  std::string arrays_path;
  std::string audio;  ///< path
  const words::Transcript* transcript = nullptr;
  std::string transcript_path;
  WordEncoder* encoder = nullptr;  ///< null: the words cannot be made features
  std::int64_t frames = 0;         ///< how many there are where nothing above says so
};

/// Streams "speech" (frames, mel bins) and, where the network has it, "text" (frames, d_text).
///
/// Words are placed on frames as PATS does (features.md 5.4).  A modality that is absent is the
/// mean of its statistics, or zeros where the network has none, and the account says so; an error
/// when all are absent and no number of frames is given.
class FrameInputs final : public InputStream {
 public:
  static Result<std::unique_ptr<FrameInputs>> Open(const FeatureSpec& spec,
                                                   const FrameSources& sources, Account* account);

  std::int64_t total() const override { return total_; }
  std::int64_t unit() const override { return spec_.frames; }
  Result<models::Arrays> Next(std::int64_t count) override;
  std::vector<std::string> Notes() const override;

 private:
  FrameInputs(const FeatureSpec& spec, FrameSources sources)
      : spec_(spec), sources_(std::move(sources)) {}
  Status OpenSpeech(Account* account);
  Status CountFrames();
  bool HasWords() const;
  Status Nothing() const;
  Status CheckCounts() const;
  Status OpenText(Account* account);
  Status PlaceWords(Account* account);
  Status ReadSpeech(std::int64_t count, std::vector<float>* rows);
  Status ReadText(std::int64_t count, std::vector<float>* rows);

  FeatureSpec spec_;
  FrameSources sources_;
  std::optional<SpeechRows> speech_;
  std::optional<PieceRows> pieces_;
  std::vector<std::int64_t> piece_of_frame_;  // over all words; -1: none
  std::int64_t next_ = 0, total_ = 0;
};

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_FRAME_INPUTS_H_
