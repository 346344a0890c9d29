#include "models/audio/rows.h"

#include <utility>

#include "models/audio/resampler.h"

namespace gestus::audio {
namespace {

constexpr std::size_t kPiece = 16384;  // samples

// Rows that grow at their end.
class Rows {
 public:
  explicit Rows(Stage* stage) : stage_(stage), width_(static_cast<std::size_t>(stage->width())) {}

  void Push(const float* samples, std::size_t n) {
    Cut(stage_->Push(samples, n, Room(stage_->MaxRows(n))));
  }
  void Finish() { Cut(stage_->Finish(Room(stage_->MaxRowsAtFinish()))); }
  std::vector<float> Release() { return std::move(values_); }

 private:
  float* Room(std::size_t rows) {
    size_ = values_.size();
    values_.resize(size_ + rows * width_);
    return values_.data() + size_;
  }
  void Cut(std::size_t rows) { values_.resize(size_ + rows * width_); }

  Stage* stage_;
  std::size_t width_;
  std::vector<float> values_;
  std::size_t size_ = 0;  // of the values before the room
};

}  // namespace

std::vector<float> AllRows(Stage* stage, const float* samples, std::size_t n) {
  Rows rows(stage);
  rows.Push(samples, n);
  rows.Finish();
  return rows.Release();
}

Result<std::vector<float>> AllRows(Stage* stage, AudioSource* source, int rate) {
  Result<Resampler> made = Resampler::Make(source->sample_rate(), rate);
  if (!made.ok()) return made.status();
  Resampler& resampler = *made;
  std::vector<float> piece(kPiece), resampled(resampler.MaxRows(kPiece));
  Rows rows(stage);
  for (;;) {
    const Result<std::size_t> got = source->Read(piece.data(), piece.size());
    if (!got.ok()) return got.status();
    if (*got == 0) break;
    rows.Push(resampled.data(), resampler.Push(piece.data(), *got, resampled.data()));
  }
  resampled.resize(resampler.MaxRowsAtFinish());
  rows.Push(resampled.data(), resampler.Finish(resampled.data()));
  rows.Finish();
  return rows.Release();
}

}  // namespace gestus::audio
