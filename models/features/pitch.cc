#include "models/features/pitch.h"

#include <algorithm>

#include "models/features/samples.h"

namespace gestus::features {

prosody::SwipeOptions SwipeOptionsOf(const FeatureSpec& spec) {
  prosody::SwipeOptions options;
  options.sample_rate = spec.pitch_sample_rate;
  options.hop_seconds = spec.pitch_hop;
  options.min_hz = spec.pitch_minimum;
  options.max_hz = spec.pitch_maximum;
  options.threshold = spec.pitch_threshold;
  options.mode =
      spec.pitch == PitchReading::kSptk ? prosody::SwipeMode::kSptk : prosody::SwipeMode::kTextbook;
  return options;
}

Result<Pitch> ReadPitch(const std::string& path, const FeatureSpec& spec) {
  Result<Samples> samples = Samples::Open(path, spec.pitch_sample_rate);
  if (!samples.ok()) return samples.status();
  Result<prosody::Swipe> swipe = prosody::Swipe::Make(SwipeOptionsOf(spec));
  if (!swipe.ok()) return swipe.status().In(path);
  Pitch pitch;
  std::vector<float> rows;
  for (bool ended = false; !ended;) {
    const Result<std::span<const float>> piece = samples->Next();
    if (!piece.ok()) return piece.status();
    ended = piece->empty();
    rows.resize((ended ? swipe->MaxRowsAtFinish() : swipe->MaxRows(piece->size())) *
                prosody::Swipe::kColumns);
    const std::size_t n =
        ended ? swipe->Finish(rows.data()) : swipe->Push(piece->data(), piece->size(), rows.data());
    for (std::size_t i = 0; i < n; ++i) {
      pitch.f0.push_back(rows[i * prosody::Swipe::kColumns]);
      pitch.strength.push_back(rows[i * prosody::Swipe::kColumns + 1]);
    }
  }
  pitch.seconds = std::max(0.0, samples->seconds());
  if (pitch.seconds <= 0)
    return Status(Code::kBadInput, path + ": has no samples, expected recorded speech");
  pitch.description = samples->Description();
  pitch.notes = samples->notes();
  return pitch;
}

}  // namespace gestus::features
