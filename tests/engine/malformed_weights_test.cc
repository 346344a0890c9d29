// Every kind of malformed weights file that we could think of, each with what its one-line message
// must say.  The classes come from the histories of other engines: fields that a verifier lets
// pass, sizes that wrap, offsets that point elsewhere, names that are no names.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "engine/weights_file.h"
#include "tests/engine/temp_file.h"
#include "tests/engine/weights_builder.h"

namespace gestus::test {
namespace {

constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();

struct Case {
  const char* name;
  const char* expect;  ///< part of the message
  Bytes bytes;
};

using Cases = std::vector<Case>;

/// A good file with one change to its bytes, the checksum fitting again.
Bytes Patched(const std::function<void(Bytes*)>& change, FileSpec spec = GoodFile()) {
  Bytes bytes = spec.Build();
  change(&bytes);
  if (bytes.size() >= kMetadataAt) RefreshChecksum(&bytes);
  return bytes;
}

template <class T>
Bytes WithField(std::size_t at, T value) {
  return Patched([&](Bytes* b) { Put<T>(b, at, value); });
}

template <class T>
Bytes WithAdded(std::size_t at, T delta) {
  return Patched([&](Bytes* b) { Put<T>(b, at, static_cast<T>(Get<T>(*b, at) + delta)); });
}

Bytes Foreign(const std::string& beginning) {
  Bytes bytes(256);
  std::copy(beginning.begin(), beginning.end(), bytes.begin());
  return bytes;
}

void AddHeaderCases(Cases* cases) {
  cases->insert(
      cases->end(),
      {
          {"AllZeros", "begin with GESTUSW", Bytes(512, 0)},
          {"AllOnes", "begin with GESTUSW", Bytes(512, 0xff)},
          {"MagicInLowerCase", "begin with GESTUSW", Patched([](Bytes* b) { (*b)[0] = 'g'; })},
          {"MagicWithoutItsEnd", "begin with GESTUSW", Patched([](Bytes* b) { (*b)[7] = 1; })},
          {"Elf", "begin with GESTUSW",
           Foreign("\x7f"
                   "ELF\x02\x01\x01")},
          {"Gguf", "begin with GESTUSW", Foreign("GGUF\x03")},
          {"Zip", "begin with GESTUSW", Foreign("PK\x03\x04")},
          {"TfLite", "begin with GESTUSW", Foreign("\x1c\0\0\0TFL3")},
          {"Safetensors", "begin with GESTUSW", Foreign("\x40\0\0\0\0\0\0\0{\"a\":")},
          {"BareFlatBuffer", "begin with GESTUSW",
           [] {
             Bytes b = GoodFile().Build();
             b.erase(b.begin(), b.begin() + kMetadataAt);
             return b;
           }()},
          {"VersionZero", "format version 0", WithField<std::uint32_t>(kVersionAt, 0)},
          {"VersionTwo", "format version 2, expected at most 1",
           WithField<std::uint32_t>(kVersionAt, 2)},
          {"VersionMax", "format version 4294967295",
           WithField<std::uint32_t>(kVersionAt, 0xffffffffu)},
          {"BigEndian", "byte order", WithField<std::uint32_t>(kEndianAt, 0x04030201)},
          {"NoEndianMark", "byte order", WithField<std::uint32_t>(kEndianAt, 0)},
          {"FileSizeZero", "expected 0", WithField<std::uint64_t>(kFileSizeAt, 0)},
          {"FileSizeMax", "expected 18446744073709551615",
           WithField<std::uint64_t>(kFileSizeAt, kMax)},
          {"FileSizeOneMore", "truncated", WithAdded<std::uint64_t>(kFileSizeAt, 1)},
          {"FileSizeOneLess", "truncated", WithAdded<std::uint64_t>(kFileSizeAt, kMax)},
          {"FirstReservedByte", "reserved", WithField<std::uint8_t>(kReservedAt, 1)},
          {"LastReservedByte", "reserved", WithField<std::uint8_t>(kReservedAt + 15, 0x80)},
          {"MetadataSizeZero", "metadata size 0", WithField<std::uint64_t>(kMetadataSizeAt, 0)},
          {"MetadataSizeTiny", "metadata size 15", WithField<std::uint64_t>(kMetadataSizeAt, 15)},
          {"MetadataSizeHuge", "metadata size 67108865",
           WithField<std::uint64_t>(kMetadataSizeAt, (64u << 20) + 1)},
          {"MetadataSizeHalf", "metadata size 9223372036854775808",
           WithField<std::uint64_t>(kMetadataSizeAt, std::uint64_t{1} << 63)},
          {"MetadataSizeMax", "metadata size 18446744073709551615",
           WithField<std::uint64_t>(kMetadataSizeAt, kMax)},
          {"MetadataSizeWraps", "metadata size 18446744073709551552",
           WithField<std::uint64_t>(kMetadataSizeAt, kMax - 63)},
          {"MetadataSizeOfTheFile", "metadata size",
           Patched([](Bytes* b) { Put<std::uint64_t>(b, kMetadataSizeAt, b->size()); })},
          {"MetadataSizeToTheEnd", "data size",
           Patched([](Bytes* b) { Put<std::uint64_t>(b, kMetadataSizeAt, b->size() - 64); })},
          {"MetadataSizeLess", "data size", WithAdded<std::uint64_t>(kMetadataSizeAt, kMax - 127)},
          {"MetadataSizeMore", "data size", WithAdded<std::uint64_t>(kMetadataSizeAt, 64)},
          {"DataSizeZero", "data size 0", WithField<std::uint64_t>(kDataSizeAt, 0)},
          {"DataSizeMore", "data size", WithAdded<std::uint64_t>(kDataSizeAt, 64)},
          {"DataSizeLess", "data size", WithAdded<std::uint64_t>(kDataSizeAt, kMax - 63)},
          {"DataSizeUnaligned", "data size", WithAdded<std::uint64_t>(kDataSizeAt, 1)},
          {"DataSizeMax", "data size 18446744073709551615",
           WithField<std::uint64_t>(kDataSizeAt, kMax)},
          {"TrailingGarbage", "truncated",
           Patched([](Bytes* b) { b->insert(b->end(), 1000, 0x5a); })},
          {"TrailingGarbageCounted", "data size", Patched([](Bytes* b) {
             b->insert(b->end(), 1000, 0x5a);
             Put<std::uint64_t>(b, kFileSizeAt, b->size());
           })},
          {"TrailingGarbageInTheData", "data size", Patched([](Bytes* b) {
             b->insert(b->end(), 1000, 0x5a);
             Put<std::uint64_t>(b, kFileSizeAt, b->size());
             Put<std::uint64_t>(b, kDataSizeAt, Get<std::uint64_t>(*b, kDataSizeAt) + 1000);
           })},
          {"PaddingCutOff", "outside the data region", Patched([](Bytes* b) {
             b->erase(b->end() - 64, b->end());
             Put<std::uint64_t>(b, kFileSizeAt, b->size());
             Put<std::uint64_t>(b, kDataSizeAt, Get<std::uint64_t>(*b, kDataSizeAt) - 64);
           })},
          {"WrongChecksum", "checksum",
           [] {
             Bytes b = GoodFile().Build();
             b[kChecksumAt] ^= 1;
             return b;
           }()},
          {"ChecksumZero", "checksum",
           [] {
             Bytes b = GoodFile().Build();
             Put<std::uint64_t>(&b, kChecksumAt, 0);
             return b;
           }()},
      });
}

Bytes BuildWith(const std::function<void(FileSpec*)>& change) {
  FileSpec spec = GoodFile();
  change(&spec);
  return spec.Build();
}

Bytes WithTensor(TensorSpec tensor) {
  return BuildWith([&](FileSpec* s) { s->tensors.push_back(std::move(tensor)); });
}

Bytes WithNetwork(const std::function<void(NetworkSpec*)>& change) {
  return BuildWith([&](FileSpec* s) { change(&s->networks[0]); });
}

/// Writes over a 32-bit word of the metadata; `which` counts from its start.
Bytes WithWord(std::size_t which, std::uint32_t value) {
  return WithField<std::uint32_t>(kMetadataAt + 4 * which, value);
}

std::uint32_t RootAt(const Bytes& b) { return Get<std::uint32_t>(b, kMetadataAt); }

void AddMetadataCases(Cases* cases) {
  constexpr const char* kNoBuffer = "metadata: not a valid FlatBuffer";
  cases->insert(
      cases->end(),
      {
          {"OtherIdentifier", kNoBuffer, BuildWith([](FileSpec* s) { s->identifier = "TFL3"; })},
          {"NoIdentifier", kNoBuffer, WithWord(1, 0)},
          {"MetadataOfZeros", kNoBuffer, Patched([](Bytes* b) {
             std::fill_n(b->begin() + kMetadataAt, Get<std::uint64_t>(*b, kMetadataSizeAt),
                         std::uint8_t{0});
           })},
          {"RootPointsOutside", kNoBuffer, WithWord(0, 0xfffffff0u)},
          {"RootPointsToItself", kNoBuffer, WithWord(0, 0)},
          {"RootMisaligned", kNoBuffer,
           Patched([](Bytes* b) { Put(b, kMetadataAt, RootAt(*b) + 1); })},
          {"RootTableWithoutVtable", kNoBuffer,
           Patched([](Bytes* b) { Put<std::int32_t>(b, kMetadataAt + RootAt(*b), 0x7fffffff); })},
          {"VtablePointsBehind", kNoBuffer,
           Patched([](Bytes* b) { Put<std::int32_t>(b, kMetadataAt + RootAt(*b), -0x10000); })},
          {"FieldPointsOutside", kNoBuffer, Patched([](Bytes* b) {
             Put<std::uint32_t>(b, kMetadataAt + RootAt(*b) + 4, 0x00ffffff);
           })},
          {"MetadataCutShort", kNoBuffer, Patched([](Bytes* b) {
             // Less than the padding, so that the data region stays where it was.
             const auto size = Get<std::uint64_t>(*b, kMetadataSizeAt);
             Put<std::uint64_t>(b, kMetadataSizeAt, size - (size % 64 == 0 ? 60 : size % 64 - 1));
           })},
          {"NoNetworkList", kNoBuffer, BuildWith([](FileSpec* s) { s->without_networks = true; })},
          {"NoTensorList", kNoBuffer, BuildWith([](FileSpec* s) { s->without_tensors = true; })},
          {"NoProvenance", kNoBuffer, BuildWith([](FileSpec* s) { s->without_provenance = true; })},
          {"NoNetworks", "networks: none", BuildWith([](FileSpec* s) { s->networks.clear(); })},
          {"NetworkWithoutName", kNoBuffer,
           WithNetwork([](NetworkSpec* n) { n->without_name = true; })},
          {"NetworkWithoutPrefix", kNoBuffer,
           WithNetwork([](NetworkSpec* n) { n->without_prefix = true; })},
          {"NetworkNameEmpty", "network's name", WithNetwork([](NetworkSpec* n) { n->name = ""; })},
          {"NetworkNameWithEscape", "network's name",
           WithNetwork([](NetworkSpec* n) { n->name = "a\x1b[31m"; })},
          {"NetworkNameTooLong", "network's name",
           WithNetwork([](NetworkSpec* n) { n->name = std::string(256, 'x'); })},
          {"NetworkNameTwice", "network net: name is used twice",
           BuildWith([](FileSpec* s) { s->networks.push_back(s->networks[0]); })},
          {"PrefixUnprintable", "network net: prefix",
           WithNetwork([](NetworkSpec* n) { n->prefix = "a\nb"; })},
          {"PrefixTooLong", "network net: prefix",
           WithNetwork([](NetworkSpec* n) { n->prefix = std::string(1 << 20, 'p'); })},
          {"NoConfiguration", kNoBuffer, WithNetwork([](NetworkSpec* n) {
             n->type = fb::Config::NONE;
             n->without_config = true;
           })},
          {"ConfigurationOfNoType", "network net: no configuration",
           WithNetwork([](NetworkSpec* n) { n->type = fb::Config::NONE; })},
          {"ConfigurationTypeOnly", kNoBuffer,
           WithNetwork([](NetworkSpec* n) { n->without_config = true; })},
          {"ConfigurationUnknown", "network net: of a kind this version does not know",
           WithNetwork([](NetworkSpec* n) { n->type = static_cast<fb::Config>(77); })},
          {"ConfigurationWithoutAst", kNoBuffer, WithNetwork([](NetworkSpec* n) {
             n->type = fb::Config::ZsMstm1Config;
             n->config = [](flatbuffers::FlatBufferBuilder& b) {
               return flatbuffers::Offset<void>(b.EndTable(b.StartTable()));
             };
           })},
          {"JointWithoutName", kNoBuffer,
           WithNetwork([](NetworkSpec* n) { n->joints[1].without_name = true; })},
          {"JointNameUnprintable", "network net: joint number 1: name",
           WithNetwork([](NetworkSpec* n) { n->joints[1].name = "a\tb"; })},
          {"JointParentOutside", "joint number 1: parent is 2",
           WithNetwork([](NetworkSpec* n) { n->joints[1].parent = 2; })},
          {"JointParentNegative", "joint number 1: parent is -2",
           WithNetwork([](NetworkSpec* n) { n->joints[1].parent = -2; })},
          {"JointItsOwnParent", "joint number 1: parent is 1",
           WithNetwork([](NetworkSpec* n) { n->joints[1].parent = 1; })},
          {"StatisticsOfNoStream", kNoBuffer,
           WithNetwork([](NetworkSpec* n) { n->statistics[0].without_stream = true; })},
          {"StatisticsWithoutMean", kNoBuffer,
           WithNetwork([](NetworkSpec* n) { n->statistics[0].without_mean = true; })},
          {"SelfTestWithoutOutput", kNoBuffer,
           WithNetwork([](NetworkSpec* n) { n->self_test->without_output = true; })},
          {"SelfTestUnprintable", "network net: self-test",
           WithNetwork([](NetworkSpec* n) { n->self_test->inputs[0] = "\x01"; })},
      });
}

void AddTensorCases(Cases* cases) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const auto named = [](const std::string& name) { return WithTensor({name, {1}, {1}}); };
  const auto shaped = [](std::vector<std::uint32_t> shape) {
    return WithTensor({"n.x", std::move(shape), {1}});
  };
  const auto typed = [](int dtype) {
    return WithTensor({"n.x", {1}, {1}, static_cast<fb::DType>(dtype)});
  };
  const auto placed = [](std::uint64_t offset) {
    return WithTensor({.name = "n.x", .shape = {1}, .values = {1}, .offset = offset});
  };
  const auto sized = [](std::uint64_t bytes) {
    return WithTensor({.name = "n.x", .shape = {2}, .values = {1, 2}, .bytes = bytes});
  };
  cases->insert(
      cases->end(),
      {
          {"TensorWithoutName", "metadata: not a valid FlatBuffer",
           WithTensor({.name = "n.x", .shape = {1}, .values = {1}, .without_name = true})},
          {"NameEmpty", "tensor number 3: name", named("")},
          {"NameTooLong", "tensor number 3: name", named(std::string(256, 'n'))},
          {"NameOfAMegabyte", "tensor number 3: name", named(std::string(1 << 20, 'n'))},
          {"NameWithNewline", "tensor number 3: name", named("n.x\n")},
          {"NameWithEscape", "tensor number 3: name", named("n.\x1b[2J")},
          {"NameWithNul", "tensor number 3: name", named(std::string("n.\0x", 4))},
          {"NameWithDel", "tensor number 3: name", named("n.\x7f")},
          {"NameInUtf8", "tensor number 3: name", named("n.\xc3\xa9")},
          {"NameTwice", "tensor n.a: name is used twice", named("n.a")},
          {"Dtype77", "tensor n.x: dtype 77", typed(77)},
          {"Dtype5", "tensor n.x: dtype 5", typed(5)},
          {"Dtype255", "tensor n.x: dtype 255", typed(255)},
          {"Rank5", "tensor n.x: rank 5", shaped({1, 1, 1, 1, 1})},
          {"Rank1000", "tensor n.x: rank 1000", shaped(std::vector<std::uint32_t>(1000, 1))},
          {"DimensionZero", "tensor n.x: dimension 0 is 0", shaped({0})},
          {"InnerDimensionZero", "tensor n.x: dimension 2 is 0", shaped({2, 3, 0})},
          {"DimensionTooLarge", "tensor n.x: dimension 1 is 16777217", shaped({1, 16777217})},
          {"DimensionMax", "tensor n.x: dimension 0 is 4294967295", shaped({0xffffffffu})},
          {"ShapeWrapsToZero", "tensor n.x: shape overflows", shaped({65536, 65536, 65536, 65536})},
          {"ShapeWrapsToFour", "tensor n.x: ", shaped({0x800001, 0x800001, 0x800001, 4})},
          {"ShapeLargerThanAnyFile", "tensor n.x: shape overflows", shaped({1 << 24, 1 << 24})},
          {"ShapeLargerThanTheFile", "tensor n.x: ", shaped({1 << 20})},
          {"ShapeLargerThanTheFileWithFittingBytes", "tensor n.x: payload ends outside",
           WithTensor({.name = "n.x",
                       .shape = {1 << 20},
                       .values = {1},
                       .bytes = std::uint64_t{4} << 20})},
          {"BytesZero", "tensor n.x: 0 bytes, expected 8", sized(0)},
          {"BytesMore", "tensor n.x: 12 bytes, expected 8", sized(12)},
          {"BytesLess", "tensor n.x: 4 bytes, expected 8", sized(4)},
          {"BytesMax", "tensor n.x: 18446744073709551615 bytes, expected 8", sized(kMax)},
          {"BytesOfAnotherType", "tensor n.x: 8 bytes, expected 2",
           WithTensor({.name = "n.x",
                       .shape = {2},
                       .values = {1, 2},
                       .dtype = fb::DType::U8,
                       .bytes = 8})},
          {"OffsetMisalignedBy4", "tensor n.x: offset 196", placed(196)},
          {"OffsetMisalignedBy32", "tensor n.x: offset 224", placed(224)},
          {"OffsetMisalignedBy1", "tensor n.x: offset 193", placed(193)},
          {"OffsetInThePadding", "tensor n.x: payload ends outside", placed(256)},
          {"OffsetOutside", "tensor n.x: payload ends outside", placed(1 << 20)},
          {"OffsetWraps", "tensor n.x: payload ends outside", placed(kMax - 63)},
          {"OffsetHalf", "tensor n.x: payload ends outside", placed(std::uint64_t{1} << 63)},
          {"OverlapsTheFirst", "tensor n.x: payload overlaps", placed(0)},
          {"OverlapsTheOneBefore", "tensor n.x: payload overlaps", placed(128)},
          {"PayloadsInOtherOrder", "tensor n.b: payload overlaps", BuildWith([](FileSpec* s) {
             s->tensors[0].offset = 64;
             s->tensors[1].offset = 0;
           })},
          {"NanWeight", "tensor n.x: holds NaN or infinity", WithTensor({"n.x", {3}, {1, nan, 2}})},
          {"InfiniteWeight", "tensor n.x: holds NaN or infinity", WithTensor({"n.x", {1}, {inf}})},
          {"MinusInfinityAtTheEnd", "tensor n.x: holds NaN or infinity",
           WithTensor({"n.x", {2, 2}, {0, 0, 0, -inf}})},
          {"ScalarOfManyBytes", "tensor n.x: 8 bytes, expected 4",
           WithTensor({.name = "n.x", .shape = {}, .values = {1, 2}, .bytes = 8})},
      });
}

/// A file with the I8 tensor n.w (2, 2) and the tensors of its scale.
Bytes WithI8(std::vector<TensorSpec> scales, const std::function<void(TensorSpec*)>& change = {}) {
  TensorSpec w{.name = "n.w",
               .shape = {2, 2},
               .dtype = fb::DType::I8,
               .scale = "n.w.scale",
               .raw = {1, 2, 0x81, 0x7f}};
  if (change) change(&w);
  return BuildWith([&](FileSpec* s) {
    s->tensors.push_back(w);
    for (TensorSpec& scale : scales) s->tensors.push_back(scale);
  });
}

void AddQuantisedCases(Cases* cases) {
  const float inf = std::numeric_limits<float>::infinity();
  const auto bf16 = [](std::vector<std::uint8_t> raw) {
    return WithTensor({.name = "n.x", .shape = {2}, .dtype = fb::DType::BF16, .raw = raw});
  };
  const TensorSpec good{"n.w.scale", {2}, {1, 2}};
  const auto scaled = [](TensorSpec scale) { return WithI8({scale}); };
  cases->insert(
      cases->end(),
      {
          {"Bf16Nan", "tensor n.x: holds NaN or infinity", bf16({0, 0, 0xc0, 0x7f})},
          {"Bf16MinusInfinity", "tensor n.x: holds NaN or infinity", bf16({0x80, 0xff, 0, 0})},
          {"Bf16BytesOfF32", "tensor n.x: 8 bytes, expected 4",
           WithTensor({.name = "n.x", .shape = {2}, .dtype = fb::DType::BF16, .bytes = 8})},
          {"I8WithoutScale", "tensor n.w: I8 without a scale",
           WithI8({good}, [](TensorSpec* w) { w->scale = ""; })},
          {"I8ScaleOfNoTensor", "tensor n.w: scale n.w.scale: no such tensor", WithI8({})},
          {"I8ScaleTooShort", "scale n.w.scale: (1,) float32, expected (2,) float32",
           scaled({"n.w.scale", {1}, {1}})},
          {"I8ScaleTooLong", "scale n.w.scale: (3,)", scaled({"n.w.scale", {3}, {1, 1, 1}})},
          {"I8ScaleOfAnotherRank", "scale n.w.scale: (2, 1)",
           scaled({"n.w.scale", {2, 1}, {1, 1}})},
          {"I8ScaleOfAnotherType", "scale n.w.scale: (2,) int32",
           scaled({"n.w.scale", {2}, {1, 1}, fb::DType::I32})},
          {"I8ScaleZero", "holds zero or less", scaled({"n.w.scale", {2}, {1, 0}})},
          {"I8ScaleNegative", "holds zero or less", scaled({"n.w.scale", {2}, {-1, 1}})},
          {"I8ScaleInfinite", "tensor n.w.scale: holds NaN or infinity",
           scaled({"n.w.scale", {2}, {1, inf}})},
          {"I8ScaleIsItself", "scale n.w: (2, 2) int8",
           WithI8({good}, [](TensorSpec* w) { w->scale = "n.w"; })},
          {"I8ScaleNameWithEscape", "tensor n.w: name of its scale",
           WithI8({good}, [](TensorSpec* w) { w->scale = "\x1b[2J"; })},
          {"I8ScaleNameTooLong", "tensor n.w: name of its scale",
           WithI8({good}, [](TensorSpec* w) { w->scale = std::string(256, 's'); })},
          {"I8ScaleShared", "belongs to another tensor too",
           WithI8({good,
                   {.name = "n.v",
                    .shape = {2, 1},
                    .dtype = fb::DType::I8,
                    .scale = "n.w.scale",
                    .raw = {1, 1}}})},
          {"ScaleOfF32", "tensor n.x: has a scale, which only I8 has",
           WithTensor({.name = "n.x", .shape = {1}, .values = {1}, .scale = "n.b"})},
          {"ScaleOfBf16", "tensor n.x: has a scale, which only I8 has",
           WithTensor({.name = "n.x",
                       .shape = {1},
                       .dtype = fb::DType::BF16,
                       .scale = "n.b",
                       .raw = {0, 0}})},
          {"I8Minus128", "tensor n.w: holds -128",
           WithI8({good},
                  [](TensorSpec* w) {
                    w->raw = {1, 2, 3, 0x80};
                  })},
          {"I8OfOneDimension", "tensor n.w: I8 with fewer than two dimensions",
           WithI8({good}, [](TensorSpec* w) { w->shape = {4}; })},
          {"I8RowTooLong", "tensor n.w: rows of 65537 I8 elements, expected at most 65536",
           WithI8({good},
                  [](TensorSpec* w) {
                    w->shape = {2, 65537};
                    w->raw.assign(2 * 65537, 1);
                  })},
      });
}

const Cases& AllCases() {
  static const Cases cases = [] {
    Cases all;
    AddHeaderCases(&all);
    AddMetadataCases(&all);
    AddTensorCases(&all);
    AddQuantisedCases(&all);
    return all;
  }();
  return cases;
}

void ExpectOneSentence(const Status& status, const std::string& file, const std::string& part) {
  EXPECT_EQ(status.code(), Code::kBadWeights);
  const std::string& text = status.message();
  EXPECT_EQ(text.rfind(file + ": ", 0), 0u) << text;
  EXPECT_NE(text.find(part), std::string::npos) << text << "\nexpected: " << part;
  EXPECT_LE(text.size(), 300u + file.size()) << text;
  EXPECT_GT(text.size(), file.size() + 10) << text;
  for (char c : text) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << "control character in: " << text;
}

class MalformedWeightsTest : public testing::TestWithParam<std::size_t> {};

TEST_P(MalformedWeightsTest, IsRejectedWithOneSentence) {
  const Case& c = AllCases()[GetParam()];
  const auto memory = WeightsFile::FromMemory(c.bytes.data(), c.bytes.size(), "in memory");
  ASSERT_FALSE(memory.ok());
  ExpectOneSentence(memory.status(), "in memory", c.expect);
  const TempFile temp(c.bytes);
  for (const Residence residence : {Residence::kMapped, Residence::kCopied}) {
    const auto file = WeightsFile::Open(temp.path(), {.residence = residence});
    ASSERT_FALSE(file.ok());
    ExpectOneSentence(file.status(), temp.path(), c.expect);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MalformedWeightsTest,
                         testing::Range(std::size_t{0}, AllCases().size()),
                         [](const auto& test) { return AllCases()[test.param].name; });

TEST(MalformedWeightsListTest, HasSixtyDifferentKinds) {
  std::set<std::string> names;
  for (const Case& c : AllCases()) names.insert(c.name);
  EXPECT_EQ(names.size(), AllCases().size());
  EXPECT_GE(names.size(), 60u);
  EXPECT_TRUE(
      WeightsFile::FromMemory(GoodFile().Build().data(), GoodFile().Build().size(), "").ok());
}

// Things that are no files of weights at all.

void ExpectRefused(const std::string& path, Code code, const std::string& part) {
  for (const Residence residence : {Residence::kMapped, Residence::kCopied}) {
    const auto file = WeightsFile::Open(path, {.residence = residence});
    ASSERT_FALSE(file.ok()) << path;
    EXPECT_EQ(file.status().code(), code);
    const std::string& text = file.status().message();
    EXPECT_EQ(text.rfind(path + ": ", 0), 0u) << text;
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(NoWeightsFileTest, Missing) {
  ExpectRefused("/nonexistent/weights.fb", Code::kNotFound, "cannot open: No such file");
}
TEST(NoWeightsFileTest, EmptyPath) { ExpectRefused("", Code::kNotFound, "cannot open"); }
TEST(NoWeightsFileTest, Directory) {
  ExpectRefused(testing::TempDir(), Code::kBadWeights, "not a regular file");
}
TEST(NoWeightsFileTest, Device) {
  ExpectRefused("/dev/zero", Code::kBadWeights, "not a regular file");
}
TEST(NoWeightsFileTest, ProcessFile) {
  ExpectRefused("/proc/self/status", Code::kBadWeights, "0 bytes");
}
TEST(NoWeightsFileTest, Empty) {
  const TempFile temp({});
  ExpectRefused(temp.path(), Code::kBadWeights, "0 bytes, expected");
}
TEST(NoWeightsFileTest, OneByte) {
  const TempFile temp({'G'});
  ExpectRefused(temp.path(), Code::kBadWeights, "1 bytes, expected");
}
TEST(NoWeightsFileTest, Fifo) {
  // Opening one for reading would wait for a writer.
  const std::string path = testing::TempDir() + "gestus_fifo_" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  ExpectRefused(path, Code::kBadWeights, "not a regular file");
  unlink(path.c_str());
}
TEST(NoWeightsFileTest, Unreadable) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const TempFile temp(GoodFile().Build());
  ASSERT_EQ(chmod(temp.path().c_str(), 0), 0);
  ExpectRefused(temp.path(), Code::kIo, "cannot open: Permission denied");
}
TEST(NoWeightsFileTest, SparseBeyond2GiB) {
  const TempFile temp({});
  ASSERT_EQ(truncate(temp.path().c_str(), (off_t{1} << 31) + 1), 0);
  const auto file = WeightsFile::Open(temp.path());
  ASSERT_FALSE(file.ok());
  ExpectOneSentence(file.status(), temp.path(), "begin with GESTUSW");
}
TEST(NoWeightsFileTest, SparseBeyondTheLimit) {
  const TempFile temp({});
  ASSERT_EQ(truncate(temp.path().c_str(), (off_t{1} << 36) + 64), 0);
  ExpectRefused(temp.path(), Code::kBadWeights, "to 64 GiB");
}
TEST(NoWeightsFileTest, NoMemoryAtAll) {
  const auto file = WeightsFile::FromMemory(nullptr, 1000, "nothing");
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.status().code(), Code::kBadWeights);
}

}  // namespace
}  // namespace gestus::test
