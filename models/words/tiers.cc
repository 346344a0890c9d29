#include "models/words/tiers.h"

#include <algorithm>

#include "models/io/text.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// Whether a tier's name says `kind`: by itself, or beside the speaker's name as the Montreal Forced
// Aligner ("anna - words") and FAVE ("anna - word") write it.
bool IsNamed(std::string_view name, std::string_view kind) {
  const std::string lower = LowerAscii(TrimSpace(name));
  if (lower == kind || lower == std::string(kind) + "s") return true;
  const std::size_t dash = lower.rfind(" - ");
  return dash != std::string::npos && IsNamed(lower.substr(dash + 3), kind);
}

bool HoldsWords(const Tier& tier) {
  // ORT-MAU is WebMAUS's.
  return IsNamed(tier.name, "word") || LowerAscii(TrimSpace(tier.name)) == "ort-mau";
}

bool HoldsPhones(const Tier& tier) {
  for (const char* kind : {"phone", "phoneme", "segment", "syllable", "mau"}) {
    if (IsNamed(tier.name, kind)) return true;
  }
  return false;
}

void AddTier(const Tier& tier, Draft* draft) {
  for (const Interval& interval : tier.intervals) {
    if (!IsSilenceLabel(interval.text)) draft->Add(interval.text, interval.span);
  }
}

}  // namespace

bool IsSilenceLabel(std::string_view label) {
  label = TrimSpace(label);
  if (label.empty()) return true;
  if (label.size() > 8) return false;
  const std::string lower = LowerAscii(label);
  for (const char* silence :
       {"sil", "sp", "spn", "<eps>", "<sil>", "<p:>", "<p>", "!sil", "{sl}"}) {
    if (lower == silence) return true;
  }
  return false;
}

Status AddWordTiers(const std::vector<Tier>& tiers, Draft* draft) {
  std::size_t found = 0;
  for (const Tier& tier : tiers) {
    if (!HoldsWords(tier)) continue;
    AddTier(tier, draft);
    ++found;
  }
  if (found > 1) draft->AddNote("the words of " + Count(found, "tier") + " were put together");
  if (found > 0) return Status();
  const auto other =
      std::find_if(tiers.begin(), tiers.end(), [](const Tier& tier) { return !HoldsPhones(tier); });
  if (other == tiers.end()) {
    return Status(Code::kBadInput, "has " + Count(tiers.size(), "interval tier") +
                                       ", none of words, expected a tier named 'words'");
  }
  draft->AddNote("no tier is named 'words'; tier '" + OneLine(other->name, 40) + "' was taken");
  AddTier(*other, draft);
  return Status();
}

}  // namespace gestus::words
