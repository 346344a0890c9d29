// Opens a weights file in the order that docs/format.md gives: each step relies only on what the
// steps before it have proven.
#include "engine/weights_file.h"

#include <algorithm>
#include <cstring>
#include <set>

#include "engine/file_scan.h"
#include "engine/packed_weights.h"
#include "kernels/kernels.h"
#include "weights_generated.h"

namespace gestus {
namespace {

constexpr std::uint64_t kAlign = 64;
constexpr std::uint64_t kHeaderSize = 64;
constexpr std::uint64_t kMinFileSize = kHeaderSize + kAlign;
constexpr std::uint64_t kMaxFileSize = std::uint64_t{1} << 36;
constexpr std::uint64_t kMaxMetadataSize = std::uint64_t{64} << 20;
constexpr std::uint32_t kFormatVersion = 1;
constexpr std::uint32_t kEndianMark = 0x01020304;
constexpr char kMagic[8] = {'G', 'E', 'S', 'T', 'U', 'S', 'W', '\0'};
constexpr std::size_t kMaxNameLength = 255;
constexpr std::int64_t kMaxDim = std::int64_t{1} << 24;
constexpr int kMaxDepth = 8;
constexpr int kMaxTables = 1 << 16;
constexpr std::uint64_t kMaxI8Depth = kernels::kMaxI8Depth;

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "weights files are little endian");

struct Header {
  char magic[8];
  std::uint32_t format_version;
  std::uint32_t endian_mark;
  std::uint64_t file_size;
  std::uint64_t metadata_size;
  std::uint64_t data_size;
  std::uint8_t reserved[16];
  std::uint64_t checksum;
};
static_assert(sizeof(Header) == kHeaderSize && FileScan::kHeaderSize == kHeaderSize &&
              FileScan::kChecksumOffset == offsetof(Header, checksum));

Header ReadHeader(const std::uint8_t* base) {
  Header h;
  std::memcpy(&h, base, sizeof h);
  return h;
}

std::uint64_t AlignUp(std::uint64_t n) { return (n + kAlign - 1) / kAlign * kAlign; }

Status Bad(std::string message) { return Status(Code::kBadWeights, std::move(message)); }

Status CheckHeader(const Header& h, std::uint64_t size) {
  if (std::memcmp(h.magic, kMagic, sizeof kMagic) != 0)
    return Bad("header: no gestus weights file, expected it to begin with GESTUSW");
  if (h.endian_mark != kEndianMark) return Bad("header: byte order mark is damaged");
  if (h.format_version == 0 || h.format_version > kFormatVersion)
    return Bad("header: format version " + std::to_string(h.format_version) +
               ", expected at most " + std::to_string(kFormatVersion) + " (use a newer gestus)");
  if (h.file_size != size)
    return Bad("header: file has " + std::to_string(size) + " bytes, expected " +
               std::to_string(h.file_size) + " (truncated or still being written?)");
  for (std::uint8_t byte : h.reserved) {
    if (byte != 0) return Bad("header: reserved bytes are not zero");
  }
  if (h.metadata_size < 16 || h.metadata_size > kMaxMetadataSize ||
      h.metadata_size > size - kHeaderSize)
    return Bad("header: metadata size " + std::to_string(h.metadata_size) + " is out of range");
  const std::uint64_t data_offset = AlignUp(kHeaderSize + h.metadata_size);
  if (data_offset > size || h.data_size != size - data_offset || h.data_size % kAlign != 0 ||
      h.data_size < kAlign)
    return Bad("header: data size " + std::to_string(h.data_size) +
               " does not fit the file's size");
  return {};
}

/// Fit for a message: printable ASCII, at most 255 bytes.
bool Printable(std::string_view text) {
  return text.size() <= kMaxNameLength && std::all_of(text.begin(), text.end(), [](char c) {
           const auto u = static_cast<unsigned char>(c);
           return u >= 0x20 && u < 0x7f;
         });
}

bool PrintableName(std::string_view name) { return !name.empty() && Printable(name); }

bool Convert(fb::DType from, DType* to) {
  switch (from) {
    case fb::DType::F32:
      *to = DType::kF32;
      return true;
    case fb::DType::I32:
      *to = DType::kI32;
      return true;
    case fb::DType::U8:
      *to = DType::kU8;
      return true;
    case fb::DType::BF16:
      *to = DType::kBF16;
      return true;
    case fb::DType::I8:
      *to = DType::kI8;
      return true;
    default:
      return false;
  }
}

/// Whether no exponent of n floats of the bits Bits is that of NaN and infinity.
template <class Bits>
bool AllFinite(const std::uint8_t* p, std::uint64_t bytes, Bits exponent_mask) {
  for (std::uint64_t i = 0; i + sizeof(Bits) <= bytes; i += sizeof(Bits)) {
    Bits bits;
    std::memcpy(&bits, p + i, sizeof bits);
    if ((bits & exponent_mask) == exponent_mask) return false;
  }
  return true;
}

bool GoodValues(DType dtype, const std::uint8_t* p, std::uint64_t bytes) {
  if (dtype == DType::kF32) return AllFinite<std::uint32_t>(p, bytes, 0x7f800000u);
  if (dtype == DType::kBF16) return AllFinite<std::uint16_t>(p, bytes, 0x7f80u);
  return dtype != DType::kI8 || std::memchr(p, 0x80, bytes) == nullptr;
}

/// The bytes of a file, and what its scan found.
struct Scanned {
  const std::uint8_t* file;
  std::uint64_t size;
  const FileScan& scan;

