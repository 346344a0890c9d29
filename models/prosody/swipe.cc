// The stream: samples to blocks, blocks to strengths, strengths to pitch.
//
// A block is half the largest window: the next frame of that window, the next two of the one below,
// and so on.  With block i known, all rows between its time and that of block i - 1 can be given.
// Strengths of all candidates are computed in single precision by a matrix product, only to find
// out which can be the best; those few, and the neighbours of the best, are then computed in double
// precision, so that no digit of f0 depends on the machine's instruction set.
#include "models/prosody/swipe.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/aligned_buffer.h"
#include "engine/denormals.h"
#include "kernels/kernels.h"
#include "models/prosody/dot.h"
#include "models/prosody/loudness.h"
#include "models/prosody/range.h"
#include "models/prosody/swipe_tables.h"

namespace gestus::prosody {
namespace {

// Blocks in one matrix product at most; more than one only where a piece brings them.
constexpr std::size_t kMaxBlocks = 8;
// More than the error of a product of rows of norm 1 in single precision, and below any difference
// that matters.
constexpr float kNear = 1e-4f;

// One window's frames of the blocks at hand.  Row 0 is the last frame of the block before.
class WindowFrames {
 public:
  WindowFrames(const SwipeTables& tables, const SwipeWindow& window, std::size_t per_block,
               const SwipeOptions& options, const kernels::KernelTable& table)
      : window_(window),
        bands_(tables.bands.size()),
        per_block_(per_block),
        kernels_(tables.kernels.data() + window.first * bands_),
        table_(&table),
        loudness_(window.size, options.sample_rate, tables.bands, options.mode),
        weights_(window.weight.begin(), window.weight.end()),
        rows_((1 + kMaxBlocks * per_block) * bands_),
        rows32_(kMaxBlocks * per_block * bands_),
        strengths_((1 + kMaxBlocks * per_block) * weights_.size()) {
    const std::vector<float> kernels32(kernels_, kernels_ + weights_.size() * bands_);
    packed_ = AlignedBuffer(table.f32_gemm_packed_size(weights_.size(), bands_) * sizeof(float));
    if (complete())
      table.f32_gemm_pack(packed_.f32(), kernels32.data(), static_cast<std::ptrdiff_t>(bands_),
                          weights_.size(), bands_);
  }

  bool complete() const { return packed_.data() != nullptr; }

  // Takes the frames of `blocks` blocks, whose first sample is samples[0].
  void Take(const float* samples, std::size_t blocks) {
    const std::size_t frames = blocks * per_block_, count = weights_.size();
    std::copy_n(rows_.data() + last_ * bands_, bands_, rows_.data());
    std::copy_n(strengths_.data() + last_ * count, count, strengths_.data());
    last_ = frames;
    loudness_.Rows(samples, frames, rows_.data() + bands_);
    std::copy_n(rows_.data() + bands_, frames * bands_, rows32_.data());
    kernels::GemmArgs args;
    args.out = strengths_.data() + count;
    args.a = rows32_.data();
    args.out_stride = static_cast<std::ptrdiff_t>(count);
    args.a_stride = static_cast<std::ptrdiff_t>(bands_);
    args.packed = packed_.f32();
    args.m = frames;
    args.n = args.n_end = count;
    args.k = bands_;
    table_->f32_gemm(args);
  }

  // Sets the time that the functions below speak of: samples since the start of the recording, and
  // the number of the first block at hand.
  void MoveTo(double sample, std::int64_t block) {
    const double frame = sample / static_cast<double>(window_.size / 2);
    const double before = std::floor(frame);
    after_ = frame - before;
    row_ = static_cast<std::size_t>(static_cast<std::int64_t>(before) -
                                    (block - 1) * static_cast<std::int64_t>(per_block_));
  }

  // Adds this window's share to the strengths of all candidates.
  void AddStrengths(float* strengths) const {
    const float* now = strengths_.data() + row_ * weights_.size();
    const float* next = now + weights_.size();
    const auto after = static_cast<float>(after_);
    float* out = strengths + window_.first;
    for (std::size_t c = 0; c < weights_.size(); ++c)
      out[c] += weights_[c] * (now[c] + after * (next[c] - now[c]));
  }

  // This window's share of the strength of one candidate.
  double Strength(std::size_t candidate) const {
    if (candidate < window_.first || candidate >= window_.first + weights_.size()) return 0;
    const double* kernel = kernels_ + (candidate - window_.first) * bands_;
    const double* now = rows_.data() + row_ * bands_;
    const double here = Dot(kernel, now, bands_), there = Dot(kernel, now + bands_, bands_);
    return window_.weight[candidate - window_.first] * (here + after_ * (there - here));
  }

