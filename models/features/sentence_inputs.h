// Inputs sentence by sentence: token ids for BERT and the classifier of dialog acts.
#ifndef GESTUS_MODELS_FEATURES_SENTENCE_INPUTS_H_
#define GESTUS_MODELS_FEATURES_SENTENCE_INPUTS_H_

#include <memory>
#include <string>
#include <vector>

#include "models/features/input_stream.h"
#include "models/features/spec.h"
#include "models/text/wordpiece.h"
#include "models/words/transcript.h"

namespace gestus::features {

/// Streams "ids" (sentences, pieces) int32, zeros behind the end of a sentence.  BERT gets the
/// whole transcript as one sequence, which it cuts itself; the classifier one sequence for each
/// sentence, cut short where it has no room.
///
/// Beside the outputs stands "times_ms" (sentences, 2) int32.
class SentenceInputs final : public InputStream {
 public:
  static Result<std::unique_ptr<SentenceInputs>> Open(const FeatureSpec& spec,
                                                      const words::Transcript& transcript,
                                                      const std::string& path,
                                                      const models::WordPiece& tokeniser,
                                                      Account* account);

  std::int64_t total() const override { return static_cast<std::int64_t>(ids_.size()); }
  std::int64_t unit() const override { return 1; }
  Result<models::Arrays> Next(std::int64_t count) override;
  models::Arrays Beside() const override;

 private:
  std::vector<std::vector<std::int32_t>> ids_;
  std::vector<std::int32_t> times_ms_;
  std::size_t next_ = 0;
};

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_SENTENCE_INPUTS_H_
