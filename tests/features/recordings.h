// Recordings, transcripts and weights that the tests of models/features share.
#ifndef GESTUS_TESTS_FEATURES_RECORDINGS_H_
#define GESTUS_TESTS_FEATURES_RECORDINGS_H_

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "engine/weights_file.h"
#include "models/features/front_end.h"
#include "tests/motion/motion_data.h"

namespace gestus::features {

using motion::TempFolder;

/// A buzzing voice of 120 Hz that comes and goes, with a little noise.
std::vector<float> Voice(double seconds, int rate);

/// Writes samples as a WAV of 16 bits and gives its path.
std::string WriteWav(const TempFolder& folder, const std::string& name,
                     const std::vector<float>& samples, int rate, int channels = 1);

/// The samples of a recording at another rate, all at once.
std::vector<float> Resampled(const std::string& path, int rate);

/// Words of the golden BERT's vocabulary in lines of start, end and word.
std::string WriteWords(const TempFolder& folder, const std::string& name,
                       const std::vector<words::Word>& words);

/// The BERT of tests/goldens/bert_vocabulary.fb, of 16 columns and 10 pieces a chunk.
std::shared_ptr<const WeightsFile> GoldenBert();
WordEncoder GoldenEncoder();
std::vector<float> MeansOf(const std::vector<std::string>& words);

/// ZS-MSTM 2.0 with a style, frames of 8 a segment, joints 0 1 4, landmarks 30 and 8; without
/// tensors.  Beside it that BERT and a classifier of three acts, whose names `tags` may reorder.
struct FileOptions {
  std::vector<std::string> tags = {"statement", "thanks", "question"};
  bool texts = true;  ///< whether the two networks for words are there
  bool neck_is_zero = false;
};
std::shared_ptr<const WeightsFile> TalkFile(const FileOptions& options = {});
std::unique_ptr<FrontEnd> TalkFrontEnd(const FileOptions& options = {});

/// A network that hears log-mel of 10 bins and text of 16 columns, in segments of 8 frames.
FeatureSpec FramesSpec();

/// All that is left of a stream, asked for in pieces of the sizes that repeat.
models::Arrays ReadAll(InputStream* stream, const std::vector<std::int64_t>& sizes = {1 << 20});

/// Whether any line has `words`.
bool Says(const std::vector<std::string>& lines, const std::string& words);

}  // namespace gestus::features

#endif  // GESTUS_TESTS_FEATURES_RECORDINGS_H_
