// Weights files made in memory, whole or damaged in a chosen place: every field can be left out or
// told wrong, and the checksum can be made to fit afterwards.
#ifndef GESTUS_TESTS_ENGINE_WEIGHTS_BUILDER_H_
#define GESTUS_TESTS_ENGINE_WEIGHTS_BUILDER_H_

#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "weights_generated.h"

namespace gestus::test {

using Bytes = std::vector<std::uint8_t>;

struct TensorSpec {
  std::string name;
  std::vector<std::uint32_t> shape;
  std::vector<float> values{};  ///< payload; zeros when shorter than the shape asks for
  fb::DType dtype = fb::DType::F32;

  // What the record says instead of the truth.
  bool without_name = false;
  std::optional<std::uint64_t> offset{}, bytes{};

  std::string scale{};              ///< none when empty
  std::vector<std::uint8_t> raw{};  ///< payload of bf16 and i8, instead of `values`
};

struct StatisticsSpec {
  std::string stream;
  std::vector<float> mean, deviation;
  float divisor = 2.0f;
  bool without_stream = false, without_mean = false;
};

struct JointSpec {
  std::string name;
  std::int32_t parent = -1;
  bool without_name = false;
  std::uint32_t source = 0;
};

struct SelfTestSpec {
  std::vector<std::string> input_names, inputs;
  std::string output_name, output;
  bool without_output = false;
};

struct NetworkSpec {
  std::string name = "net", prefix{};
  fb::Config type = fb::Config::AstConfig;
  /// Null: an AstConfig of default values.
  std::function<flatbuffers::Offset<void>(flatbuffers::FlatBufferBuilder&)> config{};
  std::vector<StatisticsSpec> statistics{};
  std::vector<JointSpec> joints{};
  std::optional<SelfTestSpec> self_test{};
  /// Null: no features.
  std::function<flatbuffers::Offset<fb::Features>(flatbuffers::FlatBufferBuilder&)> features{};

  bool without_name = false, without_prefix = false, without_config = false;
};

struct FileSpec {
  std::vector<NetworkSpec> networks{NetworkSpec{}};
  std::vector<TensorSpec> tensors{};
  const char* identifier = "GSTW";
  bool without_networks = false, without_tensors = false, without_provenance = false;

  Bytes Build() const;
};

/// A file of one network and three tensors that loads.
FileSpec GoodFile();

// The header's fields by their offsets (docs/format.md).
inline constexpr std::size_t kVersionAt = 8, kEndianAt = 12, kFileSizeAt = 16, kMetadataSizeAt = 24,
                             kDataSizeAt = 32, kReservedAt = 40, kChecksumAt = 56, kMetadataAt = 64;

template <class T>
void Put(Bytes* bytes, std::size_t at, T value) {
  std::memcpy(bytes->data() + at, &value, sizeof value);
}

template <class T>
T Get(const Bytes& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Makes the checksum fit what the file has become.
void RefreshChecksum(Bytes* bytes);

}  // namespace gestus::test

#endif  // GESTUS_TESTS_ENGINE_WEIGHTS_BUILDER_H_
