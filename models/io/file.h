// Opens files for reading, and writes outputs so that a path always holds either the old file or
// the complete new one, whatever happens in between.
#ifndef GESTUS_MODELS_IO_FILE_H_
#define GESTUS_MODELS_IO_FILE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "engine/status.h"

namespace gestus {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

  int get() const { return fd_; }
  int Release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

struct InputFile {
  Descriptor fd;
  std::uint64_t size = 0;
};

/// Opens a regular file; directories, pipes and devices are refused.  The path is left for the
/// caller to name.
Result<InputFile> OpenInput(const std::string& path);

/// A file that appears at its path only when it is complete.
///
///   Result<AtomicFile> file = AtomicFile::Create("motion.npz");   // says early what is forbidden
///   ... compute ...
///   GESTUS_RETURN_IF_ERROR(file->Write(data, size));
///   GESTUS_RETURN_IF_ERROR(file->Commit());
///
/// Until Commit() the bytes go to a file without a name (O_TMPFILE), which the system removes even
/// when the process is killed; where the file system knows no such files, to one with a name of its
/// own beside the target.  Devices and pipes (/dev/null, /dev/stdout) are written directly.
class AtomicFile {
 public:
  static Result<AtomicFile> Create(const std::string& path);
  /// Removes what was not committed.
  ~AtomicFile();
  AtomicFile(AtomicFile&&) = default;
  AtomicFile& operator=(AtomicFile&&) = delete;

  Status Write(const void* data, std::size_t size);
  /// Flushes to the disk and puts the file in its place.
  Status Commit();

 private:
  enum class Mode { kDirect, kUnnamed, kNamed };

  AtomicFile() = default;
  Status OpenTemporary(unsigned mode);
  Status LinkTemporary();
  void SyncDirectory() const;

  std::string target_;     // symbolic links resolved
  std::string directory_;  // of the target
  std::string temporary_;  // its name while it has one of its own
  Mode mode_ = Mode::kDirect;
  Descriptor fd_;
};

}  // namespace gestus

#endif  // GESTUS_MODELS_IO_FILE_H_
