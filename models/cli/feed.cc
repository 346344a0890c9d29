#include "models/cli/feed.h"

#include <algorithm>

#include "models/cli/npz.h"
#include "models/cli/report.h"
#include "models/cli/style.h"
#include "models/cli/style_file.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

using models::Arrays;
using models::ArraySpec;

/// Arrays that are there already, all at once.
class ReadyArrays final : public features::InputStream {
 public:
  explicit ReadyArrays(Arrays arrays) : arrays_(std::move(arrays)) {}
  std::int64_t total() const override { return 1; }
  std::int64_t unit() const override { return 1; }
  Result<Arrays> Next(std::int64_t) override { return arrays_; }

 private:
  Arrays arrays_;
};

// A style alone is input enough for `infer-cli style`, but here something must be said with it.
Status CheckAnyInput(const std::vector<ArraySpec>& wanted, const NpzContents& file) {
  const ArraySpec* first = nullptr;
  for (const ArraySpec& spec : wanted) {
    if (IsStyleInput(spec.name)) continue;
    if (file.arrays.count(spec.name) != 0) return Status();
    if (first == nullptr) first = &spec;
  }
  if (first == nullptr) return Status();
  std::string found;
  for (const auto& [name, array] : file.arrays) found += (found.empty() ? "" : ", ") + name;
  for (const std::string& name : file.others) found += (found.empty() ? "" : ", ") + name;
  return Status(Code::kBadInput, first->name + ": missing, found " +
                                     (found.empty() ? "no arrays" : found) + ", expected " +
                                     first->meaning);
}

/// The network's inputs that the .npz holds; nothing but them is required when it stands alone.
Result<Arrays> ReadArrays(const Arguments& arguments, const Inputs& inputs, const Setup& setup,
                          features::Account* account) {
  std::vector<ArraySpec> wanted;
  for (ArraySpec spec : setup.network->signature().inputs) {
    spec.required = spec.required && !inputs.Spoken();
    if (arguments.style.empty() || !IsStyleInput(spec.name)) wanted.push_back(spec);
  }
  Result<NpzContents> file = ReadNpz(inputs.arrays, wanted);
  if (!file.ok()) return file.status();
  if (!inputs.Spoken()) GESTUS_RETURN_IF_ERROR(CheckAnyInput(wanted, *file).In(inputs.arrays));
  for (const std::string& name : file->others)
    account->notes.push_back(name + " in " + inputs.arrays + " was not used");
  if (!file->arrays.empty())
    account->used.push_back(inputs.arrays + ": " + ArraysText(file->arrays));
  return std::move(file->arrays);
}

features::Recording RecordingOf(const Inputs& inputs, const Arguments& arguments) {
  return {.audio = inputs.audio,
          .transcript = inputs.transcript,
          .openpose = inputs.openpose,
          .pose_rate = arguments.pose_rate};
}

void NoteUnused(const Inputs& inputs, features::Account* account) {
  account->notes.insert(account->notes.end(), inputs.notes.begin(), inputs.notes.end());
  if (!inputs.weights.empty())
    account->notes.push_back(inputs.weights + " was not used: the weights file comes first");
  if (!inputs.openface.empty())
    account->notes.push_back(inputs.openface +
                             " was not used: OpenFace's features are no input of a network");
}

/// The error of a run without anything that could be said.
Status NothingToSay(const Arguments& arguments, const Inputs& inputs) {
  const char* expected = ", expected a recording, words or arrays";
  if (!inputs.openface.empty())
    return Status(Code::kBadInput,
                  inputs.openface + ": OpenFace's features are no input of a network" + expected);
  if (!inputs.openpose.empty())
    return Status(Code::kBadInput, inputs.openpose + ": poses belong to a --style" + expected);
  return Status(Code::kBadInput, arguments.Input() + ": nothing to be said" + expected);
}

models::NetworkOptions OptionsOf(const Setup& setup) {
  models::NetworkOptions options;
  options.kernels = setup.kernels;
  return options;
}

bool HasStyle(const Setup& setup) {
  const auto& inputs = setup.network->signature().inputs;
  return std::any_of(inputs.begin(), inputs.end(),
                     [](const ArraySpec& spec) { return IsStyleInput(spec.name); });
}

Result<std::unique_ptr<features::FrontEnd>> MakeFrontEnd(const Setup& setup) {
  return features::FrontEnd::Make(setup.weights, setup.name, OptionsOf(setup));
}

}  // namespace

