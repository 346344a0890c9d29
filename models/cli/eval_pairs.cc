// PairSequences.
#include <algorithm>
#include <set>

#include "models/cli/eval_scores.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

const Sequence* Named(const std::vector<Sequence>& sequences, const std::string& name) {
  const auto found = std::find_if(sequences.begin(), sequences.end(),
                                  [&](const Sequence& s) { return s.name == name; });
  return found == sequences.end() ? nullptr : &*found;
}

const Sequence* PartnerOf(const Sequence& prediction, const std::vector<Sequence>& others,
                          bool serves_all) {
  if (others.empty()) return nullptr;
  return serves_all ? &others.front() : Named(others, prediction.name);
}

void NoteAlone(const Material& material, Role role, Role other, std::vector<std::string>* notes) {
  for (const Sequence& sequence : material.sequences[role]) {
    if (Named(material.sequences[other], sequence.name) == nullptr)
      notes->push_back(sequence.path + " was left out: no " + kRoleNames[other] + " has its name");
  }
}

}  // namespace

Status PairSequences(const std::array<bool, kRoles>& folders, Material* material) {
  const auto& predictions = material->sequences[kPrediction];
  const auto& truths = material->sequences[kTruth];
  const bool lone_pair = !folders[kPrediction] && !folders[kTruth];
  for (const Sequence& prediction : predictions) {
    Case one;
    one.of[kPrediction] = &prediction;
    one.of[kTruth] = PartnerOf(prediction, truths, lone_pair);
    if (!truths.empty() && one.of[kTruth] == nullptr) continue;
    for (const Role role : {kSource, kTarget})
      one.of[role] = PartnerOf(
          prediction, material->sequences[role],
          !folders[role] || (!folders[kPrediction] && material->sequences[role].size() == 1));
    material->cases.push_back(one);
  }
  if (material->cases.empty())
    return Status(Code::kBadInput, predictions.front().path +
                                       ": no truth has the name of a prediction, expected names "
                                       "such as " +
                                       predictions.front().name + ".npz in both folders");
  if (!truths.empty() && !lone_pair) {
    NoteAlone(*material, kPrediction, kTruth, &material->notes);
    NoteAlone(*material, kTruth, kPrediction, &material->notes);
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
