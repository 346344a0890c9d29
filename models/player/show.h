// What people are to look at: motion, and the recording that it goes with.  Pages, contact sheets
// and videos are all made from it.
#ifndef GESTUS_MODELS_PLAYER_SHOW_H_
#define GESTUS_MODELS_PLAYER_SHOW_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/outputs/motion.h"
#include "models/words/transcript.h"

namespace gestus::player {

/// The recording as people hear it.
struct Sound {
  int sample_rate = 0;         ///< Hz; 0: no sound
  std::vector<float> samples;  ///< mono, full scale being [-1, 1]
  /// The bytes of the recording, where it is a WAV file; may be empty.
  std::string file;

  double seconds() const {
    return sample_rate > 0 ? static_cast<double>(samples.size()) / sample_rate : 0;
  }
};

/// Rows of the logarithm of mel power.
struct Spectrogram {
  double rate = 0;            ///< rows a second
  std::int64_t bins = 0;      ///< low frequencies first
  std::vector<float> values;  ///< (rows, bins)
};

struct Pitch {
  double rate = 0;        ///< values a second
  std::vector<float> hz;  ///< 0 where unvoiced
};

/// Every part but the prediction may be absent.  Numbers that are not finite are shown as the value
/// before them in time.
struct Show {
  std::string title;    ///< one line, UTF-8
  std::string network;  ///< "ZS-MSTM 2.0"
  std::string weights;  ///< where the weights come from, one sentence; may be empty
  bool trained = false;
  outputs::Motion prediction;
  std::optional<outputs::Motion> source, target;
  Sound sound;
  std::vector<words::Word> words;
  Spectrogram spectrogram;
  Pitch pitch;

  /// Of the longest of the motions and the sound.
  double seconds() const;
};

struct Take {
  const char* role;               ///< "source", "prediction" or "target"
  const outputs::Motion* motion;  ///< of the show, which must outlive this
};

/// What stands side by side, from left to right.
std::vector<Take> TakesOf(const Show& show);

/// Whether sizes fit each other; the error names what does not.
Status CheckShow(const Show& show);

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_SHOW_H_
