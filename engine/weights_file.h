// A weights file, opened and checked: everything behind these accessors has passed the checksum,
// the FlatBuffers verifier and the semantic pass (docs/format.md), so that later layers may use it
// without asking again.
#ifndef GESTUS_ENGINE_WEIGHTS_FILE_H_
#define GESTUS_ENGINE_WEIGHTS_FILE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/file_memory.h"
#include "engine/status.h"
#include "engine/tensor.h"

namespace gestus {

namespace fb {
struct WeightsFile;
struct Network;
}  // namespace fb

class FileScan;
class PackedWeights;

/// Where the bytes are.  With both, a tensor's pages go back to the operating system once it is
/// packed for the kernels (weight_cache.h), so that memory never holds much more than the file.
enum class Residence {
  kMapped,  ///< mmap: memory that the kernel may take back; the file must stay as it is
  kCopied   ///< private copy: nothing that happens to the file later matters to what was planned
};

struct LoadOptions {
  Residence residence = Residence::kMapped;
};

class WeightsFile {
 public:
  struct Entry {
    std::string name;
    TensorView view;
    std::uint64_t bytes = 0;
    std::string scale{};  ///< int8: the tensor of its scales
  };

  static Result<std::shared_ptr<const WeightsFile>> Open(const std::string& path,
                                                         const LoadOptions& options = {});
  /// Copies `size` bytes from memory; `name` stands for the path in messages.
  static Result<std::shared_ptr<const WeightsFile>> FromMemory(const void* data, std::size_t size,
                                                               const std::string& name);
  ~WeightsFile();
  WeightsFile(const WeightsFile&) = delete;
  WeightsFile& operator=(const WeightsFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t file_size() const { return memory_.size(); }
  std::uint64_t checksum() const;
  std::uint32_t format_version() const;
  const fb::WeightsFile& root() const { return *root_; }

  /// Tensors in the order of their names.
  const std::vector<Entry>& tensors() const { return tensors_; }
  /// Null when there is none.
  const Entry* Find(std::string_view name) const;
  /// Null when there is none; the only network when `name` is empty and there is just one.
  const fb::Network* FindNetwork(std::string_view name) const;

  /// What is packed of this file, by whichever model.
  PackedWeights& packed() const { return *packed_; }

 private:
  WeightsFile();
  Status Check();
  Status ReadAndHash(FileScan* scan);
  Status CheckTensors(const FileScan& scan);
  Status FindScales();

  std::string path_;
  mutable FileMemory memory_;  // mutable: what is packed goes and may come back, under a lock
  std::unique_ptr<PackedWeights> packed_;
  const fb::WeightsFile* root_ = nullptr;
  std::vector<Entry> tensors_;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_WEIGHTS_FILE_H_
