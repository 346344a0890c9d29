// Reading ahead on a thread.
#include "engine/file_reader.h"

#include <algorithm>
#include <system_error>

namespace gestus {

FileReader::FileReader(FileMemory* memory, std::uint64_t block, bool ahead)
    : memory_(memory), there_(std::min(block, memory->size())) {
  if (!ahead || there_ == memory->size()) return;
  try {
    thread_ = std::thread([this, block] { ReadAll(block); });
  } catch (const std::system_error&) {  // no thread to be had: the caller reads
  }
}

FileReader::~FileReader() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void FileReader::ReadAll(std::uint64_t block) {
  for (std::uint64_t at = there_; at < memory_->size() && status_.ok() && !stop_;) {
    const FileMemory::Range next{at, std::min(memory_->size(), at + block)};
    status_ = memory_->Fill(next);
    at = status_.ok() ? next.end : memory_->size();
    there_.store(at, std::memory_order_release);
    there_.notify_one();
  }
}

Status FileReader::Await(const FileMemory::Range& block) {
  std::uint64_t there = there_.load(std::memory_order_acquire);
  if (!thread_.joinable()) {
    if (block.end <= there) return {};
    there_ = block.end;
    return memory_->Fill(block);
  }
  for (; there < block.end; there = there_.load(std::memory_order_acquire))
    there_.wait(there, std::memory_order_acquire);
  return there == memory_->size() ? status_ : Status();
}

}  // namespace gestus
