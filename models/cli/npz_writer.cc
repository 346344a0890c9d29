// Writing .npz: the archive is put together in memory by libzip, then written to the output file.
#include <zip.h>

#include <bit>
#include <memory>
#include <vector>

#include "models/cli/npy.h"
#include "models/cli/npz.h"

namespace gestus::cli {
namespace {

using models::Array;

static_assert(std::endian::native == std::endian::little, ".npy headers below declare '<'");

struct SourceCloser {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Source = std::unique_ptr<zip_source_t, SourceCloser>;

Status Failed(const char* why) {
  return Status(Code::kIo, std::string("archive cannot be made: ") + why);
}

// `header` must live until the archive is closed; elements are not copied.
Status AddArray(zip_t* archive, const std::string& name, const std::string& header,
                const Array& array) {
  const void* data = array.dtype == DType::kF32 ? static_cast<const void*>(array.f32.data())
                                                : static_cast<const void*>(array.i32.data());
  const std::size_t bytes = 4 * (array.f32.size() + array.i32.size());
  // libzip asks for writable pointers but only reads.
  zip_buffer_fragment_t parts[2] = {
      {reinterpret_cast<zip_uint8_t*>(const_cast<char*>(header.data())), header.size()},
      {static_cast<zip_uint8_t*>(const_cast<void*>(data)), bytes}};
  zip_source_t* source =
      zip_source_buffer_fragment(archive, parts, bytes == 0 ? 1 : 2, /*freep=*/0);
  if (source == nullptr) return Failed(zip_strerror(archive));
  const zip_int64_t index =
      zip_file_add(archive, (name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    return Failed(zip_strerror(archive));
  }
  const auto at = static_cast<zip_uint64_t>(index);
  constexpr zip_uint16_t kFirstDosDay = 0x21;  // 1980-01-01
  if (zip_set_file_compression(archive, at, ZIP_CM_STORE, 0) != 0 ||
      zip_file_set_dostime(archive, at, 0, kFirstDosDay, 0) != 0) {
    return Failed(zip_strerror(archive));
  }
  return Status();
}

// Closes the archive into `target`, a growing buffer in memory that outlives it.
Status Assemble(const models::Arrays& arrays, zip_source_t* target) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_keep(target);
  zip_t* archive = zip_open_from_source(target, ZIP_TRUNCATE, &error);
  if (archive == nullptr) {
    zip_source_free(target);
    return Failed(zip_error_strerror(&error));
  }
  std::vector<std::string> headers;
  headers.reserve(arrays.size());
  for (const auto& [name, array] : arrays) {
    headers.push_back(NpyHeaderText(array.dtype, array.shape));
    if (Status status = AddArray(archive, name, headers.back(), array); !status.ok()) {
      zip_discard(archive);
      return status;
    }
  }
  if (zip_close(archive) != 0) {
    const Status status = Failed(zip_strerror(archive));
    zip_discard(archive);
    return status;
  }
  return Status();
}

}  // namespace

Status WriteNpz(const models::Arrays& arrays, AtomicFile* file) {
  const Source target(zip_source_buffer_create(nullptr, 0, 0, nullptr));
  if (target == nullptr) return Failed("no memory");
  GESTUS_RETURN_IF_ERROR(Assemble(arrays, target.get()));
  if (zip_source_open(target.get()) != 0) {
    return Failed(zip_error_strerror(zip_source_error(target.get())));
  }
  std::vector<char> chunk(1 << 16);
  zip_int64_t n = 0;
  while ((n = zip_source_read(target.get(), chunk.data(), chunk.size())) > 0) {
    GESTUS_RETURN_IF_ERROR(file->Write(chunk.data(), static_cast<std::size_t>(n)));
  }
  zip_source_close(target.get());
  return n == 0 ? Status() : Failed("it cannot be read back");
}

}  // namespace gestus::cli
