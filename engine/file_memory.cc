// Maps or reads a file; frees and restores parts of it.
#include "engine/file_memory.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "engine/file_scan.h"

namespace gestus {
namespace {

Status ErrnoStatus(const char* what) {
  return Status(errno == ENOENT ? Code::kNotFound : Code::kIo,
                std::string(what) + ": " + std::strerror(errno));
}

Status CannotReserve(std::uint64_t size) {
  return Status(Code::kResourceExhausted,
                "cannot reserve " + std::to_string(size) + " bytes: " + std::strerror(errno));
}

Status ReadAt(int fd, std::uint8_t* to, std::uint64_t offset, std::uint64_t size) {
  std::uint64_t done = 0;
  while (done < size) {
    const ssize_t n = pread(fd, to + done, size - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return ErrnoStatus("cannot read");
    if (n == 0) return Status(Code::kBadWeights, "file became shorter while it was read");
    done += static_cast<std::uint64_t>(n);
  }
  return {};
}

/// Private memory, of huge pages where there are any: touching it first then costs a fraction.
std::uint8_t* Reserve(std::uint64_t size) {
  void* const data =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED) return nullptr;
  madvise(data, size, MADV_HUGEPAGE);
  return static_cast<std::uint8_t*>(data);
}

std::uint64_t PageSize() { return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)); }

bool Meet(const FileMemory::Range& a, const FileMemory::Range& b) {
  return a.begin < b.end && b.begin < a.end;
}

}  // namespace

FileMemory::~FileMemory() {
  if (data_ != nullptr) munmap(data_, size_);
  if (fd_ >= 0) close(fd_);
}

Status FileMemory::Open(const std::string& path, bool mapped, std::uint64_t least,
                        std::uint64_t most) {
  mapped_ = mapped;
  do {
    fd_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  } while (fd_ < 0 && errno == EINTR);
  if (fd_ < 0) return ErrnoStatus("cannot open");
  struct stat st;
  if (fstat(fd_, &st) != 0) return ErrnoStatus("cannot stat");
  if (!S_ISREG(st.st_mode)) return Status(Code::kBadWeights, "not a regular file");
  const auto size = static_cast<std::uint64_t>(st.st_size);
  if (size < least || size > most)
    return Status(Code::kBadWeights, std::to_string(size) + " bytes, expected a weights file of " +
                                         std::to_string(least) + " bytes to " +
                                         std::to_string(most >> 30) + " GiB");
  if (mapped) {
    void* const data = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd_, 0);
    if (data != MAP_FAILED) data_ = static_cast<std::uint8_t*>(data);
    close(std::exchange(fd_, -1));
  } else {
    data_ = Reserve(size);
  }
  if (data_ == nullptr) return CannotReserve(size);
  size_ = size;
  return {};
}

Status FileMemory::Copy(const void* data, std::uint64_t size) {
  data_ = Reserve(size);
  if (data_ == nullptr) return CannotReserve(size);
  size_ = size;
  std::memcpy(data_, data, size);
  return {};
}

Status FileMemory::Fill(Range range) {
  if (mapped_) {
    // One call in place of a fault for every few pages; that it may fail does no harm.
    madvise(data_ + range.begin, range.end - range.begin, MADV_POPULATE_READ);
  }
  if (fd_ < 0) return {};
  return ReadAt(fd_, data_ + range.begin, range.begin, range.end - range.begin);
}

void FileMemory::Free(Range range) {
  madvise(data_ + range.begin, range.end - range.begin, MADV_DONTNEED);
}

void FileMemory::GiveBack(Range range) {
  if (!mapped_ && fd_ < 0) return;
  // Only pages that lie wholly inside: their neighbours belong to other tensors.
  const std::uint64_t page = PageSize();
  const Range pages{(range.begin + page - 1) / page * page, range.end / page * page};
  if (pages.begin >= pages.end) return;
  Free(pages);
  if (!mapped_) gone_.push_back(pages);
}

Status FileMemory::Restore(const std::vector<Range>& ranges, std::uint64_t checksum) {
  const auto wanted = [&](const Range& gone) {
    return std::any_of(ranges.begin(), ranges.end(),
                       [&](const Range& range) { return Meet(gone, range); });
  };
  const auto first =
      std::partition(gone_.begin(), gone_.end(), [&](const Range& gone) { return !wanted(gone); });
  if (first == gone_.end()) return {};
  FileScan scan;
  std::vector<std::uint8_t> block(FileScan::kBlock);
  Status status;
  for (Range at; at.begin < size_ && status.ok(); at.begin = at.end) {
    at.end = std::min(size_, at.begin + FileScan::kBlock);
    status = ReadAt(fd_, block.data(), at.begin, at.end - at.begin);
    scan.Add(block.data(), at.end - at.begin);
    for (auto gone = first; gone != gone_.end(); ++gone) {
      const Range part{std::max(at.begin, gone->begin), std::min(at.end, gone->end)};
      if (part.begin < part.end)
        std::memcpy(data_ + part.begin, block.data() + (part.begin - at.begin),
                    part.end - part.begin);
    }
  }
  if (status.ok() && scan.Checksum() == checksum) {
    gone_.erase(first, gone_.end());
    return {};
  }
  for (auto gone = first; gone != gone_.end(); ++gone) Free(*gone);
  return Status(status.code() == Code::kIo ? Code::kIo : Code::kBadWeights,
                "file has changed since it was opened, and its tensors were given back once they "
                "were packed for other kernels or in other parts; open it anew");
}

}  // namespace gestus
