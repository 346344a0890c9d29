#include "models/styles/style.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <string_view>

#include "models/io/text.h"
#include "models/zs_mstm/config.h"
#include "weights_generated.h"

namespace gestus::styles {
namespace {

using models::Array;
using models::Arrays;
using models::ArraySpec;

constexpr const char* kStyle = "style";
constexpr const char* kChecksum = "weights_checksum";
constexpr const char* kNetwork = "network";
constexpr const char* kParts = "parts";
constexpr const char* kNames = "made_of";
constexpr const char* kShares = "made_of_share";
constexpr const char* kSegments = "made_of_segments";
constexpr std::array<const char*, 4> kPartNames = {"speech and text", "pose", "face",
                                                   "dialog acts"};

Array I32(std::vector<std::int32_t> values) {
  Array array;
  array.dtype = DType::kI32;
  array.shape = {static_cast<std::int64_t>(values.size())};
  array.i32 = std::move(values);
  return array;
}

Array F32(std::vector<float> values) {
  Array array;
  array.shape = {static_cast<std::int64_t>(values.size())};
  array.f32 = std::move(values);
  return array;
}

Array TextArray(std::string_view text) {
  std::vector<std::int32_t> bytes;
  for (const char c : text) bytes.push_back(static_cast<unsigned char>(c));
  return I32(std::move(bytes));
}

std::vector<Part> PartsFrom(const std::array<std::int64_t, 4>& widths) {
  std::vector<Part> parts;
  std::int64_t begin = 0;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (widths[i] > 0) parts.push_back({kPartNames[i], begin, widths[i]});
    begin += widths[i];
  }
  return parts;
}

Status Bad(const char* name, const std::string& sentence) {
  return Status(Code::kBadInput, std::string(name) + ": " + sentence);
}

/// The one-dimensional array `name`; null when it is not there.
Result<const Array*> Find(const Arrays& arrays, const char* name) {
  const auto found = arrays.find(name);
  if (found == arrays.end()) return static_cast<const Array*>(nullptr);
  if (found->second.shape.size() == 1) return &found->second;
  return Bad(name, std::to_string(found->second.shape.size()) + " dimensions, expected one");
}

Result<std::string> TextOf(const char* name, const Array& array) {
  std::string text;
  for (const std::int32_t byte : array.i32) {
    if (byte < 0 || byte > 255)
      return Bad(name, "holds " + std::to_string(byte) + ", expected bytes, 0 to 255");
    text += static_cast<char>(byte);
  }
  return text;
}

Result<std::vector<Part>> ReadParts(const Array& array, std::int64_t width) {
  std::array<std::int64_t, kPartNames.size()> widths = {};
  if (array.i32.size() != widths.size())
    return Bad(kParts, std::to_string(array.i32.size()) + " widths, expected 4");
  std::copy(array.i32.begin(), array.i32.end(), widths.begin());
  const std::int64_t sum = std::accumulate(widths.begin(), widths.end(), std::int64_t{0});
  if (*std::min_element(widths.begin(), widths.end()) < 0 || sum != width)
    return Bad(kStyle, std::to_string(width) + " values, expected the " + std::to_string(sum) +
                           " of its parts");
  return PartsFrom(widths);
}

Result<std::vector<Source>> ReadSources(const Array& names, const Array* shares,
                                        const Array* segments) {
  const Result<std::string> text = TextOf(kNames, names);
  if (!text.ok()) return text.status();
  const auto count = static_cast<std::size_t>(std::count(text->begin(), text->end(), '\0'));
  if (!text->empty() && text->back() != '\0') return Bad(kNames, "ends within a name");
  if (shares == nullptr || shares->f32.size() != count)
    return Bad(kShares, "expected one for each of " + Count(count, "name"));
  if (segments == nullptr || segments->i32.size() != count)
    return Bad(kSegments, "expected one for each of " + Count(count, "name"));
  std::vector<Source> sources;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t end = text->find('\0', begin);
    if (segments->i32[i] < 0)
      return Bad(kSegments, "holds " + std::to_string(segments->i32[i]) + ", expected 0 or more");
    sources.push_back({text->substr(begin, end - begin), shares->f32[i], segments->i32[i]});
    begin = end + 1;
  }
  return sources;
}

}  // namespace

Result<std::vector<Part>> PartsOf(const fb::Network& network) {
  if (network.config_as_ZsMstm1Config() == nullptr && network.config_as_ZsMstm2Config() == nullptr)
    return Status(Code::kInvalidArgument, "network " + network.name()->str() +
                                              ": has no style, expected ZS-MSTM 1.0 or 2.0");
  const Result<models::ZsMstmConfig> c = models::ReadZsMstmConfig(network);
  if (!c.ok()) return c.status();
  return PartsFrom(
      {c->StyleAttentionWidth(), c->lstm_hidden, c->HasFace() ? c->lstm_hidden : 0, c->d_tags});
}