Result<Setup> OpenNetworkFor(const Arguments& arguments, const Inputs& inputs) {
  return OpenNetwork(
      arguments, [&](const fb::Network& network) -> Result<std::vector<std::string>> {
        std::vector<std::string> names;
        if (!inputs.arrays.empty()) {
          Result<std::vector<std::string>> listed = ListNpz(inputs.arrays);
          if (!listed.ok()) return listed.status();
          names = *std::move(listed);
        }
        if (!arguments.style.empty()) names.push_back("style");
        if (!inputs.Spoken()) return names;
        const Result<features::FeatureSpec> spec = features::ReadFeatureSpec(network);
        if (!spec.ok()) return spec.status();
        for (std::string& name : features::FrontEnd::Makes(*spec, RecordingOf(inputs, arguments)))
          names.push_back(std::move(name));
        return names;
      });
}

Status ReadClip(const Arguments& arguments, const Inputs& inputs, const Setup& setup,
                features::FrontEnd* front_end, features::Account* account, Arrays* arrays) {
  if (!HasStyle(setup)) return NoStyle(setup);
  NoteUnused(inputs, account);
  if (inputs.OnlyArrays()) {
    if (inputs.arrays.empty())
      return Status(Code::kBadInput,
                    "style: nothing to take it from, expected a recording, words, poses or arrays");
    return LoadClip(setup, inputs.arrays, arrays);
  }
  features::Recording recording = RecordingOf(inputs, arguments);
  if (!inputs.arrays.empty()) {
    GESTUS_RETURN_IF_ERROR(LoadPartOfClip(setup, inputs.arrays, &recording.arrays));
    recording.arrays_path = inputs.arrays;
  }
  Result<Arrays> clip = front_end->StyleClip(recording, account);
  if (!clip.ok()) return clip.status();
  *arrays = *std::move(clip);
  return Status();
}

Status ReadStyle(const Arguments& arguments, const Inputs& inputs, const Setup& setup,
                 features::FrontEnd* front_end, features::Account* account, Arrays* arrays) {
  if (inputs.OnlyArrays() && !inputs.arrays.empty()) {
    const Result<bool> ready = IsStyleFile(inputs.arrays);
    if (!ready.ok()) return ready.status();
    if (*ready) return LoadStyleFile(setup, inputs.arrays, arrays);
  }
  return ReadClip(arguments, inputs, setup, front_end, account, arrays);
}

Result<Feed> OpenFeed(const Arguments& arguments, const Inputs& inputs, const Setup& setup) {
  Feed feed;
  if (!inputs.Spoken() && inputs.arrays.empty()) return NothingToSay(arguments, inputs);
  if (inputs.arrays.empty() && arguments.style.empty() && HasStyle(setup))
    return Status(Code::kInvalidArgument,
                  "command line: no --style, expected a .style file, or a folder with a speaker's "
                  "recording, words and poses");
  Result<std::unique_ptr<features::FrontEnd>> front_end = MakeFrontEnd(setup);
  if (!front_end.ok()) return front_end.status();
  if (!inputs.arrays.empty()) {
    Result<Arrays> arrays = ReadArrays(arguments, inputs, setup, &feed.account);
    if (!arrays.ok()) return arrays.status();
    feed.arrays = *std::move(arrays);
  }
  NoteUnused(inputs, &feed.account);
  if (!arguments.style.empty()) {
    Result<Inputs> style = SortInputs({arguments.style}, "");
    if (!style.ok()) return style.status();
    features::Account account;
    GESTUS_RETURN_IF_ERROR(
        ReadStyle(arguments, *style, setup, front_end->get(), &account, &feed.style));
    feed.style_used = std::move(account.used);
    for (const std::string& note : account.notes)
      feed.account.notes.push_back(note.starts_with("style") ? note : "style: " + note);
  }
  feed.only_arrays = !inputs.Spoken();
  if (feed.only_arrays) {
    feed.stream = std::make_unique<ReadyArrays>(feed.arrays);
    return feed;
  }
  features::Recording recording = RecordingOf(inputs, arguments);
  for (const auto& [name, array] : feed.arrays) {
    if (IsStyleInput(name)) {
      feed.style[name] = array;
    } else {
      recording.arrays[name] = array;
    }
  }
  recording.arrays_path = inputs.arrays;
  feed.front_end = *std::move(front_end);
  auto stream = feed.front_end->Open(recording, &feed.account);
  if (!stream.ok()) return stream.status();
  feed.stream = *std::move(stream);
  return feed;
}

}  // namespace gestus::cli
