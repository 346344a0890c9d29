// What a user hands over: recordings, transcripts, key points, arrays, or folders of them, each
// recognised by its content.
#ifndef GESTUS_MODELS_CLI_INPUTS_H_
#define GESTUS_MODELS_CLI_INPUTS_H_

#include <string>
#include <vector>

#include "engine/status.h"

namespace gestus::cli {

enum class InputKind {
  kWeights,
  kArrays,
  kAudio,
  kTranscript,
  kOpenPose,
  kOpenFace,
  kFolder,
  kUnknown
};

/// The kind of a file by its first bytes, of a folder by the names in it; errors begin with the
/// path.
Result<InputKind> Recognise(const std::string& path);

/// One of each kind at most; empty: not given.
struct Inputs {
  std::string weights;             ///< for `infer-cli features` alone
  std::string arrays;              ///< .npz or .npy
  std::string audio;               ///< WAV, or what libsndfile reads
  std::string transcript;          ///< words with times, or plain text
  std::string openpose;            ///< a folder of JSON files, or one of them
  std::string openface;            ///< CSV
  std::vector<std::string> notes;  ///< files in folders that were not used

  /// Whether there is something that speech can be made of.
  bool Spoken() const { return !audio.empty() || !transcript.empty(); }
  bool OnlyArrays() const { return !Spoken() && openpose.empty() && openface.empty(); }
};

/// Sorts `paths`; a folder stands for the files in it.  `transcript` (may be empty) is one whatever
/// it looks like.  A text file without times is a transcript only where it is named itself.  An
/// error when nothing is found.
Result<Inputs> SortInputs(const std::vector<std::string>& paths, const std::string& transcript);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_INPUTS_H_