Arrays ArraysOf(const Style& style) {
  const auto half = [&](int shift) {
    return std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(style.weights_checksum >> shift));
  };
  Arrays arrays = {{kStyle, F32(style.values)}, {kChecksum, I32({half(0), half(32)})}};
  if (!style.network.empty()) arrays[kNetwork] = TextArray(style.network);
  if (!style.parts.empty()) {
    std::vector<std::int32_t> widths;
    for (const char* name : kPartNames) {
      const auto part = std::find_if(style.parts.begin(), style.parts.end(),
                                     [&](const Part& p) { return p.name == name; });
      widths.push_back(part == style.parts.end() ? 0 : static_cast<std::int32_t>(part->width));
    }
    arrays[kParts] = I32(std::move(widths));
  }
  if (style.made_of.empty()) return arrays;
  std::string names;
  std::vector<float> shares;
  std::vector<std::int32_t> segments;
  for (const Source& source : style.made_of) {
    names.append(source.name).push_back('\0');
    shares.push_back(static_cast<float>(source.share));
    segments.push_back(static_cast<std::int32_t>(source.segments));
  }
  arrays[kNames] = TextArray(names);
  arrays[kShares] = F32(std::move(shares));
  arrays[kSegments] = I32(std::move(segments));
  return arrays;
}

std::vector<ArraySpec> StyleSpecs() {
  const auto spec = [](const char* name, DType dtype, bool required) {
    ArraySpec made;
    made.name = name;
    made.dtype = dtype;
    made.required = required;
    return made;
  };
  return {spec(kStyle, DType::kF32, true),    spec(kChecksum, DType::kI32, true),
          spec(kNetwork, DType::kI32, false), spec(kParts, DType::kI32, false),
          spec(kNames, DType::kI32, false),   spec(kShares, DType::kF32, false),
          spec(kSegments, DType::kI32, false)};
}

Result<Style> StyleOf(const Arrays& arrays) {
  std::array<const Array*, 7> found = {};
  std::size_t at = 0;
  for (const ArraySpec& spec : StyleSpecs()) {
    const Result<const Array*> array = Find(arrays, spec.name.c_str());
    if (!array.ok()) return array.status();
    if (*array == nullptr && spec.required) return Bad(spec.name.c_str(), "missing");
    found[at++] = *array;
  }
  const auto [values, checksum, network, parts, names, shares, segments] = found;
  Style style;
  style.values = values->f32;
  if (style.values.empty()) return Bad(kStyle, "no values, expected those of a style");
  if (checksum->i32.size() != 2) return Bad(kChecksum, "expected two int32");
  style.weights_checksum = std::bit_cast<std::uint32_t>(checksum->i32[0]) |
                           std::uint64_t{std::bit_cast<std::uint32_t>(checksum->i32[1])} << 32;
  if (network != nullptr) {
    Result<std::string> name = TextOf(kNetwork, *network);
    if (!name.ok()) return name.status();
    style.network = *std::move(name);
  }
  if (parts != nullptr) {
    auto read = ReadParts(*parts, static_cast<std::int64_t>(style.values.size()));
    if (!read.ok()) return read.status();
    style.parts = *std::move(read);
  }
  if (names != nullptr) {
    auto read = ReadSources(*names, shares, segments);
    if (!read.ok()) return read.status();
    style.made_of = *std::move(read);
  }
  return style;
}

std::string ChecksumText(std::uint64_t checksum) {
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[checksum >> shift & 15];
  return text;
}

Status CheckAlike(const std::vector<Named>& styles) {
  for (const Named& other : styles) {
    const Named& first = styles.front();
    if (other.style.weights_checksum != first.style.weights_checksum)
      return Bad(other.name.c_str(), "made by weights " +
                                         ChecksumText(other.style.weights_checksum) +
                                         ", expected those of " + first.name + ", " +
                                         ChecksumText(first.style.weights_checksum));
    const bool known = !other.style.network.empty() && !first.style.network.empty();
    if (known && other.style.network != first.style.network)
      return Bad(other.name.c_str(), "made by network " + other.style.network +
                                         ", expected that of " + first.name + ", " +
                                         first.style.network);
    if (other.style.values.size() != first.style.values.size())
      return Bad(other.name.c_str(), std::to_string(other.style.values.size()) +
                                         " values, expected as many as " + first.name + " has, " +
                                         std::to_string(first.style.values.size()));
  }
  return Status();
}

}  // namespace gestus::styles