  /// Looks at the values of the blocks that the scan suspects; a block may hold other tensors too.
  bool Good(DType dtype, const std::uint8_t* data, std::uint64_t bytes) const {
    const auto begin = static_cast<std::uint64_t>(data - file);
    for (std::uint64_t at = begin, end; at < begin + bytes; at = end) {
      const std::uint64_t block = at / FileScan::kBlock;
      end = std::min(begin + bytes, (block + 1) * FileScan::kBlock);
      if (scan.MayBeBad(dtype, block) && !GoodValues(dtype, file + at, end - at)) return false;
    }
    return true;
  }
};

/// What the numbers of a tensor must be.
Status CheckValues(const Scanned& scanned, const TensorView& view, std::uint64_t bytes,
                   const std::string& where) {
  const bool i8 = view.dtype == DType::kI8;
  if (i8 && view.shape.rank() < 2) return Bad(where + "I8 with fewer than two dimensions");
  const std::uint64_t depth = i8 ? bytes / static_cast<std::uint64_t>(view.shape[0]) : 0;
  if (depth > kMaxI8Depth)
    return Bad(where + "rows of " + std::to_string(depth) + " I8 elements, expected at most " +
               std::to_string(kMaxI8Depth) + ", whose sums fit 32 bits");
  if (scanned.Good(view.dtype, static_cast<const std::uint8_t*>(view.data), bytes)) return {};
  return Bad(where + (i8 ? "holds -128, expected -127 to 127"
                         : "holds NaN or infinity, expected finite weights"));
}

/// Checks one tensor record and makes its view; `end` is where the previous payload ended.
Status CheckTensor(const fb::Tensor& t, std::size_t index, const Scanned& scanned,
                   std::uint64_t data_offset, std::uint64_t* end, WeightsFile::Entry* entry) {
  const std::string_view name = t.name()->string_view();
  if (!PrintableName(name))
    return Bad("tensor number " + std::to_string(index) +
               ": name is empty, longer than 255 bytes or not printable");
  entry->name = name;
  const std::string where = "tensor " + entry->name + ": ";
  if (!Convert(t.dtype(), &entry->view.dtype))
    return Bad(where + "dtype " + std::to_string(static_cast<int>(t.dtype())) +
               ", expected one that this version reads (F32, I32, U8, BF16, I8)");
  std::uint64_t elements = 1;
  const std::size_t rank = t.shape() == nullptr ? 0 : t.shape()->size();
  if (rank > Shape::kMaxRank)
    return Bad(where + "rank " + std::to_string(rank) + ", expected at most 4");
  for (flatbuffers::uoffset_t i = 0; i < rank; ++i) {
    const std::uint32_t dim = t.shape()->Get(i);
    if (dim == 0 || dim > kMaxDim)
      return Bad(where + "dimension " + std::to_string(i) + " is " + std::to_string(dim) +
                 ", expected 1 to 2^24");
    if (elements > kMaxFileSize / dim) return Bad(where + "shape overflows");
    elements *= dim;
    entry->view.shape.Append(dim);
  }
  const std::uint64_t bytes = elements * SizeOf(entry->view.dtype);
  if (t.bytes() != bytes)
    return Bad(where + std::to_string(t.bytes()) + " bytes, expected " + std::to_string(bytes) +
               " for shape " + entry->view.shape.ToString());
  if (t.offset() % kAlign != 0)
    return Bad(where + "offset " + std::to_string(t.offset()) + ", expected a multiple of 64");
  if (t.offset() < *end) return Bad(where + "payload overlaps the one before it");
  // The last 64 bytes of the region are padding that kernels may read past the last tensor.
  const std::uint64_t data_size = scanned.size - data_offset;
  if (bytes > data_size - kAlign || t.offset() > data_size - kAlign - bytes)
    return Bad(where + "payload ends outside the data region");
  *end = AlignUp(t.offset() + bytes);
  entry->bytes = bytes;
  entry->view.data = scanned.file + data_offset + t.offset();
  const bool scaled = t.scale() != nullptr && t.scale()->size() > 0;
  if (scaled != (entry->view.dtype == DType::kI8))
    return Bad(where + (scaled ? "has a scale, which only I8 has" : "I8 without a scale"));
  if (scaled) {
    if (!PrintableName(t.scale()->string_view()))
      return Bad(where + "name of its scale is longer than 255 bytes or not printable");
    entry->scale = t.scale()->str();
  }
  return CheckValues(scanned, entry->view, bytes, where);
}

Status CheckJoints(const flatbuffers::Vector<flatbuffers::Offset<fb::Joint>>* joints,
                   const std::string& what) {
  if (joints == nullptr) return {};
  const std::int64_t count = joints->size();
  for (std::int64_t i = 0; i < count; ++i) {
    const fb::Joint& joint = *joints->Get(static_cast<flatbuffers::uoffset_t>(i));
    const std::string where = what + " number " + std::to_string(i) + ": ";
    if (!PrintableName(joint.name()->string_view()))
      return Bad(where + "name is empty, longer than 255 bytes or not printable");
    if (joint.parent() < -1 || joint.parent() >= count || joint.parent() == i)
      return Bad(where + "parent is " + std::to_string(joint.parent()) +
                 ", expected -1 or another joint's number");
  }
  return {};
}

/// Everything of a network that a message may quote.
Status CheckTexts(const fb::Network& n) {
  if (!Printable(n.prefix()->string_view())) return Bad("prefix is too long or not printable");
  if (n.features() != nullptr) {
    GESTUS_RETURN_IF_ERROR(CheckJoints(n.features()->landmarks(), "landmark"));
    if (n.features()->tags() != nullptr) {
      for (const flatbuffers::String* tag : *n.features()->tags()) {
        if (!PrintableName(tag->string_view()))
          return Bad("features: a tag is empty, longer than 255 bytes or not printable");
      }
    }
  }
  if (const fb::SelfTest* test = n.self_test()) {
    bool good =
        Printable(test->output()->string_view()) && Printable(test->output_name()->string_view());
    for (const auto* names : {test->inputs(), test->input_names()}) {
      for (const flatbuffers::String* name : *names) good = good && Printable(name->string_view());
    }
    if (!good) return Bad("self-test: a name is too long or not printable");
  }
  return {};
}

Status CheckNetworks(const fb::WeightsFile& root) {
  std::vector<std::string_view> names;
  for (const fb::Network* n : *root.networks()) {
    const std::string_view name = n->name()->string_view();
    if (!PrintableName(name)) return Bad("a network's name is empty, too long or not printable");
    if (n->config_type() == fb::Config::NONE || n->config() == nullptr)
      return Bad("network " + std::string(name) + ": no configuration");
    if (static_cast<std::uint8_t>(n->config_type()) > static_cast<std::uint8_t>(fb::Config::MAX))
      return Bad("network " + std::string(name) + ": of a kind this version does not know");
    GESTUS_RETURN_IF_ERROR(CheckJoints(n->joints(), "joint").In("network " + std::string(name)));
    GESTUS_RETURN_IF_ERROR(CheckTexts(*n).In("network " + std::string(name)));
    names.push_back(name);
  }
  if (names.empty()) return Bad("networks: none in the file, expected at least one");
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) return Bad("network " + std::string(*twice) + ": name is used twice");
  return {};
}

}  // namespace

