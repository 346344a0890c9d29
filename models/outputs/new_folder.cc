// The files are written to a folder beside the target, which then takes its name.  One sync for all
// of them: one for each would cost more than everything else.
#include "models/outputs/new_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "models/io/file.h"
#include "models/io/text.h"

namespace gestus::outputs {
namespace {

namespace fs = std::filesystem;

Status SystemError(const std::string& what, int error) {
  return Status(Code::kIo, what + " (" + std::strerror(error) + ")");
}

// Removes the files of `folder` whose names end in `ending`, and then the folder when it is empty.
void RemoveOwn(const std::string& folder, const std::string& ending) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string();
    if (path.ends_with(ending)) ::unlink(path.c_str());
  }
  ::rmdir(folder.c_str());
}

// Whether nothing would be lost if the folder were replaced.
Status CheckReplaceable(const std::string& folder, const std::string& ending) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    std::error_code ignored;
    if (!name.ends_with(ending) || it->symlink_status(ignored).type() != fs::file_type::regular)
      return Status(Code::kIo, "holds \"" + OneLine(name, 40) +
                                   "\", expected a new folder or one of earlier files only");
  }
  return error ? SystemError("cannot be read", error.value()) : Status();
}

}  // namespace

NewFolder::NewFolder(NewFolder&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      ending_(std::move(other.ending_)) {}

NewFolder::~NewFolder() {
  if (!temporary_.empty()) RemoveOwn(temporary_, ending_);
}

Result<NewFolder> NewFolder::Create(const std::string& path, const std::string& ending) {
  NewFolder folder;
  folder.ending_ = ending;
  folder.target_ = path;
  while (folder.target_.size() > 1 && folder.target_.back() == '/') folder.target_.pop_back();
  if (path.empty()) return Status(Code::kIo, "empty path, expected the name of a folder to write");
  struct stat info = {};
  if (::stat(folder.target_.c_str(), &info) == 0) {
    if (!S_ISDIR(info.st_mode))
      return Status(Code::kIo, "is no folder, expected the name of one to write");
    GESTUS_RETURN_IF_ERROR(CheckReplaceable(folder.target_, ending));
    std::error_code error;
    folder.target_ = fs::canonical(folder.target_, error).string();
    if (error) return SystemError("cannot be written", error.value());
  } else if (errno != ENOENT) {
    return SystemError("cannot be written", errno);
  }
  const std::string temporary = folder.target_ + "." + std::to_string(::getpid()) + ".gestus-part";
  if (::mkdir(temporary.c_str(), 0777) != 0) return SystemError("cannot be written", errno);
  folder.temporary_ = temporary;
  return folder;
}

Status NewFolder::Write(const std::string& name, std::string_view content) {
  const std::string path = temporary_ + "/" + name;
  const Descriptor file(
      ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (file.get() < 0) return SystemError("a file in it cannot be written", errno);
  while (!content.empty()) {
    const ssize_t n = ::write(file.get(), content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return SystemError("a file in it cannot be written", errno);
    content.remove_prefix(static_cast<std::size_t>(n));
  }
  return Status();
}

Status NewFolder::Commit() {
  const Descriptor folder(::open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() < 0 || ::syncfs(folder.get()) != 0)
    return SystemError("cannot be written", errno);
  // Renaming succeeds where nothing or an empty folder stands; files of an earlier run change
  // places with the new ones, so that there is no moment without either.
  if (::rename(temporary_.c_str(), target_.c_str()) == 0) {
    temporary_.clear();
    return Status();
  }
  if (errno != ENOTEMPTY && errno != EEXIST) return SystemError("cannot be put in place", errno);
  if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0)
    return Status();            // the destructor removes the old files
  RemoveOwn(target_, ending_);  // a file system that cannot exchange
  if (::rename(temporary_.c_str(), target_.c_str()) != 0)
    return SystemError("cannot be put in place", errno);
  temporary_.clear();
  return Status();
}

}  // namespace gestus::outputs