 private:
  SwipeWindow window_;
  std::size_t bands_, per_block_;
  const double* kernels_;  // (candidates of this window, bands)
  const kernels::KernelTable* table_;
  Loudness loudness_;
  std::vector<float> weights_;
  AlignedBuffer packed_;
  std::vector<double> rows_;
  std::vector<float> rows32_, strengths_;
  std::size_t last_ = 0, row_ = 0;
  double after_ = 0;
};

Status Check(const SwipeOptions& o) {
  if (!(o.sample_rate >= 4000 && o.sample_rate <= 384000))
    return OutOfRange("sample_rate", o.sample_rate, "4,000 to 384,000 Hz");
  if (!(o.hop_seconds * o.sample_rate >= 1 && o.hop_seconds <= 60))
    return OutOfRange("hop_seconds", o.hop_seconds, "one sample to 60 s");
  if (!(o.min_hz >= 10)) return OutOfRange("min_hz", o.min_hz, "at least 10 Hz");
  const double highest = std::min(5000.0, o.sample_rate / 4);
  if (!(o.max_hz <= highest))
    return OutOfRange(
        "max_hz", o.max_hz,
        "at most " + Plain(highest) + " Hz, the lesser of 5,000 and a quarter of the sample rate");
  // Fewer than three candidates have no parabola.
  if (!(o.max_hz >= o.min_hz * 1.05))
    return OutOfRange("max_hz", o.max_hz, "at least 5 % above min_hz, " + Plain(o.min_hz));
  if (!(o.threshold >= 0 && o.threshold <= 1))
    return OutOfRange("threshold", o.threshold, "0 to 1");
  return Status();
}

// The hop in samples; exactly whole where it is meant to be.
double HopSamples(const SwipeOptions& o) {
  const double hop = o.hop_seconds * o.sample_rate;
  return std::fabs(hop - std::round(hop)) < 1e-9 * hop ? std::round(hop) : hop;
}

}  // namespace

class Swipe::Stream {
 public:
  explicit Stream(const SwipeOptions& options)
      : options_(options), hop_(HopSamples(options)), tables_(MakeSwipeTables(options)) {
    const kernels::KernelTable& table = kernels::BestTable();
    block_ = tables_.windows.front().size / 2;
    windows_.reserve(tables_.windows.size());
    for (std::size_t k = 0; k < tables_.windows.size(); ++k)
      windows_.emplace_back(tables_, tables_.windows[k], std::size_t{1} << k, options, table);
    strengths_.resize(tables_.candidates.size());
    samples_.resize((kMaxBlocks + 1) * block_);
    Reset();
  }

  // False when memory was short.
  bool complete() const {
    return std::all_of(windows_.begin(), windows_.end(),
                       [](const WindowFrames& window) { return window.complete(); });
  }
  const SwipeOptions& options() const { return options_; }
  std::size_t latency() const { return 2 * block_; }
  std::size_t RowsWithin(double samples) const {
    return static_cast<std::size_t>(std::ceil(samples / hop_)) + 1;
  }

  std::size_t Push(const float* samples, std::size_t n, float* rows) {
    const FlushDenormals flush;
    received_ += static_cast<std::int64_t>(n);
    std::size_t written = 0;
    while (n > 0) {
      const std::size_t part = std::min(n, samples_.size() - filled_);
      std::copy_n(samples, part, samples_.data() + filled_);
      filled_ += part;
      samples += part;
      n -= part;
      const std::size_t ready = filled_ / block_ - 1;
      if (ready > 0) written += Take(ready, kNoLimit, rows + written * kColumns);
    }
    return written;
  }

  std::size_t Finish(float* rows) {
    const FlushDenormals flush;
    const auto total = static_cast<std::int64_t>(std::ceil(static_cast<double>(received_) / hop_));
    std::size_t written = 0;
    while (next_row_ < total) {
      std::fill(samples_.begin() + static_cast<std::ptrdiff_t>(filled_), samples_.end(), 0.0f);
      filled_ = 2 * block_;
      written += Take(1, total, rows + written * kColumns);
    }
    Reset();
    return written;
  }

 private:
  static constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();

  // Before the first sample lies a block of silence.
  void Reset() {
    std::fill_n(samples_.data(), block_, 0.0f);
    filled_ = block_;
    received_ = block_number_ = next_row_ = 0;
  }

