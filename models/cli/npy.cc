// Reads the elements of a .npy file: from either byte order, any width and either storage order
// into float32 or int32 in C order.
#include "models/cli/npy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace gestus::cli {
namespace {

using models::Array;

constexpr std::size_t kMaxHeader = 10000;     // characters; numpy's own limit
constexpr std::size_t kChunkBytes = 1 << 16;  // a multiple of every element size

// Elements are copied, never cast in place: in an .npz they start at odd offsets.
std::uint64_t LoadBits(const std::uint8_t* p, std::size_t size, bool big_endian) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    bits |= std::uint64_t{p[i]} << (8 * (big_endian ? size - 1 - i : i));
  }
  return bits;
}

// IEEE binary16 to binary32; every value is exact.
float HalfToFloat(std::uint32_t half) {
  const std::uint32_t sign = (half & 0x8000U) << 16;
  const std::uint32_t exponent = (half >> 10) & 0x1fU;
  const std::uint32_t fraction = half & 0x3ffU;
  if (exponent == 0) {  // zero or denormal: fraction * 2^-24
    const float value = static_cast<float>(fraction) * 0x1p-24F;
    return sign != 0 ? -value : value;
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + 112;  // 112 = 127 - 15
  return std::bit_cast<float>(sign | (wide << 23) | (fraction << 13));
}

std::string IndexText(const std::vector<std::int64_t>& shape, std::uint64_t flat, bool fortran) {
  std::vector<std::uint64_t> index(shape.size());
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const std::size_t axis = fortran ? i : shape.size() - 1 - i;
    index[axis] = flat % static_cast<std::uint64_t>(shape[axis]);
    flat /= static_cast<std::uint64_t>(shape[axis]);
  }
  std::string text = "[";
  for (std::size_t i = 0; i < index.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(index[i]);
  }
  return text + "]";
}

// Both append `count` elements and return how many fitted their type.
std::size_t AppendFloats(const NpyHeader& header, const std::uint8_t* bytes, std::size_t count,
                         std::vector<float>* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t bits =
        LoadBits(bytes + i * header.item_size, header.item_size, header.big_endian);
    if (header.item_size == 2) {
      out->push_back(HalfToFloat(static_cast<std::uint32_t>(bits)));
    } else if (header.item_size == 4) {
      out->push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    } else {
      // From half a unit above the largest float on, rounding gives infinity.
      const auto value = std::bit_cast<double>(bits);
      if (std::isfinite(value) && std::fabs(value) >= 0x1.ffffffp127) return i;
      out->push_back(static_cast<float>(value));
    }
  }
  return count;
}

std::size_t AppendInts(const NpyHeader& header, const std::uint8_t* bytes, std::size_t count,
                       std::vector<std::int32_t>* out) {
  const unsigned unused = static_cast<unsigned>(64 - 8 * header.item_size);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t bits =
        LoadBits(bytes + i * header.item_size, header.item_size, header.big_endian);
    // Shifting up and down again extends the sign.
    const std::int64_t value = header.kind == NpyKind::kInt
                                   ? static_cast<std::int64_t>(bits << unused) >> unused
                                   : static_cast<std::int64_t>(bits);
    const bool wraps = header.kind == NpyKind::kUnsigned && value < 0;
    const bool strange = header.kind == NpyKind::kBool && value > 1;
    if (wraps || strange || value < std::numeric_limits<std::int32_t>::min() ||
        value > std::numeric_limits<std::int32_t>::max()) {
      return i;
    }
    out->push_back(static_cast<std::int32_t>(value));
  }
  return count;
}

Status ReadExactly(const ByteReader& read, void* data, std::size_t size) {
  auto* bytes = static_cast<std::uint8_t*>(data);
  while (size > 0) {
    const Result<std::size_t> n = read(bytes, size);
    if (!n.ok()) return n.status();
    if (*n == 0)
      return BadInput("ends " + std::to_string(size) + " bytes early, expected a whole array");
    bytes += *n;
    size -= *n;
  }
  return Status();
}

// Reads magic, version, length and dictionary; adds their bytes to `consumed`.
Result<NpyHeader> ReadHeader(const ByteReader& read, std::uint64_t total_size,
                             std::uint64_t* consumed) {
  std::uint8_t start[8];
  if (total_size < sizeof(start)) {
    return BadInput(std::to_string(total_size) + " bytes, expected a .npy array");
  }
  GESTUS_RETURN_IF_ERROR(ReadExactly(read, start, sizeof(start)));
  if (std::memcmp(start, "\x93NUMPY", 6) != 0) {
    return BadInput("does not start with \\x93NUMPY, expected a .npy array");
  }
  if (start[6] < 1 || start[6] > 3 || start[7] != 0) {
    return BadInput(".npy format version " + std::to_string(start[6]) + "." +
                    std::to_string(start[7]) + ", expected 1.0, 2.0 or 3.0");
  }
  std::uint8_t length_bytes[4];
  const std::size_t length_size = start[6] == 1 ? 2 : 4;
  GESTUS_RETURN_IF_ERROR(ReadExactly(read, length_bytes, length_size));
  const std::uint64_t length = LoadBits(length_bytes, length_size, /*big_endian=*/false);
  if (length > kMaxHeader) {
    return BadInput("header of " + std::to_string(length) + " bytes, expected at most " +
                    std::to_string(kMaxHeader));
  }
  std::string text(length, '\0');
  GESTUS_RETURN_IF_ERROR(ReadExactly(read, text.data(), text.size()));
  *consumed = sizeof(start) + length_size + length;
  return ParseNpyDict(text, start[6]);
}

