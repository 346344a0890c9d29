// Builds the text and the JSON of `infer-cli info` from the checked file, never from raw bytes.
#include "models/cli/info.h"

#include <map>
#include <set>

#include "models/cli/json.h"
#include "models/cli/setup.h"
#include "models/io/text.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

using models::ArraySpec;

constexpr const char* kIndent = "  ";

struct NamedNetwork {
  const fb::Network* stored = nullptr;
  std::unique_ptr<models::Network> network;
};

// All networks of the file, or the one that --network names.
Result<std::vector<NamedNetwork>> MakeNetworks(const std::shared_ptr<const WeightsFile>& weights,
                                               const std::string& name, bool plan) {
  std::vector<NamedNetwork> networks;
  for (const fb::Network* stored : *weights->root().networks()) {
    const std::string stored_name = stored->name()->str();
    if (!name.empty() && name != stored_name) continue;
    Result<std::unique_ptr<models::Network>> network =
        models::MakeNetwork(weights, stored_name, {.plan = plan});
    if (!network.ok()) return network.status();
    networks.push_back({stored, *std::move(network)});
  }
  if (!networks.empty()) return networks;
  return Status(Code::kNotFound, weights->path() + ": no network " + name + ", expected one of " +
                                     std::to_string(weights->root().networks()->size()) +
                                     " that infer-cli info lists");
}

// Weights alone: no self-test vectors, no vocabulary.
std::uint64_t Parameters(const WeightsFile& weights) {
  std::set<std::string> others;
  for (const fb::Network* network : *weights.root().networks()) {
    const fb::SelfTest* test = network->self_test();
    if (test == nullptr) continue;
    for (const flatbuffers::String* name : *test->inputs()) others.insert(name->str());
    others.insert(test->output()->str());
  }
  for (const WeightsFile::Entry& entry : weights.tensors()) others.insert(entry.scale);
  std::uint64_t count = 0;
  for (const WeightsFile::Entry& entry : weights.tensors()) {
    const DType dtype = entry.view.dtype;
    const bool weight = dtype == DType::kF32 || dtype == DType::kBF16 || dtype == DType::kI8;
    if (weight && others.count(entry.name) == 0)
      count += static_cast<std::uint64_t>(entry.view.shape.NumElements());
  }
  return count;
}

/// "float32 1.2 MB, int8 85.1 MB": what the tensors of each type take.
std::string TypesText(const WeightsFile& weights) {
  std::map<DType, std::uint64_t> bytes;
  for (const WeightsFile::Entry& entry : weights.tensors()) bytes[entry.view.dtype] += entry.bytes;
  std::string text;
  for (const auto& [dtype, sum] : bytes)
    text += (text.empty() ? "" : ", ") + std::string(Name(dtype)) + " " + Bytes(sum);
  return text;
}

// "(frames, 128 mel bins)"
std::string SpecShape(const ArraySpec& spec) {
  std::string text = "(";
  for (std::size_t i = 0; i < spec.shape.size(); ++i) {
    const std::string axis = i < spec.axes.size() ? spec.axes[i] : "";
    text += i == 0 ? "" : ", ";
    if (spec.shape[i] == ArraySpec::kAny) {
      text += axis.empty() ? "any" : axis;
    } else {
      text += std::to_string(spec.shape[i]) + (axis.empty() ? "" : " " + axis);
    }
  }
  return text + (spec.shape.size() == 1 ? ",)" : ")");
}

std::string SpecsText(const std::vector<ArraySpec>& specs) {
  std::vector<std::vector<std::string>> rows;
  for (const ArraySpec& spec : specs) {
    const std::string unit = spec.unit.empty() || spec.unit == "-" ? "" : " [" + spec.unit + "]";
    rows.push_back({spec.name, Name(spec.dtype), SpecShape(spec), spec.required ? "" : "optional",
                    spec.meaning + unit});
  }
  return Table(rows, {}, "    ");
}

std::string Or(const flatbuffers::String* text, const char* otherwise) {
  return text == nullptr || text->size() == 0 ? otherwise : text->str();
}

// What the file says of its making, in pairs of label and value.
Fields ProvenanceFields(const fb::Provenance& p) {
  constexpr const char* kUnsaid = "-";
  return {{"trained", p.trained() ? "yes" : std::string("no: ") + kUntrained},
          {"trained on", Or(p.trained_on(), kUnsaid)},
          {"trained at", Or(p.trained_at(), kUnsaid)},
          {"recipe", Or(p.recipe(), kUnsaid)},
          {"licence", Or(p.licence(), kUnsaid)},
          {"converter", Or(p.converter(), kUnsaid)},
          {"source", Or(p.source(), kUnsaid)}};
}

std::string FieldsText(const Fields& fields, const std::string& indent) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, value] : fields) {
    rows.push_back({name, OneLine(value, std::string::npos)});
  }
  return Table(rows, {}, indent);
}

