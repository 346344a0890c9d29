// Sequences of motion in memory, whatever files they came from.
#ifndef GESTUS_MODELS_CLI_EVAL_SEQUENCES_H_
#define GESTUS_MODELS_CLI_EVAL_SEQUENCES_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/status.h"
#include "engine/weights_file.h"
#include "models/cli/args.h"
#include "models/cli/eval_files.h"
#include "models/features/spec.h"
#include "models/outputs/motion.h"

namespace gestus::cli {

/// Values of a channel in frames that follow each other.
struct Stretch {
  std::int64_t begin = 0;  ///< frame; meaningless where the sequence is not timed
  std::vector<float> values;
};

/// An action unit or head angle: stretches as a network made them, one for each word or window, or
/// a single one from a recording.
struct EvalChannel {
  std::string name;  ///< "AU01", "Rx"
  std::string unit;
  std::vector<Stretch> stretches;
};

struct Sequence {
  std::string name;        ///< by which sequences are paired
  std::string path;        ///< for messages
  outputs::Motion motion;  ///< its body and face, or only how long it is
  std::vector<EvalChannel> channels;
  bool timed = true;      ///< whether it is known when its stretches begin
  bool recorded = false;  ///< OpenFace's: one stretch from beginning to end
};

/// What is known of arrays without a look at them.
struct ArrayLayout {
  const fb::Network* network = nullptr;  ///< null: none, the rest is assumed
  features::FeatureSpec spec;
};

/// The motion in an .npz file of infer-cli: poses (pose, face; style_pose, style_face of a clip) or
/// curves (face, lengths, perhaps times_ms).  Arrays that do not say their frame rate, as finished
/// motion does, have `declared`, or where that is 0 what the layout says.  Poses and finished
/// curves of another rate than `wanted` (0: any) are resampled to it, by straight lines.  Errors
/// begin with the path.
Result<Sequence> ReadMotionArrays(const std::string& path, const std::vector<ArrayLayout>& layouts,
                                  double declared, double wanted, std::vector<std::string>* notes);

class SequenceReader {
 public:
  /// Opens the weights file, where the command line names one: it says which joints poses have and
  /// how fast they are.
  static Result<SequenceReader> Make(const Arguments& arguments);

  /// `rate`: frames per second that are wanted, 0 for the file's own.  Arrays are taken to have it,
  /// recordings are resampled.
  Result<Sequence> Read(const SequenceFile& file, double rate);

  /// Null without weights.
  const std::shared_ptr<const WeightsFile>& weights() const { return weights_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  Status FindLayouts(const std::string& network);
  Result<Sequence> ReadOpenFaceFile(const std::string& path, double rate);
  Result<Sequence> ReadOpenPoseFolder(const std::string& path, double rate);

  std::shared_ptr<const WeightsFile> weights_;
  std::vector<ArrayLayout> layouts_;  // of the file's gesture networks
  double array_rate_ = 0, pose_rate_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EVAL_SEQUENCES_H_
