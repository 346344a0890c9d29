// A folder of files that appears only when it is complete.  A private header of the writers.
#ifndef GESTUS_MODELS_OUTPUTS_NEW_FOLDER_H_
#define GESTUS_MODELS_OUTPUTS_NEW_FOLDER_H_

#include <string>
#include <string_view>

#include "engine/status.h"

namespace gestus::outputs {

class NewFolder {
 public:
  /// `path` must be free, an empty folder, or one of which every file's name ends in `ending`: what
  /// an earlier run wrote, which Commit() replaces.
  static Result<NewFolder> Create(const std::string& path, const std::string& ending);
  /// Removes what was not committed.
  ~NewFolder();
  NewFolder(NewFolder&& other) noexcept;
  NewFolder& operator=(NewFolder&&) = delete;

  Status Write(const std::string& name, std::string_view content);
  /// Flushes to the disk and puts the folder in its place.
  Status Commit();

 private:
  NewFolder() = default;

  std::string target_;
  std::string temporary_;  // beside the target; empty: there is none
  std::string ending_;
};

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_NEW_FOLDER_H_
