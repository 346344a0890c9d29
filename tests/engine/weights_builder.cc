// Writes tables field by field, not through the generated Create functions, which would refuse to
// leave a required field out.
#include "tests/engine/weights_builder.h"

#include <algorithm>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace gestus::test {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

std::uint64_t AlignUp(std::uint64_t n) { return (n + 63) / 64 * 64; }

std::uint64_t PayloadBytes(const TensorSpec& t) {
  const bool byte = t.dtype == fb::DType::U8 || t.dtype == fb::DType::I8;
  std::uint64_t n = byte ? 1 : t.dtype == fb::DType::BF16 ? 2 : 4;
  for (std::uint32_t d : t.shape) n *= d;
  // A lie about the shape must not make the test write gigabytes.
  const std::size_t given = std::max(t.values.size() * 4, t.raw.size());
  return std::min<std::uint64_t>(n, std::max<std::uint64_t>(given, 4096));
}

Offset<fb::Tensor> AddTensor(FlatBufferBuilder& b, const TensorSpec& t, std::uint64_t offset) {
  const auto name = b.CreateString(t.name);
  const auto shape = b.CreateVector(t.shape);
  flatbuffers::Offset<flatbuffers::String> scale;
  if (!t.scale.empty()) scale = b.CreateString(t.scale);
  const auto start = b.StartTable();
  b.AddElement<std::uint64_t>(fb::Tensor::VT_BYTES, t.bytes.value_or(PayloadBytes(t)), 0);
  b.AddElement<std::uint64_t>(fb::Tensor::VT_OFFSET, t.offset.value_or(offset), 0);
  b.AddOffset(fb::Tensor::VT_SHAPE, shape);
  if (!t.without_name) b.AddOffset(fb::Tensor::VT_NAME, name);
  if (!t.scale.empty()) b.AddOffset(fb::Tensor::VT_SCALE, scale);
  b.AddElement<std::uint8_t>(fb::Tensor::VT_DTYPE, static_cast<std::uint8_t>(t.dtype), 0);
  return Offset<fb::Tensor>(b.EndTable(start));
}

Offset<fb::Normalisation> AddStatistics(FlatBufferBuilder& b, const StatisticsSpec& s) {
  const auto stream = b.CreateString(s.stream);
  const auto mean = b.CreateVector(s.mean), deviation = b.CreateVector(s.deviation);
  const auto start = b.StartTable();
  if (!s.without_stream) b.AddOffset(fb::Normalisation::VT_STREAM, stream);
  if (!s.without_mean) b.AddOffset(fb::Normalisation::VT_MEAN, mean);
  b.AddOffset(fb::Normalisation::VT_DEVIATION, deviation);
  b.AddElement<float>(fb::Normalisation::VT_DIVISOR, s.divisor, 2.0f);
  return Offset<fb::Normalisation>(b.EndTable(start));
}

Offset<fb::Joint> AddJoint(FlatBufferBuilder& b, const JointSpec& j) {
  const auto name = b.CreateString(j.name);
  const auto start = b.StartTable();
  if (!j.without_name) b.AddOffset(fb::Joint::VT_NAME, name);
  b.AddElement<std::int32_t>(fb::Joint::VT_PARENT, j.parent, -1);
  b.AddElement<std::uint32_t>(fb::Joint::VT_SOURCE, j.source, 0);
  return Offset<fb::Joint>(b.EndTable(start));
}

Offset<fb::SelfTest> AddSelfTest(FlatBufferBuilder& b, const SelfTestSpec& s) {
  const auto names = b.CreateVectorOfStrings(s.input_names);
  const auto inputs = b.CreateVectorOfStrings(s.inputs);
  const auto output_name = b.CreateString(s.output_name), output = b.CreateString(s.output);
  const auto start = b.StartTable();
  b.AddOffset(fb::SelfTest::VT_INPUT_NAMES, names);
  b.AddOffset(fb::SelfTest::VT_INPUTS, inputs);
  b.AddOffset(fb::SelfTest::VT_OUTPUT_NAME, output_name);
  if (!s.without_output) b.AddOffset(fb::SelfTest::VT_OUTPUT, output);
  return Offset<fb::SelfTest>(b.EndTable(start));
}

template <class Spec, class Table>
auto AddAll(FlatBufferBuilder& b, const std::vector<Spec>& specs,
            Offset<Table> (*add)(FlatBufferBuilder&, const Spec&)) {
  std::vector<Offset<Table>> all;
  for (const Spec& s : specs) all.push_back(add(b, s));
  return b.CreateVector(all);
}

