// What a network's weights file says of how its inputs are made: the schema's table Features,
// checked, with the numbers that the network's own configuration adds.
#ifndef GESTUS_MODELS_FEATURES_SPEC_H_
#define GESTUS_MODELS_FEATURES_SPEC_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::features {

enum class SpeechFeature { kLogMel, kFilterBank };
enum class RowPlacement { kExact, kPats };
enum class PitchReading { kSptk, kTextbook };
enum class PitchEnds { kNearest, kLinear };
enum class PoseSource { kNormalize, kData };
enum class NeckColumns { kPosition, kZero };

/// The inputs of a network fall into three layouts; others take arrays only.
enum class Layout {
  kFrames,     ///< speech, text and motion at the motion's frame rate: ZS-MSTM, AST
  kWords,      ///< f0 and text word by word: Model 1
  kWindows,    ///< the same in windows of one inter-pausal unit: Model 2
  kSentences,  ///< token ids: BERT
  kArrays
};

struct FeatureSpec {
  Layout layout = Layout::kArrays;
  double frame_rate = 15;          ///< rows of X_speech a second
  std::int64_t frames = 64;        ///< of a segment, as the network runs it
  std::int64_t style_frames = 64;  ///< of a segment of a style clip
  std::int64_t mel_bins = 128;
  std::int64_t d_text = 768;
  std::int64_t d_face = 0;       ///< 0: no face
  std::int64_t d_tags = 0;       ///< 0: no dialog acts
  std::int64_t f0_length = 100;  ///< values of a word
  std::int64_t max_words = 10;   ///< kWindows: words of one window
  std::int64_t text_rows = 1;    ///< kWords: rows of text of a word
  std::int64_t positions = 0;    ///< kSentences: tokens of a sequence, [CLS] and [SEP] included
  bool classifies = false;       ///< kSentences: one answer for each sequence
  PoseSource pose_source = PoseSource::kNormalize;
  NeckColumns neck = NeckColumns::kPosition;
  std::vector<std::int64_t> joints;     ///< PATS numbers, in the order of X_pose
  std::vector<std::int64_t> landmarks;  ///< OpenPose face numbers, in the order of X_face

  SpeechFeature speech = SpeechFeature::kLogMel;
  bool every_row = false;  ///< X_speech is every row of the filter bank, not one a motion frame
  int sample_rate = 44100;
  RowPlacement rows = RowPlacement::kExact;
  int pitch_sample_rate = 16000;
  double pitch_hop = 0.01;
  double pitch_minimum = 50, pitch_maximum = 550;
  double pitch_threshold = 0.3;
  PitchReading pitch = PitchReading::kSptk;
  PitchEnds pitch_ends = PitchEnds::kNearest;
  double pause = 0.2;
  /// What stands for a modality that is not there: the mean of its statistics; empty: zeros.
  std::vector<float> absent_speech, absent_text;
  std::vector<std::string> tags;  ///< empty: the classifier's order
};

/// Errors name the network and the field.  Nothing in the file need have been checked before.
Result<FeatureSpec> ReadFeatureSpec(const fb::Network& network);

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_SPEC_H_
