// Reading and writing .style files, and taking styles from clips.
#include "models/cli/style.h"

#include <algorithm>
#include <bit>

#include "models/cli/json.h"
#include "models/cli/npy.h"
#include "models/cli/npz.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

using models::Array;
using models::Arrays;
using models::ArraySpec;

constexpr const char* kStyle = "style";
constexpr const char* kClipPrefix = "style_";
constexpr const char* kChecksum = "weights_checksum";

Array ChecksumArray(std::uint64_t checksum) {
  Array array;
  array.dtype = DType::kI32;
  array.shape = {2};
  array.i32 = {std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(checksum)),
               std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(checksum >> 32))};
  return array;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const ArraySpec* FindInput(const models::Network& network, const std::string& name) {
  for (const ArraySpec& spec : network.signature().inputs) {
    if (spec.name == name) return &spec;
  }
  return nullptr;
}

Status NoStyle(const Setup& setup) {
  return Status(Code::kInvalidArgument, setup.weights->path() + ": " + setup.network->kind() +
                                            " has no style, expected a network that takes one");
}

Status LoadStyleFile(const Setup& setup, const std::string& path, Arrays* inputs) {
  const ArraySpec* style = FindInput(*setup.network, kStyle);
  if (style == nullptr) return NoStyle(setup);
  ArraySpec required = *style;
  required.required = true;
  ArraySpec checksum;
  checksum.name = kChecksum;
  checksum.dtype = DType::kI32;
  Result<NpzContents> file = ReadNpz(path, {required, checksum});
  if (!file.ok()) return file.status();
  if (file->arrays.at(kChecksum).i32 != ChecksumArray(setup.weights->checksum()).i32) {
    return Status(Code::kBadInput, path + ": " + kChecksum + ": made by other weights, expected " +
                                       setup.weights->path());
  }
  GESTUS_RETURN_IF_ERROR(models::CheckArray(*style, file->arrays.at(kStyle)).In(path));
  (*inputs)[kStyle] = std::move(file->arrays.at(kStyle));
  return Status();
}

// In a clip of its own the arrays need no prefix: "speech" stands for "style_speech".
Status LoadClip(const Setup& setup, const std::string& path, const std::vector<std::string>& names,
                Arrays* inputs) {
  std::vector<ArraySpec> wanted;
  for (ArraySpec spec : setup.network->signature().inputs) {
    if (!spec.name.starts_with(kClipPrefix)) continue;
    if (!Contains(names, spec.name)) spec.name.erase(0, std::string_view(kClipPrefix).size());
    spec.required = true;
    wanted.push_back(spec);
  }
  if (wanted.empty()) return NoStyle(setup);
  Result<NpzContents> clip = ReadNpz(path, wanted);
  if (!clip.ok()) return clip.status();
  for (const ArraySpec& spec : wanted) {
    Array& array = clip->arrays.at(spec.name);
    GESTUS_RETURN_IF_ERROR(models::CheckArray(spec, array).In(path));
    const bool prefixed = spec.name.starts_with(kClipPrefix);
    (*inputs)[prefixed ? spec.name : kClipPrefix + spec.name] = std::move(array);
  }
  return Status();
}

std::string Summary(const Arguments& arguments, const Setup& setup, const Array& style,
                    const models::RunReport& report) {
  std::string text = arguments.output + ": the style of " + arguments.input + ", " +
                     ShapeText(style.shape) + " float32, for use with " + arguments.weights + "\n";
  for (const std::string& note : report.notes) text += "note: " + note + "\n";
  if (!setup.Trained()) text += std::string("warning: ") + kUntrained + "\n";
  return text;
}

std::string SummaryJson(const Arguments& arguments, const Setup& setup, const Array& style,
                        const models::RunReport& report) {
  JsonWriter json;
  json.BeginObject()
      .Member("weights", arguments.weights)
      .Member("trained", setup.Trained())
      .Member("clip", arguments.input)
      .Member("output", arguments.output)
      .Member("shape", style.shape)
      .Member("notes", report.notes)
      .EndObject();
  return json.text();
}

}  // namespace

bool IsStyleInput(const std::string& name) {
  return name == kStyle || name.starts_with(kClipPrefix);
}

Status LoadStyle(const Setup& setup, const std::string& path, Arrays* inputs) {
  const Result<std::vector<std::string>> names = ListNpz(path);
  if (!names.ok()) return names.status();
  return Contains(*names, kChecksum) ? LoadStyleFile(setup, path, inputs)
                                     : LoadClip(setup, path, *names, inputs);
}

Status RunStyle(const Arguments& arguments) {
  // In a bundle the network is the one with a style, whatever the clip calls its arrays.
  Result<Setup> setup = OpenNetwork(arguments, {"style"});
  if (!setup.ok()) return setup.status();
  const Result<std::vector<std::string>> names = ListNpz(arguments.input);
  if (!names.ok()) return names.status();
  Arrays clip;
  GESTUS_RETURN_IF_ERROR(LoadClip(*setup, arguments.input, *names, &clip));
  Result<AtomicFile> file = AtomicFile::Create(arguments.output);
  if (!file.ok()) return file.status().In(arguments.output);

  // Given a style clip and nothing else, a network computes the style and nothing else.
  models::RunOptions options;
  options.threads = arguments.threads;
  models::RunReport report;
  Result<Arrays> outputs = setup->network->Run(clip, options, &report);
  if (!outputs.ok()) return outputs.status().In(arguments.input);
  const auto style = outputs->find(kStyle);
  if (style == outputs->end()) return NoStyle(*setup);

  const Arrays contents = {{kStyle, style->second},
                           {kChecksum, ChecksumArray(setup->weights->checksum())}};
  GESTUS_RETURN_IF_ERROR(WriteNpz(contents, &*file).In(arguments.output));
  GESTUS_RETURN_IF_ERROR(file->Commit().In(arguments.output));
  return Print(arguments.json ? SummaryJson(arguments, *setup, style->second, report)
                              : Summary(arguments, *setup, style->second, report));
}

}  // namespace gestus::cli
