// PairSequences.
#include <algorithm>
#include <map>

#include "models/cli/eval_scores.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

using Names = std::map<std::string, const Sequence*>;

Names NamesOf(const std::vector<Sequence>& sequences) {
  Names names;
  for (const Sequence& sequence : sequences) names.emplace(sequence.name, &sequence);
  return names;
}

const Sequence* PartnerOf(const Sequence& prediction, const std::vector<Sequence>& others,
                          const Names& names, bool serves_all) {
  if (others.empty()) return nullptr;
  if (serves_all) return &others.front();
  const auto found = names.find(prediction.name);
  return found == names.end() ? nullptr : found->second;
}

void NoteAlone(const std::vector<Sequence>& sequences, const Names& others, Role other,
               std::vector<std::string>* notes) {
  for (const Sequence& sequence : sequences) {
    if (others.count(sequence.name) == 0)
      notes->push_back(sequence.path + " was left out: no " + kRoleNames[other] + " has its name");
  }
}

}  // namespace

Status PairSequences(const std::array<bool, kRoles>& folders, Material* material) {
  const auto& predictions = material->sequences[kPrediction];
  const auto& truths = material->sequences[kTruth];
  const bool lone_pair = !folders[kPrediction] && !folders[kTruth];
  std::array<Names, kRoles> names;
  for (std::size_t role = 0; role < kRoles; ++role)
    names[role] = NamesOf(material->sequences[role]);
  for (const Sequence& prediction : predictions) {
    Case one;
    one.of[kPrediction] = &prediction;
    one.of[kTruth] = PartnerOf(prediction, truths, names[kTruth], lone_pair);
    if (!truths.empty() && one.of[kTruth] == nullptr) continue;
    for (const Role role : {kSource, kTarget})
      one.of[role] = PartnerOf(prediction, material->sequences[role], names[role], !folders[role]);
    material->cases.push_back(one);
  }
  if (material->cases.empty())
    return Status(Code::kBadInput, predictions.front().path +
                                       ": no truth has the name of a prediction, expected names "
                                       "such as " +
                                       predictions.front().name + ".npz in both folders");
  if (!truths.empty() && !lone_pair) {
    NoteAlone(predictions, names[kTruth], kTruth, &material->notes);
    NoteAlone(truths, names[kPrediction], kPrediction, &material->notes);
  }
  for (const Role role : {kSource, kTarget}) {
    const auto paired = static_cast<std::uint64_t>(
        std::count_if(material->cases.begin(), material->cases.end(),
                      [role](const Case& one) { return one.of[role] != nullptr; }));
    if (!material->sequences[role].empty() && paired < material->cases.size())
      material->notes.push_back(std::to_string(paired) + " of " +
                                Count(material->cases.size(), "prediction") + " have a " +
                                kRoleNames[role] +
                                " of their name; the others are compared with its mean only");
  }
  return Status();
}

}  // namespace gestus::cli
