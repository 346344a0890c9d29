// Which files infer-cli eval compares, and by which names they are paired.
#ifndef GESTUS_MODELS_CLI_EVAL_FILES_H_
#define GESTUS_MODELS_CLI_EVAL_FILES_H_

#include <string>
#include <vector>

#include "engine/status.h"
#include "models/cli/inputs.h"

namespace gestus::cli {

struct SequenceFile {
  std::string name, path;
  InputKind kind = InputKind::kUnknown;
};

/// A file, or all of a folder in the order of their names.
struct SequenceSet {
  std::vector<SequenceFile> files;
  bool folder = false;
};

/// Arrays (.npz), OpenFace's CSV, a folder of OpenPose's frames, or a folder of many of these.  A
/// sequence is named after its file without ".npz" or ".csv", and then without ".out".  Other files
/// of a folder are noted.  Errors begin with the path.
Result<SequenceSet> FindSequences(const std::string& path, std::vector<std::string>* notes);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EVAL_FILES_H_
