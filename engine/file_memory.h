// The bytes of a weights file in memory, and what of them was given back to the operating system.
#ifndef GESTUS_ENGINE_FILE_MEMORY_H_
#define GESTUS_ENGINE_FILE_MEMORY_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"

namespace gestus {

class FileMemory {
 public:
  struct Range {
    std::uint64_t begin = 0, end = 0;  ///< offsets in the file
  };

  FileMemory() = default;
  ~FileMemory();
  FileMemory(const FileMemory&) = delete;
  FileMemory& operator=(const FileMemory&) = delete;

  /// Reserves memory for the regular file `path`, of at least `least` and at most `most` bytes:
  /// its mapping, or room for a private copy, whose bytes are there once Fill has read them.
  Status Open(const std::string& path, bool mapped, std::uint64_t least, std::uint64_t most);
  /// Copies `size` bytes.
  Status Copy(const void* data, std::uint64_t size);

  const std::uint8_t* data() const { return data_; }
  std::uint64_t size() const { return size_; }
  /// Whether these are the only bytes that count, whatever becomes of the file.
  bool copied() const { return !mapped_; }

  Status Fill(Range range);

  /// Frees the pages that lie wholly inside `range`.  A mapping reads them again when they are
  /// touched; of a copy they hold zeros until they are restored.  What has no file stays.
  void GiveBack(Range range);
  /// Reads what of `ranges` was given back from the file again, and the rest of the file beside
  /// it: an error unless all of it is what it was, byte for byte, when `checksum` was computed.
  Status Restore(const std::vector<Range>& ranges, std::uint64_t checksum);

 private:
  void Free(Range range);

  std::string path_;
  std::uint8_t* data_ = nullptr;
  std::uint64_t size_ = 0;
  bool mapped_ = false;
  int fd_ = -1;              // of a copied file, to restore from
  std::vector<Range> gone_;  // of a copied file
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_FILE_MEMORY_H_
