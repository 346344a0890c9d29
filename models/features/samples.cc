#include "models/features/samples.h"

#include <algorithm>

#include "models/io/text.h"

namespace gestus::features {
namespace {

constexpr std::size_t kPiece = 8192;

}  // namespace

Result<Samples> Samples::Open(const std::string& path, int sample_rate) {
  Samples samples;
  samples.path_ = path;
  samples.sample_rate_ = sample_rate;
  Result<std::unique_ptr<audio::AudioSource>> source = audio::OpenAudio(path);
  if (!source.ok()) return source.status();
  samples.source_ = *std::move(source);
  samples.piece_.resize(kPiece);
  Result<audio::Resampler> resampler =
      audio::Resampler::Make(samples.source_->sample_rate(), sample_rate);
  if (!resampler.ok()) return resampler.status().In(path);
  samples.resampler_.emplace(*std::move(resampler));
  samples.resampled_.resize(
      std::max(samples.resampler_->MaxRows(kPiece), samples.resampler_->MaxRowsAtFinish()));
  return samples;
}

Result<std::span<const float>> Samples::Next() {
  std::size_t n = 0;
  while (n == 0 && !ended_) {
    const Result<std::size_t> read = source_->Read(piece_.data(), piece_.size());
    if (!read.ok()) return read.status();
    read_ += static_cast<std::int64_t>(*read);
    ended_ = *read == 0;
    n = ended_ ? resampler_->Finish(resampled_.data())
               : resampler_->Push(piece_.data(), *read, resampled_.data());
  }
  return std::span<const float>(resampled_.data(), n);
}

double Samples::seconds() const {
  const std::int64_t frames = ended_ ? read_ : source_->frames();
  return frames < 0 ? -1 : static_cast<double>(frames) / source_->sample_rate();
}

std::string Samples::Description() const {
  std::string text = seconds() < 0 ? "" : Significant(seconds(), 3) + " s, ";
  text += std::to_string(source_->sample_rate()) + " Hz";
  if (source_->channels() > 1)
    text += ", mean of " + std::to_string(source_->channels()) + " channels";
  if (source_->sample_rate() != sample_rate_)
    text += ", resampled to " + std::to_string(sample_rate_) + " Hz";
  return text;
}

Result<double> SecondsOf(const std::string& path) {
  Result<std::unique_ptr<audio::AudioSource>> source = audio::OpenAudio(path);
  if (!source.ok()) return source.status();
  std::int64_t frames = (*source)->frames();
  if (frames < 0) {
    std::vector<float> piece(kPiece);
    frames = 0;
    for (;;) {
      const Result<std::size_t> read = (*source)->Read(piece.data(), piece.size());
      if (!read.ok()) return read.status();
      if (*read == 0) break;
      frames += static_cast<std::int64_t>(*read);
    }
  }
  return static_cast<double>(frames) / (*source)->sample_rate();
}

}  // namespace gestus::features
