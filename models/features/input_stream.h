// The inputs of a network, made of what there is, a stretch at a time.
#ifndef GESTUS_MODELS_FEATURES_INPUT_STREAM_H_
#define GESTUS_MODELS_FEATURES_INPUT_STREAM_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/network.h"
#include "models/words/transcript.h"

namespace gestus::features {

/// What became of what was given: one plain line each.
struct Account {
  std::vector<std::string> used;   ///< "speech.wav -> speech: 26.7 s, 16000 Hz"
  std::vector<std::string> notes;  ///< what was left out, assumed or odd
};

/// Its items are motion frames, words, windows of words, or sentences.  Memory grows with the
/// stretch, not with the recording.
class InputStream {
 public:
  virtual ~InputStream() = default;
  /// Items of the whole; known from the start.
  virtual std::int64_t total() const = 0;
  /// Items that make one run of the network: the least that it is worth asking for.
  virtual std::int64_t unit() const = 0;
  /// The arrays of the next `count` items, of fewer at the end; no arrays behind it.
  virtual Result<models::Arrays> Next(std::int64_t count) = 0;
  /// What belongs beside the outputs, such as the times of their items; complete behind the end.
  virtual models::Arrays Beside() const { return {}; }
  /// What was odd about the recording, beside the account of Open(); complete behind the end.
  virtual std::vector<std::string> Notes() const { return {}; }
};

/// "words.json: WhisperX JSON, 58 words"
std::string Describe(const words::Transcript& transcript, const std::string& path);

/// How many items to ask for next when `left` are left, so that a stretch holds about `most` and
/// the last one never less than a unit.
std::int64_t Stretch(std::int64_t left, std::int64_t unit, std::int64_t most);

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_INPUT_STREAM_H_
