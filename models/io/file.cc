// File access by system calls: streams of the standard library do not say why something failed,
// and have no way to sync, to link or to ask for a file without a name.
#include "models/io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>

namespace gestus {
namespace {

Status SystemError(const std::string& what, int error) {
  return Status(Code::kIo, what + ": " + std::strerror(error));
}

// Repeats a system call that a signal interrupted.
template <class Call>
auto Retry(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

std::string DescriptorPath(int fd) { return "/proc/self/fd/" + std::to_string(fd); }

// Follows symbolic links, so that the file they lead to is replaced and not the link.
std::string Resolve(const std::string& path) {
  char* resolved = ::realpath(path.c_str(), nullptr);
  if (resolved == nullptr) return path;
  std::string result = resolved;
  std::free(resolved);
  return result;
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

Result<InputFile> OpenInput(const std::string& path) {
  // Without O_NONBLOCK, opening a pipe would wait for somebody to write to it.
  InputFile file;
  file.fd = Descriptor(
      Retry([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY); }));
  struct stat info = {};
  if (file.fd.get() < 0 || ::fstat(file.fd.get(), &info) != 0) {
    return Status(Code::kIo, std::string("cannot be opened (") + std::strerror(errno) +
                                 "), expected a readable file");
  }
  if (!S_ISREG(info.st_mode)) {
    return Status(Code::kIo, S_ISDIR(info.st_mode) ? "is a directory, expected a file"
                                                   : "is a pipe or device, expected a file");
  }
  file.size = static_cast<std::uint64_t>(info.st_size);
  return file;
}

Result<AtomicFile> AtomicFile::Create(const std::string& path) {
  AtomicFile file;
  struct stat info = {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (!exists && errno != ENOENT) return SystemError("cannot be written", errno);
  if (path.empty()) return Status(Code::kIo, "empty path, expected the name of a file to write");
  if (path.back() == '/' || (exists && S_ISDIR(info.st_mode))) {
    return Status(Code::kIo, "is a directory, expected the name of a file to write");
  }
  if (exists && !S_ISREG(info.st_mode)) {
    file.fd_ = Descriptor(Retry([&] { return ::open(path.c_str(), O_WRONLY | O_CLOEXEC); }));
    if (file.fd_.get() < 0) return SystemError("cannot be written", errno);
    return file;
  }
  // A file that may not be written is not replaced either, though the directory would allow it.
  if (exists && ::access(path.c_str(), W_OK) != 0) return SystemError("cannot be written", errno);
  file.target_ = exists ? Resolve(path) : path;
  const std::size_t slash = file.target_.rfind('/');
  file.directory_ = slash == std::string::npos ? "." : file.target_.substr(0, slash + 1);
  GESTUS_RETURN_IF_ERROR(file.OpenTemporary(exists ? info.st_mode & 07777U : 0666U));
  // The umask took its part of a new file's mode; an old file's mode is kept as it was.
  if (exists) (void)::fchmod(file.fd_.get(), info.st_mode & 07777U);
  return file;
}

// Opens a file without a name, or with one that nobody else has.
Status AtomicFile::OpenTemporary(unsigned mode) {
  mode_ = Mode::kUnnamed;
  const bool can_link = ::access("/proc/self/fd", X_OK) == 0;
  fd_ = Descriptor(!can_link ? -1 : Retry([&] {
    return ::open(directory_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
  }));
  if (fd_.get() >= 0) return Status();
  if (can_link && errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) {
    return SystemError("cannot be written", errno);
  }
  mode_ = Mode::kNamed;
  const std::string name = target_ + "." + std::to_string(::getpid()) + ".gestus-part";
  fd_ = Descriptor(Retry([&] {
    return ::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, mode);
  }));
  if (fd_.get() < 0) return SystemError("cannot be written", errno);
  temporary_ = name;
  return Status();
}

AtomicFile::~AtomicFile() {
  if (fd_.get() >= 0 && !temporary_.empty()) ::unlink(temporary_.c_str());
}

Status AtomicFile::Write(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = Retry([&] { return ::write(fd_.get(), bytes, size); });
    if (n < 0) return SystemError("cannot be written", errno);
    bytes += n;
    size -= static_cast<std::size_t>(n);
  }
  return Status();
}

// Gives the complete file a name.  A link cannot replace a file, so over an old one it takes a
// second name first and is renamed from there.  That name is always the same: what a process killed
// between the two calls leaves behind, the next one removes.  When two processes write the same
// output at once, either may find the name gone again; it then repeats the link.
Status AtomicFile::LinkTemporary() {
  const std::string self = DescriptorPath(fd_.get());
  const auto link_to = [&](const std::string& name) {
    return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  if (link_to(target_)) return Status();
  const std::string name = target_ + ".gestus-part";
  for (int attempt = 0; attempt < 100 && errno == EEXIST; ++attempt) {
    if (!link_to(name)) {
      if (errno != EEXIST) break;
      if (::unlink(name.c_str()) != 0 && errno != ENOENT) break;
      errno = EEXIST;
      continue;
    }
    if (::rename(name.c_str(), target_.c_str()) == 0) return Status();
    if (errno != ENOENT) {
      const int error = errno;
      ::unlink(name.c_str());
      return SystemError("cannot be replaced", error);
    }
    errno = EEXIST;
  }
  return SystemError("cannot be put in place", errno);
}

void AtomicFile::SyncDirectory() const {
  const Descriptor directory(
      Retry([&] { return ::open(directory_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
  // The data are safe and the file is in place; a file system that cannot sync a directory, or a
  // directory that may not be read, is no reason to call the run a failure.
  if (directory.get() >= 0) (void)::fsync(directory.get());
}

Status AtomicFile::Commit() {
  if (mode_ != Mode::kDirect && Retry([&] { return ::fsync(fd_.get()); }) != 0) {
    return SystemError("cannot be written", errno);
  }
  if (mode_ == Mode::kUnnamed) {
    GESTUS_RETURN_IF_ERROR(LinkTemporary());
  } else if (mode_ == Mode::kNamed) {
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
      return SystemError("cannot be replaced", errno);
    }
    temporary_.clear();
  }
  if (::close(fd_.Release()) != 0 && errno != EINTR) return SystemError("cannot be written", errno);
  if (mode_ != Mode::kDirect) SyncDirectory();
  return Status();
}

}  // namespace gestus
