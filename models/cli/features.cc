// The stages that need no network, and the inputs of the network when a weights file is there.
#include "models/cli/features.h"

#include <algorithm>

#include "models/cli/feed.h"
#include "models/cli/inputs.h"
#include "models/cli/json.h"
#include "models/cli/npz.h"
#include "models/cli/report.h"
#include "models/cli/setup.h"
#include "models/features/stages.h"

namespace gestus::cli {
namespace {

using models::Arrays;

/// Adds what the network of the weights file would be fed with.
Status AddNetworkInputs(const Arguments& arguments, const Inputs& inputs,
                        const features::Recording& recording, features::FeatureSpec* spec,
                        features::Account* account, Arrays* arrays) {
  Arguments with_weights = arguments;
  with_weights.weights = inputs.weights;
  const Result<Setup> setup = OpenNetworkFor(with_weights, inputs);
  if (!setup.ok()) return setup.status();
  models::NetworkOptions options;
  options.kernels = setup->kernels;
  auto front_end = features::FrontEnd::Make(setup->weights, setup->name, options);
  if (!front_end.ok()) return front_end.status();
  *spec = (*front_end)->spec();
  if (recording.audio.empty() && recording.transcript.empty()) return Status();
  features::Recording spoken = recording;
  spoken.openpose.clear();
  auto stream = (*front_end)->Open(spoken, account);
  if (!stream.ok()) return stream.status();
  Result<Arrays> made = (*stream)->Next((*stream)->total());
  if (!made.ok()) return made.status();
  arrays->merge(*made);
  arrays->merge((*stream)->Beside());
  for (std::string& note : (*stream)->Notes()) account->notes.push_back(std::move(note));
  return Status();
}

/// What is read both as a stage and for the network is odd both times.
void DropRepeated(std::vector<std::string>* notes) {
  std::vector<std::string> kept;
  for (std::string& note : *notes) {
    if (std::find(kept.begin(), kept.end(), note) == kept.end()) kept.push_back(std::move(note));
  }
  *notes = std::move(kept);
}

std::string Text(const Arguments& arguments, const Arrays& arrays,
                 const features::Account& account) {
  std::string text;
  for (const std::string& line : account.used) text += "read   " + line + "\n";
  text += "wrote  " + arguments.output + ": " + ArraysText(arrays) + "\n";
  for (const std::string& note : account.notes) text += "note   " + note + "\n";
  return text;
}

std::string Json(const Arguments& arguments, const Arrays& arrays,
                 const features::Account& account) {
  JsonWriter json;
  json.BeginObject().Member("output", arguments.output).Member("used", account.used);
  json.Key("arrays").BeginArray();
  for (const auto& [name, array] : arrays)
    json.BeginObject().Member("name", name).Member("shape", array.shape).EndObject();
  json.EndArray().Member("notes", account.notes).EndObject();
  return json.text();
}

}  // namespace

Status RunFeatures(const Arguments& arguments) {
  const Result<Inputs> inputs = SortInputs(arguments.inputs, arguments.words);
  if (!inputs.ok()) return inputs.status();
  const features::Recording recording = {.audio = inputs->audio,
                                         .transcript = inputs->transcript,
                                         .openpose = inputs->openpose,
                                         .pose_rate = arguments.pose_rate};
  if (!recording.Any() && inputs->openface.empty())
    return Status(Code::kBadInput, arguments.Input() +
                                       ": nothing to make features of, expected a "
                                       "recording, words or key points");
  features::Account account;
  account.notes = inputs->notes;
  if (!inputs->arrays.empty()) account.notes.push_back(inputs->arrays + " was not used");
  features::FeatureSpec spec;
  Arrays network_inputs;
  if (!inputs->weights.empty())
    GESTUS_RETURN_IF_ERROR(
        AddNetworkInputs(arguments, *inputs, recording, &spec, &account, &network_inputs));
  Result<AtomicFile> file = AtomicFile::Create(arguments.output);
  if (!file.ok()) return file.status().In(arguments.output);
  Result<Arrays> arrays =
      features::Stages(recording, inputs->openface, spec, &account, !arguments.no_sound);
  if (!arrays.ok()) return arrays.status();
  arrays->merge(network_inputs);
  if (arguments.no_sound && arrays->empty())
    return Status(Code::kBadInput, arguments.Input() +
                                       ": nothing is left without the stages of the sound, "
                                       "expected words, key points or a weights file");
  DropRepeated(&account.notes);
  GESTUS_RETURN_IF_ERROR(WriteNpz(*arrays, &*file).In(arguments.output));
  GESTUS_RETURN_IF_ERROR(file->Commit().In(arguments.output));
  return Print(arguments.json ? Json(arguments, *arrays, account)
                              : Text(arguments, *arrays, account));
}

}  // namespace gestus::cli