WeightsFile::WeightsFile() : packed_(std::make_unique<PackedWeights>(&memory_)) {}
WeightsFile::~WeightsFile() = default;

Result<std::shared_ptr<const WeightsFile>> WeightsFile::Open(const std::string& path,
                                                             const LoadOptions& options) {
  std::shared_ptr<WeightsFile> result(new WeightsFile);
  result->path_ = path;
  const bool mapped = options.residence == Residence::kMapped;
  GESTUS_RETURN_IF_ERROR(result->memory_.Open(path, mapped, kMinFileSize, kMaxFileSize).In(path));
  GESTUS_RETURN_IF_ERROR(result->Check().In(path));
  return std::shared_ptr<const WeightsFile>(std::move(result));
}

Result<std::shared_ptr<const WeightsFile>> WeightsFile::FromMemory(const void* data,
                                                                   std::size_t size,
                                                                   const std::string& name) {
  if (data == nullptr || size < kMinFileSize)
    return Bad(name + ": " + std::to_string(size) + " bytes, expected at least " +
               std::to_string(kMinFileSize));
  std::shared_ptr<WeightsFile> result(new WeightsFile);
  result->path_ = name;
  GESTUS_RETURN_IF_ERROR(result->memory_.Copy(data, size).In(name));
  GESTUS_RETURN_IF_ERROR(result->Check().In(name));
  return std::shared_ptr<const WeightsFile>(std::move(result));
}

