// Brings a file's bytes into memory, block by block, as the caller asks or ahead of it.
#ifndef GESTUS_ENGINE_FILE_READER_H_
#define GESTUS_ENGINE_FILE_READER_H_

#include <atomic>
#include <cstdint>
#include <thread>

#include "engine/file_memory.h"
#include "engine/status.h"

namespace gestus {

class FileReader {
 public:
  /// The first block of `memory` is there.  `ahead`: a thread of its own reads the others.
  FileReader(FileMemory* memory, std::uint64_t block, bool ahead);
  ~FileReader();
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;

  /// Returns when `block` can be read, or with what went wrong before it.
  Status Await(const FileMemory::Range& block);

 private:
  void ReadAll(std::uint64_t block);

  FileMemory* memory_;
  std::atomic<std::uint64_t> there_;  ///< bytes from the start
  std::atomic<bool> stop_{false};
  Status status_;  ///< of the thread, once there_ is the file's size
  std::thread thread_;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_FILE_READER_H_