Offset<fb::Network> AddNetwork(FlatBufferBuilder& b, const NetworkSpec& n) {
  const auto name = b.CreateString(n.name), prefix = b.CreateString(n.prefix);
  const Offset<void> config = n.config ? n.config(b) : fb::CreateAstConfig(b).Union();
  const auto statistics = AddAll(b, n.statistics, &AddStatistics);
  const auto joints = AddAll(b, n.joints, &AddJoint);
  Offset<fb::SelfTest> self_test;
  if (n.self_test) self_test = AddSelfTest(b, *n.self_test);
  Offset<fb::Features> features;
  if (n.features) features = n.features(b);
  const auto start = b.StartTable();
  if (!n.without_name) b.AddOffset(fb::Network::VT_NAME, name);
  if (!n.without_prefix) b.AddOffset(fb::Network::VT_PREFIX, prefix);
  b.AddElement<std::uint8_t>(fb::Network::VT_CONFIG_TYPE, static_cast<std::uint8_t>(n.type), 0);
  if (!n.without_config) b.AddOffset(fb::Network::VT_CONFIG, config);
  b.AddOffset(fb::Network::VT_NORMALISATIONS, statistics);
  b.AddOffset(fb::Network::VT_JOINTS, joints);
  if (n.self_test) b.AddOffset(fb::Network::VT_SELF_TEST, self_test);
  if (n.features) b.AddOffset(fb::Network::VT_FEATURES, features);
  return Offset<fb::Network>(b.EndTable(start));
}

}  // namespace

Bytes FileSpec::Build() const {
  FlatBufferBuilder b;
  Bytes data;
  std::vector<Offset<fb::Tensor>> records;
  for (const TensorSpec& t : tensors) {
    records.push_back(AddTensor(b, t, data.size()));
    const std::size_t at = data.size();
    data.resize(at + AlignUp(PayloadBytes(t)));
    if (!t.values.empty())
      std::memcpy(data.data() + at, t.values.data(),
                  std::min<std::size_t>(t.values.size() * sizeof(float), data.size() - at));
    if (!t.raw.empty())
      std::copy(t.raw.begin(), t.raw.end(), data.begin() + static_cast<std::ptrdiff_t>(at));
  }
  data.resize(data.size() + 64);
  const auto tensor_list = b.CreateVector(records);
  const auto network_list = AddAll(b, networks, &AddNetwork);
  const auto provenance = fb::CreateProvenance(b);
  const auto start = b.StartTable();
  if (!without_networks) b.AddOffset(fb::WeightsFile::VT_NETWORKS, network_list);
  if (!without_tensors) b.AddOffset(fb::WeightsFile::VT_TENSORS, tensor_list);
  if (!without_provenance) b.AddOffset(fb::WeightsFile::VT_PROVENANCE, provenance);
  b.Finish(Offset<fb::WeightsFile>(b.EndTable(start)), identifier);

  const std::uint64_t data_at = AlignUp(kMetadataAt + b.GetSize());
  Bytes file(data_at + data.size());
  std::memcpy(file.data(), "GESTUSW", 8);
  Put<std::uint32_t>(&file, kVersionAt, 1);
  Put<std::uint32_t>(&file, kEndianAt, 0x01020304);
  Put<std::uint64_t>(&file, kFileSizeAt, file.size());
  Put<std::uint64_t>(&file, kMetadataSizeAt, b.GetSize());
  Put<std::uint64_t>(&file, kDataSizeAt, data.size());
  std::memcpy(file.data() + kMetadataAt, b.GetBufferPointer(), b.GetSize());
  std::copy(data.begin(), data.end(), file.begin() + static_cast<std::ptrdiff_t>(data_at));
  RefreshChecksum(&file);
  return file;
}

FileSpec GoodFile() {
  FileSpec spec;
  spec.networks[0].prefix = "n.";
  spec.networks[0].joints = {{"Neck"}, {"RShoulder", 0}};
  spec.networks[0].statistics = {{"speech", {-4.2f}, {4.5f}}};
  spec.networks[0].self_test = SelfTestSpec{{"speech"}, {"n.b"}, "embedding", "n.c"};
  spec.tensors = {{"n.a", {2, 3}, {1, 2, 3, 4, 5, 6}},
                  {"n.b", {}, {7}},
                  {"n.c", {5}, {1, 0, 0, 0, 0}, fb::DType::I32}};
  return spec;
}

void RefreshChecksum(Bytes* bytes) {
  Put<std::uint64_t>(bytes, kChecksumAt, 0);
  Put<std::uint64_t>(bytes, kChecksumAt, XXH3_64bits(bytes->data(), bytes->size()));
}

}  // namespace gestus::test
