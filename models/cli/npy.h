// Reads and writes the .npy format of numpy (NEP 1): one array, a short text header before its
// elements.  The reader takes numbers only and converts them to the element types of gestus;
// everything it does not understand is refused with a sentence, never guessed.
#ifndef GESTUS_MODELS_CLI_NPY_H_
#define GESTUS_MODELS_CLI_NPY_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/status.h"
#include "engine/tensor.h"
#include "models/network.h"

namespace gestus::cli {

enum class NpyKind : char { kFloat = 'f', kInt = 'i', kUnsigned = 'u', kBool = 'b' };

/// What a .npy header says.
struct NpyHeader {
  NpyKind kind = NpyKind::kFloat;
  std::size_t item_size = 4;  ///< bytes of one element
  bool big_endian = false;
  bool fortran_order = false;
  std::vector<std::int64_t> shape;
  std::uint64_t elements = 1;

  /// "float64"
  std::string TypeName() const;
};

/// Parses the text of a header, e.g. "{'descr': '<f4', 'fortran_order': False, 'shape': (3,), }".
/// `version` is the major format version, 1 to 3.
Result<NpyHeader> ParseNpyDict(std::string_view text, int version);

/// Fills `data` with up to `size` bytes and returns their number; 0 at the end.
using ByteReader = std::function<Result<std::size_t>(void* data, std::size_t size)>;

/// Reads one array of `total_size` bytes, header included, and converts it: floats to float32,
/// integers and bool to int32, both with a range check.  Nothing is allocated for elements before
/// the header has proven to agree with `total_size` and with `max_bytes` (of the converted array).
Result<models::Array> ReadNpy(const ByteReader& read, std::uint64_t total_size, DType wanted,
                              std::uint64_t max_bytes);

/// The header of a version 1.0 file for a C-order array, padded so that elements are 64-byte
/// aligned in the file.
std::string NpyHeaderText(DType dtype, const std::vector<std::int64_t>& shape);

/// "(64, 768)", "(3,)", "()": a shape as numpy prints it.
std::string ShapeText(const std::vector<std::int64_t>& shape);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_NPY_H_
