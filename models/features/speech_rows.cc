#include "models/features/speech_rows.h"

#include <algorithm>
#include <cmath>

#include "models/audio/fbank.h"
#include "models/audio/log_mel.h"

namespace gestus::features {
namespace {

// A frame and a hop of the filter bank, in samples of 16 kHz.
constexpr std::int64_t kBankFrame = 400, kBankHop = 160;
// Of a frame: rates such as 29.97 are whole numbers of frames in 1000 seconds.
constexpr int kParts = 1000;

template <class T>
Result<std::unique_ptr<audio::Stage>> Own(Result<T> stage) {
  if (!stage.ok()) return stage.status();
  return std::unique_ptr<audio::Stage>(std::make_unique<T>(*std::move(stage)));
}

}  // namespace

Result<SpeechRows> SpeechRows::Open(const std::string& path, const FeatureSpec& spec) {
  Result<double> seconds = SecondsOf(path);
  if (!seconds.ok()) return seconds.status();
  if (*seconds <= 0)
    return Status(Code::kBadInput, path + ": has no samples, expected recorded speech");
  Result<Samples> samples = Samples::Open(path, spec.sample_rate);
  if (!samples.ok()) return samples.status();
  SpeechRows rows(*std::move(samples), spec);
  GESTUS_RETURN_IF_ERROR(rows.MakeStage().In(path));
  rows.CountRows(*seconds);
  return rows;
}

Status SpeechRows::MakeStage() {
  const bool bank = spec_.speech == SpeechFeature::kFilterBank;
  audio::FbankOptions bank_options;
  bank_options.bins = static_cast<int>(spec_.mel_bins);
  audio::LogMelOptions mel_options = audio::PatsLogMel512(spec_.sample_rate);
  mel_options.mels = static_cast<int>(spec_.mel_bins);
  Result<std::unique_ptr<audio::Stage>> stage =
      bank ? Own(audio::Fbank::Make(bank_options)) : Own(audio::LogMel::Make(mel_options));
  if (!stage.ok()) return stage.status();
  stage_ = *std::move(stage);
  exact_.placement = audio::RowPlacement::kExact;
  exact_.times.sample_rate = spec_.sample_rate;
  if (bank) {
    exact_.times.hop = kBankHop;
    exact_.times.first_middle = kBankFrame / 2;
  }
  pats_ = exact_;
  exact_.frames_per_second = static_cast<int>(std::lround(spec_.frame_rate * kParts));
  pats_.frames_per_second = std::max(1, static_cast<int>(std::lround(spec_.frame_rate)));
  pats_.placement = audio::RowPlacement::kPats;
  pats_.segments.frames = static_cast<int>(spec_.style_frames);
  // PATS' rows run ahead of time within a segment, and the next segment begins at its own time.
  if (spec_.rows == RowPlacement::kPats) {
    const std::int64_t ahead =
        audio::RowOfFrame(pats_, spec_.style_frames - 1) - ExactRow(spec_.style_frames);
    kept_ = std::max<std::int64_t>(0, ahead) + 2;
  }
  return Status();
}

void SpeechRows::CountRows(double seconds) {
  if (!spec_.every_row) {
    total_ = std::max<std::int64_t>(1, std::llround(std::floor(seconds * spec_.frame_rate + 1e-6)));
    return;
  }
  const auto samples = static_cast<std::int64_t>(std::ceil(seconds * spec_.sample_rate - 1e-6));
  const std::int64_t rows = samples < kBankFrame ? 0 : 1 + (samples - kBankFrame) / kBankHop;
  total_ = std::max(rows, spec_.frames);
}

// Reads on until `row` is there or the recording has ended.
Status SpeechRows::Fill(std::int64_t row) {
  const auto width = static_cast<std::size_t>(stage_->width());
  const auto end = [&] {
    return first_pending_ + static_cast<std::int64_t>(pending_.size() / width);
  };
  while (!ended_ && end() <= row) {
    const Result<std::span<const float>> piece = samples_.Next();
    if (!piece.ok()) return piece.status();
    ended_ = piece->empty();
    made_.resize((ended_ ? stage_->MaxRowsAtFinish() : stage_->MaxRows(piece->size())) * width);
    const std::size_t n = ended_ ? stage_->Finish(made_.data())
                                 : stage_->Push(piece->data(), piece->size(), made_.data());
    // Rows before the wanted one are of no use any more, but for the last: it may have to be
    // repeated.
    const auto held = static_cast<std::int64_t>(pending_.size() / width);
    const std::int64_t drop = std::min(row - first_pending_, held) - kept_;
    if (drop > 0) {
      pending_.erase(pending_.begin(), pending_.begin() + drop * static_cast<std::int64_t>(width));
      first_pending_ += drop;
    }
    pending_.insert(pending_.end(), made_.begin(),
                    made_.begin() + static_cast<std::ptrdiff_t>(n * width));
  }
  return Status();
}

std::int64_t SpeechRows::ExactRow(std::int64_t frame) const {
  return audio::RowOfFrame(exact_, frame * kParts);
}

std::int64_t SpeechRows::RowOf(std::int64_t frame) const {
  if (spec_.every_row) return frame;
  if (spec_.rows == RowPlacement::kExact || spec_.speech == SpeechFeature::kFilterBank)
    return ExactRow(frame);
  const std::int64_t in_segment = frame % spec_.style_frames;
  return ExactRow(frame - in_segment) + audio::RowOfFrame(pats_, in_segment);
}

Status SpeechRows::Read(std::int64_t count, std::vector<float>* rows) {
  const auto width = static_cast<std::size_t>(stage_->width());
  for (std::int64_t i = 0; i < count && next_ < total_; ++i, ++next_) {
    const std::int64_t row = RowOf(next_);
    GESTUS_RETURN_IF_ERROR(Fill(row));
    const auto held = static_cast<std::int64_t>(pending_.size() / width);
    const bool missing = row >= first_pending_ + held;
    if (held == 0 || (spec_.every_row && missing)) {
      rows->insert(rows->end(), width, 0.0f);
      continue;
    }
    const std::int64_t at = std::clamp<std::int64_t>(row - first_pending_, 0, held - 1);
    const auto from = pending_.begin() + at * static_cast<std::int64_t>(width);
    rows->insert(rows->end(), from, from + static_cast<std::ptrdiff_t>(width));
  }
  return Status();
}

}  // namespace gestus::features
