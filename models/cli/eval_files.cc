#include "models/cli/eval_files.h"

#include <algorithm>
#include <filesystem>

namespace gestus::cli {
namespace {

constexpr const char* kKinds =
    ": holds no motion, expected arrays (.npz), OpenFace's CSV, a folder of OpenPose's frames or a "
    "folder of these";

bool IsMotion(InputKind kind) {
  return kind == InputKind::kArrays || kind == InputKind::kOpenFace || kind == InputKind::kOpenPose;
}

std::string NameOf(const std::filesystem::path& path) {
  std::string name = (path.has_filename() ? path : path.parent_path()).filename().string();
  for (const std::string ending : {".npz", ".csv", ".out"}) {
    if (name.ends_with(ending) && name.size() > ending.size())
      name.resize(name.size() - ending.size());
  }
  return name;
}

Result<std::vector<std::string>> FilesOf(const std::string& folder) {
  constexpr std::size_t kMost = 100000;
  std::error_code error;
  std::vector<std::string> paths;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    if (at->path().filename().string().starts_with('.')) continue;
    if (paths.size() == kMost)
      return Status(Code::kBadInput,
                    folder + ": more than " + std::to_string(kMost) + " files, expected fewer");
    paths.push_back(at->path().string());
  }
  if (error) return Status(Code::kIo, folder + ": cannot be read (" + error.message() + ")");
  std::sort(paths.begin(), paths.end());
  return paths;
}

Status CheckNames(const std::vector<SequenceFile>& files) {
  std::vector<const SequenceFile*> sorted;
  for (const SequenceFile& file : files) sorted.push_back(&file);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto* a, const auto* b) { return a->name < b->name; });
  const auto twice =
      std::adjacent_find(sorted.begin(), sorted.end(),
                         [](const auto* a, const auto* b) { return a->name == b->name; });
  if (twice == sorted.end()) return Status();
  return Status(Code::kBadInput, twice[1]->path + ": the same name as " + twice[0]->path +
                                     " but for the ending, expected one sequence of a name");
}

}  // namespace

Result<SequenceSet> FindSequences(const std::string& path, std::vector<std::string>* notes) {
  const Result<InputKind> kind = Recognise(path);
  if (!kind.ok()) return kind.status();
  SequenceSet set;
  if (IsMotion(*kind)) {
    set.files.push_back({NameOf(path), path, *kind});
    return set;
  }
  if (*kind != InputKind::kFolder) return Status(Code::kBadInput, path + kKinds);
  set.folder = true;
  const Result<std::vector<std::string>> paths = FilesOf(path);
  if (!paths.ok()) return paths.status();
  for (const std::string& file : *paths) {
    const Result<InputKind> found = Recognise(file);
    if (!found.ok()) return found.status();
    if (IsMotion(*found)) {
      set.files.push_back({NameOf(file), file, *found});
    } else {
      notes->push_back(file + " was not used");
    }
  }
  if (set.files.empty()) return Status(Code::kBadInput, path + kKinds);
  GESTUS_RETURN_IF_ERROR(CheckNames(set.files));
  return set;
}

}  // namespace gestus::cli