  // Works off the first `blocks` blocks of the samples and writes the rows that follow, up to row
  // `limit`.
  std::size_t Take(std::size_t blocks, std::int64_t limit, float* rows) {
    for (WindowFrames& window : windows_) window.Take(samples_.data(), blocks);
    const auto known = static_cast<double>((block_number_ + static_cast<std::int64_t>(blocks) - 1) *
                                           static_cast<std::int64_t>(block_));
    std::size_t written = 0;
    for (; next_row_ < limit; ++next_row_, ++written) {
      const double sample = static_cast<double>(next_row_) * hop_;
      if (sample >= known) break;
      for (WindowFrames& window : windows_) window.MoveTo(sample, block_number_);
      Pick(rows + written * kColumns);
    }
    block_number_ += static_cast<std::int64_t>(blocks);
    const std::size_t used = blocks * block_;
    std::copy(samples_.begin() + static_cast<std::ptrdiff_t>(used),
              samples_.begin() + static_cast<std::ptrdiff_t>(filled_), samples_.begin());
    filled_ -= used;
    return written;
  }

  double Strength(std::size_t candidate) const {
    double sum = 0;
    for (const WindowFrames& window : windows_) sum += window.Strength(candidate);
    return sum;
  }

  // The best candidate at the time that the windows stand at.
  void Pick(float* row) {
    std::fill(strengths_.begin(), strengths_.end(), 0.0f);
    for (const WindowFrames& window : windows_) window.AddStrengths(strengths_.data());
    const float highest = *std::max_element(strengths_.begin(), strengths_.end());
    row[0] = row[1] = 0;
    if (!(highest > kNear)) return;
    std::size_t best = 0;
    double strength = 0;
    for (std::size_t c = 0; c < strengths_.size(); ++c) {
      if (strengths_[c] < highest - kNear) continue;
      const double exact = Strength(c);
      if (exact > strength) {
        best = c;
        strength = exact;
      }
    }
    row[1] = static_cast<float>(strength);
    if (!(strength > options_.threshold)) return;
    row[0] = static_cast<float>(PitchOf(best, strength));
  }

  double PitchOf(std::size_t best, double strength) const {
    const std::size_t last = strengths_.size() - 1;
    if (best == last && options_.mode == SwipeMode::kTextbook) return tables_.candidates[last];
    if (best == 0 || best == last) return tables_.candidates[0];
    const double around[3] = {Strength(best - 1), strength, Strength(best + 1)};
    return FinePitch(tables_, best, around);
  }

  const SwipeOptions options_;
  const double hop_;  // samples
  const SwipeTables tables_;
  std::size_t block_ = 0;  // samples
  std::vector<WindowFrames> windows_;
  std::vector<float> strengths_;  // of all candidates at one time
  std::vector<float> samples_;    // from the first of block `block_number_` - 1 on
  std::size_t filled_ = 0;
  std::int64_t received_ = 0, block_number_ = 0, next_row_ = 0;
};

Swipe::Swipe(std::unique_ptr<Stream> stream) : stream_(std::move(stream)) {}
Swipe::~Swipe() = default;
Swipe::Swipe(Swipe&&) noexcept = default;
Swipe& Swipe::operator=(Swipe&&) noexcept = default;

Result<Swipe> Swipe::Make(const SwipeOptions& options) {
  GESTUS_RETURN_IF_ERROR(Check(options));
  auto stream = std::make_unique<Stream>(options);
  if (!stream->complete()) return Status(Code::kResourceExhausted, "no memory for pitch kernels");
  return Swipe(std::move(stream));
}

const SwipeOptions& Swipe::options() const { return stream_->options(); }
std::size_t Swipe::Latency() const { return stream_->latency(); }

// What has been pushed but not worked off is less than a block, and Finish() has two blocks to go.
std::size_t Swipe::MaxRows(std::size_t n) const {
  return stream_->RowsWithin(static_cast<double>(n) + static_cast<double>(stream_->latency()) / 2);
}
std::size_t Swipe::Push(const float* samples, std::size_t n, float* rows) {
  return stream_->Push(samples, n, rows);
}
std::size_t Swipe::MaxRowsAtFinish() const {
  return stream_->RowsWithin(static_cast<double>(stream_->latency()));
}
std::size_t Swipe::Finish(float* rows) { return stream_->Finish(rows); }

}  // namespace gestus::prosody
