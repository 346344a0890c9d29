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

#include "engine/status.h"
#include "engine/tensor.h"

namespace gestus {

namespace fb {
struct WeightsFile;
struct Network;
}  // namespace fb

enum class Residence {
  kMapped,  ///< mmap: starts fast, pages shared between processes; the file must not be truncated
  kCopied   ///< private copy: nothing that happens to the file later matters
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
  std::uint64_t file_size() const { return size_; }
  std::uint64_t checksum() const;
  std::uint32_t format_version() const;
  const fb::WeightsFile& root() const { return *root_; }

  /// Tensors in the order of their names.
  const std::vector<Entry>& tensors() const { return tensors_; }
  /// Null when there is none.
  const Entry* Find(std::string_view name) const;
  /// Null when there is none; the only network when `name` is empty and there is just one.
  const fb::Network* FindNetwork(std::string_view name) const;

  /// Tells the operating system that the pages of `view` are not needed soon (mapped files only);
  /// they are read back from the file when touched again.
  void GiveBack(const TensorView& view) const;

 private:
  WeightsFile() = default;
  Status Check();
  Status FindScales();

  std::string path_;
  const std::uint8_t* base_ = nullptr;
  std::uint64_t size_ = 0;
  bool mapped_ = false;
  const fb::WeightsFile* root_ = nullptr;
  std::vector<Entry> tensors_;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_WEIGHTS_FILE_H_