Status CheckHeader(const NpyHeader& header, std::uint64_t data_bytes, DType wanted,
                   std::uint64_t max_bytes) {
  const bool is_float = header.kind == NpyKind::kFloat;
  if (is_float != (wanted == DType::kF32)) {
    return BadInput(header.TypeName() + " " + ShapeText(header.shape) + ", expected " +
                    (wanted == DType::kF32 ? "float32 (float16 and float64 are converted)"
                                           : "int32 (other integers and bool are converted)"));
  }
  const std::uint64_t expected = header.elements * header.item_size;
  if (data_bytes != expected) {
    return BadInput(std::to_string(data_bytes) + " bytes of elements, expected " +
                    std::to_string(expected) + " for " + header.TypeName() + " " +
                    ShapeText(header.shape));
  }
  if (header.elements > max_bytes / 4) {
    return BadInput(header.TypeName() + " " + ShapeText(header.shape) + ", expected at most " +
                    std::to_string(max_bytes) + " bytes in memory");
  }
  return Status();
}

template <class T>
void ToCOrder(const std::vector<std::int64_t>& shape, std::vector<T>* values) {
  std::vector<T> sorted(values->size());
  std::vector<std::int64_t> index(shape.size(), 0);
  std::vector<std::size_t> stride(shape.size(), 1);  // of the C order
  for (std::size_t axis = shape.size(); axis-- > 1;) {
    stride[axis - 1] = stride[axis] * static_cast<std::size_t>(shape[axis]);
  }
  std::size_t target = 0;
  for (const T& value : *values) {  // the first axis runs fastest
    sorted[target] = value;
    for (std::size_t axis = 0; axis < shape.size(); ++axis) {
      target += stride[axis];
      if (++index[axis] < shape[axis]) break;
      target -= stride[axis] * static_cast<std::size_t>(shape[axis]);
      index[axis] = 0;
    }
  }
  values->swap(sorted);
}

Status ReadElements(const ByteReader& read, const NpyHeader& header, Array* array) {
  array->dtype == DType::kF32 ? array->f32.reserve(header.elements)
                              : array->i32.reserve(header.elements);
  std::vector<std::uint8_t> chunk(kChunkBytes);
  const std::size_t per_chunk = kChunkBytes / header.item_size;
  for (std::uint64_t done = 0; done < header.elements;) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(per_chunk, header.elements - done));
    GESTUS_RETURN_IF_ERROR(ReadExactly(read, chunk.data(), count * header.item_size));
    const std::size_t fitted = array->dtype == DType::kF32
                                   ? AppendFloats(header, chunk.data(), count, &array->f32)
                                   : AppendInts(header, chunk.data(), count, &array->i32);
    if (fitted < count) {
      return BadInput("the number at " +
                      IndexText(header.shape, done + fitted, header.fortran_order) +
                      " is out of range, expected one that fits " +
                      (header.kind == NpyKind::kBool ? "a bool" : Name(array->dtype)));
    }
    done += count;
  }
  return Status();
}

}  // namespace

Result<Array> ReadNpy(const ByteReader& read, std::uint64_t total_size, DType wanted,
                      std::uint64_t max_bytes) {
  std::uint64_t header_bytes = 0;
  Result<NpyHeader> header = ReadHeader(read, total_size, &header_bytes);
  if (!header.ok()) return header.status();
  if (total_size < header_bytes) return BadInput("ends inside its header, expected a whole array");
  GESTUS_RETURN_IF_ERROR(CheckHeader(*header, total_size - header_bytes, wanted, max_bytes));

  Array array;
  array.dtype = wanted;
  array.shape = header->shape;
  GESTUS_RETURN_IF_ERROR(ReadElements(read, *header, &array));
  // The end must come now; asking for it also makes the source compare its checksum.
  std::uint8_t extra = 0;
  const Result<std::size_t> rest = read(&extra, 1);
  if (!rest.ok()) return rest.status();
  if (*rest != 0)
    return BadInput("more bytes than declared, expected " + std::to_string(total_size));

  if (header->fortran_order && header->shape.size() > 1) {
    wanted == DType::kF32 ? ToCOrder(array.shape, &array.f32) : ToCOrder(array.shape, &array.i32);
  }
  return array;
}

}  // namespace gestus::cli
