// Taking styles from clips, and giving them to a network.
#include "models/cli/style.h"

#include <algorithm>

#include "models/cli/feed.h"
#include "models/cli/inputs.h"
#include "models/cli/json.h"
#include "models/cli/npy.h"
#include "models/cli/npz.h"
#include "models/cli/style_file.h"
#include "models/io/text.h"
#include "models/segments.h"
#include "models/styles/blend.h"

namespace gestus::cli {
namespace {

using models::Arrays;
using models::ArraySpec;

constexpr const char* kStyle = "style";
constexpr const char* kClipPrefix = "style_";

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const ArraySpec* FindInput(const models::Network& network, const std::string& name) {
  for (const ArraySpec& spec : network.signature().inputs) {
    if (spec.name == name) return &spec;
  }
  return nullptr;
}

std::uint64_t SegmentsOf(const styles::Style& style) {
  std::uint64_t segments = 0;
  for (const styles::Source& source : style.made_of)
    segments += static_cast<std::uint64_t>(source.segments);
  return segments;
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

std::string Summary(const Arguments& arguments, const Setup& setup, const styles::Style& style,
                    const features::Account& account) {
  std::string text;
  for (const std::string& line : account.used) text += "read " + line + "\n";
  text += arguments.output + ": the style of " + arguments.Input() + ", " +
          ShapeText({static_cast<std::int64_t>(style.values.size())}) + " float32 of " +
          Count(SegmentsOf(style), "segment") + ", for use with " + arguments.weights + "\n";
  for (const std::string& note : account.notes) text += "note: " + note + "\n";
  if (!setup.Trained()) text += std::string("warning: ") + kUntrained + "\n";
  return text;
}

std::string SummaryJson(const Arguments& arguments, const Setup& setup, const styles::Style& style,
                        const features::Account& account) {
  JsonWriter json;
  json.BeginObject()
      .Member("weights", arguments.weights)
      .Member("trained", setup.Trained())
      .Member("clip", arguments.Input())
      .Member("output", arguments.output)
      .Member("shape", std::vector<std::int64_t>{static_cast<std::int64_t>(style.values.size())})
      .Member("segments", SegmentsOf(style))
      .Member("used", account.used)
      .Member("notes", account.notes)
      .EndObject();
  return json.text();
}

/// One recording of a speaker: the files of it.
struct Clip {
  std::string name;
  Inputs inputs;
};

/// Folders and arrays are a clip each, where nothing else is given; other files together are one.
Result<std::vector<Clip>> ClipsOf(const Arguments& arguments) {
  bool apart = arguments.inputs.size() > 1 && arguments.words.empty();
  for (const std::string& path : arguments.inputs) {
    const Result<InputKind> kind = Recognise(path);
    if (!kind.ok()) return kind.status();
    apart = apart && (*kind == InputKind::kFolder || *kind == InputKind::kArrays);
  }
  std::vector<std::vector<std::string>> groups;
  if (apart) {
    for (const std::string& path : arguments.inputs) groups.push_back({path});
  } else {
    groups.push_back(arguments.inputs);
  }
  std::vector<Clip> clips;
  for (const std::vector<std::string>& paths : groups) {
    Result<Inputs> inputs = SortInputs(paths, arguments.words);
    if (!inputs.ok()) return inputs.status();
    std::string name;
    for (const std::string& path : paths) name += (name.empty() ? "" : ", ") + LastPart(path);
    clips.push_back({name, *std::move(inputs)});
  }
  return clips;
}

/// The style of one clip; its weight is the number of its segments.
Result<styles::Ingredient> TakeStyle(const Arguments& arguments, const Clip& clip,
                                     const Setup& setup, features::FrontEnd* front_end,
                                     features::Account* account) {
  Arrays arrays;
  GESTUS_RETURN_IF_ERROR(ReadClip(arguments, clip.inputs, setup, front_end, account, &arrays));
  // Given a style clip and nothing else, a network computes the style and nothing else.
  models::RunOptions options;
  options.threads = arguments.threads;
  models::RunReport report;
  Result<Arrays> outputs = setup.network->Run(arrays, options, &report);
  if (!outputs.ok()) return outputs.status().In(clip.name);
  account->notes.insert(account->notes.end(), report.notes.begin(), report.notes.end());
  const auto style = outputs->find(kStyle);
  if (style == outputs->end()) return NoStyle(setup);
  const auto windows =
      models::Windows(arrays.at("style_speech").shape[0], front_end->spec().style_frames);
  styles::Ingredient taken;
  taken.from = {clip.name, {}};
  taken.from.style.values = style->second.f32;
  taken.from.style.made_of = {{clip.name, 1, static_cast<std::int64_t>(windows.size())}};
  taken.weight = static_cast<double>(windows.size());
  return taken;
}

}  // namespace

bool IsStyleInput(const std::string& name) {
  return name == kStyle || name.starts_with(kClipPrefix);
}

Status NoStyle(const Setup& setup) {
  return Status(Code::kInvalidArgument, setup.weights->path() + ": " + setup.network->kind() +
                                            " has no style, expected a network that takes one");
}

Status LoadStyleFile(const Setup& setup, const std::string& path, Arrays* inputs) {
  const ArraySpec* style = FindInput(*setup.network, kStyle);
  if (style == nullptr) return NoStyle(setup);
  Result<styles::Style> read = ReadStyleFile(path);
  if (!read.ok()) return read.status();
  if (read->weights_checksum != setup.weights->checksum()) {
    return Status(Code::kBadInput, path + ": weights_checksum: made by other weights, expected " +
                                       setup.weights->path());
  }
  if (!read->network.empty() && read->network != setup.name)
    return Status(Code::kBadInput,
                  path + ": network: made by " + read->network + ", expected " + setup.name);
  models::Array array;
  array.shape = {static_cast<std::int64_t>(read->values.size())};
  array.f32 = std::move(read->values);
  GESTUS_RETURN_IF_ERROR(models::CheckArray(*style, array).In(path));
  (*inputs)[kStyle] = std::move(array);
  return Status();
}

Status LoadClip(const Setup& setup, const std::string& path, Arrays* inputs) {
  return ReadClipArrays(setup, path, /*whole=*/true, inputs);
}

Status LoadPartOfClip(const Setup& setup, const std::string& path, Arrays* inputs) {
  return ReadClipArrays(setup, path, /*whole=*/false, inputs);
}

Status RunStyle(const Arguments& arguments) {
  const Result<std::vector<Clip>> clips = ClipsOf(arguments);
  if (!clips.ok()) return clips.status();
  // In a bundle the network is the one with a style, whatever the clip calls its arrays.
  Result<Setup> setup =
      OpenNetwork(arguments, [](const fb::Network&) { return std::vector<std::string>{kStyle}; });
  if (!setup.ok()) return setup.status();
  models::NetworkOptions network_options;
  network_options.kernels = setup->kernels;
  auto front_end = features::FrontEnd::Make(setup->weights, setup->name, network_options);
  if (!front_end.ok()) return front_end.status();
  if (FindInput(*setup->network, kStyle) == nullptr) return NoStyle(*setup);
  Result<AtomicFile> file = AtomicFile::Create(arguments.output);
  if (!file.ok()) return file.status().In(arguments.output);

  features::Account account;
  std::vector<styles::Ingredient> taken;
  for (const Clip& clip : *clips) {
    Result<styles::Ingredient> one = TakeStyle(arguments, clip, *setup, front_end->get(), &account);
    if (!one.ok()) return one.status();
    taken.push_back(*std::move(one));
  }
  Result<styles::Blend> mean = styles::MakeBlend(taken);
  if (!mean.ok()) return mean.status();
  styles::Style& style = mean->style;
  style.weights_checksum = setup->weights->checksum();
  style.network = setup->name;
  Result<std::vector<styles::Part>> parts =
      styles::PartsOf(*setup->weights->FindNetwork(setup->name));
  if (!parts.ok()) return parts.status();
  style.parts = *std::move(parts);
  GESTUS_RETURN_IF_ERROR(WriteStyleFile(style, arguments.output, &*file));
  return Print(arguments.json ? SummaryJson(arguments, *setup, style, account)
                              : Summary(arguments, *setup, style, account));
}

}  // namespace gestus::cli