Status WeightsFile::ReadAndHash(FileScan* scan) {
  for (FileMemory::Range block; block.begin < memory_.size(); block.begin = block.end) {
    block.end = std::min(memory_.size(), block.begin + FileScan::kBlock);
    GESTUS_RETURN_IF_ERROR(memory_.Fill(block));
    // The header lies in the first block: what is no weights file is not read any further.
    if (block.begin == 0)
      GESTUS_RETURN_IF_ERROR(CheckHeader(ReadHeader(memory_.data()), memory_.size()));
    scan->Add(memory_.data() + block.begin, block.end - block.begin);
  }
  return {};
}

Status WeightsFile::Check() {
  FileScan scan;
  GESTUS_RETURN_IF_ERROR(ReadAndHash(&scan));
  if (scan.Checksum() != checksum())
    return Bad("checksum: the content does not match it, the file is damaged");

  const std::uint8_t* metadata = memory_.data() + kHeaderSize;
  flatbuffers::Verifier verifier(metadata, ReadHeader(memory_.data()).metadata_size, kMaxDepth,
                                 kMaxTables);
  if (!fb::VerifyWeightsFileBuffer(verifier))
    return Bad("metadata: not a valid FlatBuffer of identifier GSTW");
  root_ = fb::GetWeightsFile(metadata);

  GESTUS_RETURN_IF_ERROR(CheckNetworks(*root_));
  return CheckTensors(scan);
}

Status WeightsFile::CheckTensors(const FileScan& scan) {
  const std::uint8_t* file = memory_.data();
  const std::uint64_t data_offset = AlignUp(kHeaderSize + ReadHeader(file).metadata_size);
  const Scanned scanned{file, memory_.size(), scan};
  std::uint64_t end = 0;
  tensors_.reserve(root_->tensors()->size());
  for (const fb::Tensor* t : *root_->tensors()) {
    Entry entry;
    GESTUS_RETURN_IF_ERROR(CheckTensor(*t, tensors_.size(), scanned, data_offset, &end, &entry));
    tensors_.push_back(std::move(entry));
  }
  std::sort(tensors_.begin(), tensors_.end(),
            [](const Entry& a, const Entry& b) { return a.name < b.name; });
  const auto twice =
      std::adjacent_find(tensors_.begin(), tensors_.end(),
                         [](const Entry& a, const Entry& b) { return a.name == b.name; });
  if (twice != tensors_.end()) return Bad("tensor " + twice->name + ": name is used twice");
  return FindScales();
}

Status WeightsFile::FindScales() {
  std::set<std::string_view> taken;
  for (Entry& entry : tensors_) {
    if (entry.scale.empty()) continue;
    const std::string where = "tensor " + entry.name + ": scale " + entry.scale + ": ";
    const Entry* scale = Find(entry.scale);
    const Shape wanted{entry.view.shape[0]};
    if (scale == nullptr) return Bad(where + "no such tensor, expected " + wanted.ToString());
    if (scale->view.dtype != DType::kF32 || !(scale->view.shape == wanted))
      return Bad(where + scale->view.shape.ToString() + " " + gestus::Name(scale->view.dtype) +
                 ", expected " + wanted.ToString() + " float32");
    const float* values = scale->view.f32();
    if (!std::all_of(values, values + wanted[0], [](float x) { return x > 0; }))
      return Bad(where + "holds zero or less, expected scales above zero");
    if (!taken.insert(scale->name).second)
      return Bad(where + "belongs to another tensor too, expected one of its own");
    entry.view.scale = values;
  }
  return {};
}

std::uint64_t WeightsFile::checksum() const { return ReadHeader(memory_.data()).checksum; }
std::uint32_t WeightsFile::format_version() const {
  return ReadHeader(memory_.data()).format_version;
}

const WeightsFile::Entry* WeightsFile::Find(std::string_view name) const {
  const auto it = std::lower_bound(tensors_.begin(), tensors_.end(), name,
                                   [](const Entry& e, std::string_view n) { return e.name < n; });
  return it != tensors_.end() && it->name == name ? &*it : nullptr;
}

const fb::Network* WeightsFile::FindNetwork(std::string_view name) const {
  const auto& networks = *root_->networks();
  if (name.empty()) return networks.size() == 1 ? networks.Get(0) : nullptr;
  for (const fb::Network* n : networks) {
    if (n->name()->string_view() == name) return n;
  }
  return nullptr;
}

}  // namespace gestus
