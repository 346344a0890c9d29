// Reading and writing .style files, and taking styles from clips.
#include "models/cli/style.h"

#include <algorithm>
#include <bit>

#include "models/cli/feed.h"
#include "models/cli/inputs.h"
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

Status ReadClipArrays(const Setup& setup, const std::string& path, bool whole, Arrays* inputs) {
  const Result<std::vector<std::string>> names = ListNpz(path);
  if (!names.ok()) return names.status();
  std::vector<ArraySpec> wanted;
  for (ArraySpec spec : setup.network->signature().inputs) {
    if (!spec.name.starts_with(kClipPrefix)) continue;
    if (!Contains(*names, spec.name)) spec.name.erase(0, std::string_view(kClipPrefix).size());
    spec.required = whole;
    wanted.push_back(spec);
  }
  if (wanted.empty()) return NoStyle(setup);
  Result<NpzContents> clip = ReadNpz(path, wanted);
  if (!clip.ok()) return clip.status();
  for (const ArraySpec& spec : wanted) {
    const auto found = clip->arrays.find(spec.name);
    if (found == clip->arrays.end()) continue;
    GESTUS_RETURN_IF_ERROR(models::CheckArray(spec, found->second).In(path));
    const bool prefixed = spec.name.starts_with(kClipPrefix);
    (*inputs)[prefixed ? spec.name : kClipPrefix + spec.name] = std::move(found->second);
  }
  return Status();
}

std::string Summary(const Arguments& arguments, const Setup& setup, const Array& style,
                    const features::Account& account) {
  std::string text;
  for (const std::string& line : account.used) text += "read " + line + "\n";
  text += arguments.output + ": the style of " + arguments.Input() + ", " + ShapeText(style.shape) +
          " float32, for use with " + arguments.weights + "\n";
  for (const std::string& note : account.notes) text += "note: " + note + "\n";
  if (!setup.Trained()) text += std::string("warning: ") + kUntrained + "\n";
  return text;
}

std::string SummaryJson(const Arguments& arguments, const Setup& setup, const Array& style,
                        const features::Account& account) {
  JsonWriter json;
  json.BeginObject()
      .Member("weights", arguments.weights)
      .Member("trained", setup.Trained())
      .Member("clip", arguments.Input())
      .Member("output", arguments.output)
      .Member("shape", style.shape)
      .Member("used", account.used)
      .Member("notes", account.notes)
      .EndObject();
  return json.text();
}

}  // namespace

bool IsStyleInput(const std::string& name) {
  return name == kStyle || name.starts_with(kClipPrefix);
}

Status NoStyle(const Setup& setup) {
  return Status(Code::kInvalidArgument, setup.weights->path() + ": " + setup.network->kind() +
                                            " has no style, expected a network that takes one");
}

Result<bool> IsStyleFile(const std::string& path) {
  const Result<std::vector<std::string>> names = ListNpz(path);
  if (!names.ok()) return names.status();
  return Contains(*names, kChecksum);
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

Status LoadClip(const Setup& setup, const std::string& path, Arrays* inputs) {
  return ReadClipArrays(setup, path, /*whole=*/true, inputs);
}

Status LoadPartOfClip(const Setup& setup, const std::string& path, Arrays* inputs) {
  return ReadClipArrays(setup, path, /*whole=*/false, inputs);
}

Status RunStyle(const Arguments& arguments) {
  const Result<Inputs> given = SortInputs(arguments.inputs, arguments.words);
  if (!given.ok()) return given.status();
  // In a bundle the network is the one with a style, whatever the clip calls its arrays.
  Result<Setup> setup =
      OpenNetwork(arguments, [](const fb::Network&) { return std::vector<std::string>{kStyle}; });
  if (!setup.ok()) return setup.status();
  models::NetworkOptions network_options;
  network_options.kernels = setup->kernels;
  auto front_end = features::FrontEnd::Make(setup->weights, setup->name, network_options);
  if (!front_end.ok()) return front_end.status();
  features::Account account;
  Arrays clip;
  GESTUS_RETURN_IF_ERROR(ReadClip(arguments, *given, *setup, front_end->get(), &account, &clip));
  Result<AtomicFile> file = AtomicFile::Create(arguments.output);
  if (!file.ok()) return file.status().In(arguments.output);

  // Given a style clip and nothing else, a network computes the style and nothing else.
  models::RunOptions options;
  options.threads = arguments.threads;
  models::RunReport report;
  Result<Arrays> outputs = setup->network->Run(clip, options, &report);
  if (!outputs.ok()) return outputs.status().In(arguments.Input());
  account.notes.insert(account.notes.end(), report.notes.begin(), report.notes.end());
  const auto style = outputs->find(kStyle);
  if (style == outputs->end()) return NoStyle(*setup);

  const Arrays contents = {{kStyle, style->second},
                           {kChecksum, ChecksumArray(setup->weights->checksum())}};
  GESTUS_RETURN_IF_ERROR(WriteNpz(contents, &*file).In(arguments.output));
  GESTUS_RETURN_IF_ERROR(file->Commit().In(arguments.output));
  return Print(arguments.json ? SummaryJson(arguments, *setup, style->second, account)
                              : Summary(arguments, *setup, style->second, account));
}

}  // namespace gestus::cli
