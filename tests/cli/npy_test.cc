// The .npy header parser on its own: what numpy writes is read, everything else is refused with a
// sentence.  npz_test.py compares whole files with numpy.
#include "models/cli/npy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace gestus::cli {
namespace {

ByteReader From(const std::string& bytes) {
  return [bytes, at = std::size_t{0}](void* data, std::size_t size) mutable {
    // Seven at a time, so that every element is split somewhere.
    const std::size_t n = std::min({size, bytes.size() - at, std::size_t{7}});
    std::memcpy(data, bytes.data() + at, n);
    at += n;
    return Result<std::size_t>(n);
  };
}

std::string File(const std::string& dict, const std::string& data) {
  std::string file("\x93NUMPY\x01\x00", 8);
  file.push_back(static_cast<char>(dict.size()));
  file.push_back('\0');
  return file + dict + data;
}

Result<models::Array> Read(const std::string& file, DType dtype) {
  return ReadNpy(From(file), file.size(), dtype, 1 << 20);
}

TEST(NpyHeader, FieldsAreRead) {
  const auto header =
      ParseNpyDict("{'descr': '>i8', 'fortran_order': True, 'shape': (3, 4, 5), }  \n", 1);
  ASSERT_TRUE(header.ok()) << header.status().message();
  EXPECT_EQ(header->kind, NpyKind::kInt);
  EXPECT_EQ(header->item_size, 8U);
  EXPECT_TRUE(header->big_endian);
  EXPECT_TRUE(header->fortran_order);
  EXPECT_EQ(header->shape, (std::vector<std::int64_t>{3, 4, 5}));
  EXPECT_EQ(header->elements, 60U);
  EXPECT_EQ(header->TypeName(), "int64");
}

TEST(NpyHeader, ScalarEmptyAndTupleOfOne) {
  const auto parse = [](const std::string& shape) {
    return ParseNpyDict("{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + "}", 1);
  };
  EXPECT_EQ(parse("()")->elements, 1U);
  EXPECT_EQ(parse("(3,)")->elements, 3U);
  EXPECT_EQ(parse("(3, 0)")->elements, 0U);
  EXPECT_FALSE(parse("(3)").ok());
  EXPECT_FALSE(parse("3").ok());
}

TEST(NpyHeader, WrittenHeadersAreReadAndAligned) {
  for (const std::vector<std::int64_t>& shape :
       {std::vector<std::int64_t>{}, {3}, {64, 768}, {1, 2, 3, 4}, {1000000000, 1}}) {
    const std::string text = NpyHeaderText(DType::kF32, shape);
    EXPECT_EQ(text.size() % 64, 0U);
    const auto header = ParseNpyDict(std::string_view(text).substr(10), 1);
    ASSERT_TRUE(header.ok()) << header.status().message();
    EXPECT_EQ(header->shape, shape);
    EXPECT_FALSE(header->fortran_order);
  }
}

TEST(Npy, FortranOrderIsTransposed) {
  const float stored[] = {1, 4, 2, 5, 3, 6};  // columns of ((1, 2, 3), (4, 5, 6))
  const auto array = Read(File("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3)}",
                               std::string(reinterpret_cast<const char*>(stored), sizeof(stored))),
                          DType::kF32);
  ASSERT_TRUE(array.ok()) << array.status().message();
  EXPECT_EQ(array->f32, (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

TEST(Npy, RangeErrorsNameTheIndex) {
  const std::int64_t stored[] = {1, 2, 3, std::int64_t{1} << 31};
  const auto array = Read(File("{'descr': '<i8', 'fortran_order': True, 'shape': (2, 2)}",
                               std::string(reinterpret_cast<const char*>(stored), sizeof(stored))),
                          DType::kI32);
  ASSERT_FALSE(array.ok());
  EXPECT_EQ(array.status().message(),
            "the number at [1, 1] is out of range, expected one that fits int32");
  const double large[] = {0, -0x1.fffffefffffffp127, 0x1.ffffffp127};
  const auto floats = Read(File("{'descr': '<f8', 'fortran_order': False, 'shape': (3,)}",
                                std::string(reinterpret_cast<const char*>(large), sizeof(large))),
                           DType::kF32);
  EXPECT_EQ(floats.status().message(),
            "the number at [2] is out of range, expected one that fits float32");
}

TEST(Npy, MemoryIsBoundedBeforeReading) {
  const std::string file = File("{'descr': '<f2', 'fortran_order': False, 'shape': (262145,)}", "");
  const auto array = ReadNpy(From(file), file.size() + 2 * 262145, DType::kF32, 1 << 20);
  EXPECT_EQ(array.status().message(),
            "float16 (262145,), expected at most 1048576 bytes in memory");
}

}  // namespace
}  // namespace gestus::cli