std::string NetworkText(const NamedNetwork& n, bool plan) {
  const models::Signature& signature = n.network->signature();
  std::string text = "\nnetwork " + n.stored->name()->str() + ": " + n.network->kind() + "\n";
  text += "  inputs\n" + SpecsText(signature.inputs);
  text += "  outputs\n" + SpecsText(signature.outputs);
  text += "  configuration\n" + FieldsText(ConfigFields(*n.stored), "    ");
  if (n.stored->joints() != nullptr && n.stored->joints()->size() > 0) {
    text += "  joints\n    ";
    for (const fb::Joint* joint : *n.stored->joints()) text += joint->name()->str() + " ";
    text.back() = '\n';
  }
  if (plan) text += "  plan\n" + n.network->PlanText();
  return text;
}

std::string InfoText(const WeightsFile& weights, const std::vector<NamedNetwork>& networks,
                     bool plan) {
  constexpr std::size_t kHexDigits = 16;
  std::string checksum(kHexDigits, '0');
  for (std::size_t i = 0; i < kHexDigits; ++i) {
    checksum[kHexDigits - 1 - i] = "0123456789abcdef"[(weights.checksum() >> (4 * i)) & 15];
  }
  std::string text = weights.path() + "\n";
  Fields fields = {{"size", Bytes(weights.file_size())},
                   {"format", std::to_string(weights.format_version())},
                   {"checksum", checksum},
                   {"parameters", Grouped(Parameters(weights))},
                   {"types", TypesText(weights)}};
  const Fields provenance = ProvenanceFields(*weights.root().provenance());
  fields.insert(fields.end(), provenance.begin(), provenance.end());
  text += FieldsText(fields, kIndent);
  for (const NamedNetwork& network : networks) text += NetworkText(network, plan);
  std::vector<std::vector<std::string>> rows;
  for (const WeightsFile::Entry& entry : weights.tensors()) {
    rows.push_back(
        {entry.name, Name(entry.view.dtype), entry.view.shape.ToString(), Bytes(entry.bytes)});
  }
  return text + "\n" + Count(rows.size(), "tensor") + "\n" + Table(rows, {3});
}

void SpecsJson(JsonWriter* json, const char* key, const std::vector<ArraySpec>& specs) {
  json->Key(key).BeginArray();
  for (const ArraySpec& spec : specs) {
    json->BeginObject()
        .Member("name", spec.name)
        .Member("dtype", Name(spec.dtype))
        .Member("shape", spec.shape)  // -1: the input decides
        .Member("axes", spec.axes)
        .Member("required", spec.required)
        .Member("unit", spec.unit)
        .Member("meaning", spec.meaning)
        .EndObject();
  }
  json->EndArray();
}

void FieldsJson(JsonWriter* json, const char* key, const Fields& fields) {
  json->Key(key).BeginObject();
  for (const auto& [name, value] : fields) json->Member(name, value);
  json->EndObject();
}

std::string InfoJson(const WeightsFile& weights, const std::vector<NamedNetwork>& networks,
                     bool plan) {
  JsonWriter json;
  json.BeginObject()
      .Member("weights", weights.path())
      .Member("bytes", weights.file_size())
      .Member("format", static_cast<std::uint64_t>(weights.format_version()))
      .Member("checksum", std::to_string(weights.checksum()))  // above 2^53: no JSON number
      .Member("parameters", Parameters(weights))
      .Member("trained", weights.root().provenance()->trained());
  FieldsJson(&json, "provenance", ProvenanceFields(*weights.root().provenance()));
  json.Key("networks").BeginArray();
  for (const NamedNetwork& n : networks) {
    json.BeginObject().Member("name", n.stored->name()->str()).Member("kind", n.network->kind());
    SpecsJson(&json, "inputs", n.network->signature().inputs);
    SpecsJson(&json, "outputs", n.network->signature().outputs);
    FieldsJson(&json, "configuration", ConfigFields(*n.stored));
    if (plan) json.Member("plan", n.network->PlanText());
    json.EndObject();
  }
  json.EndArray().Key("tensors").BeginArray();
  for (const WeightsFile::Entry& entry : weights.tensors()) {
    std::vector<std::int64_t> shape;
    for (int i = 0; i < entry.view.shape.rank(); ++i) shape.push_back(entry.view.shape[i]);
    json.BeginObject()
        .Member("name", entry.name)
        .Member("dtype", Name(entry.view.dtype))
        .Member("shape", shape)
        .Member("bytes", entry.bytes)
        .EndObject();
  }
  json.EndArray().EndObject();
  return json.text();
}

}  // namespace

Status RunInfo(const Arguments& arguments) {
  const Result<std::shared_ptr<const WeightsFile>> weights = WeightsFile::Open(arguments.weights);
  if (!weights.ok()) return weights.status();
  const Result<std::vector<NamedNetwork>> networks =
      MakeNetworks(*weights, arguments.network, arguments.plan);
  if (!networks.ok()) return networks.status();
  return Print(arguments.json ? InfoJson(**weights, *networks, arguments.plan)
                              : InfoText(**weights, *networks, arguments.plan));
}

}  // namespace gestus::cli
