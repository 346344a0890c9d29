// The fundamental frequency of a voice by SWIPE' (Camacho 2007, Camacho and Harris 2008): a
// sawtooth's spectrum is fitted to the square root of the magnitude spectrum, on an ERB scale and
// over the first and the prime harmonics.  Streaming: pieces of any size give the same bytes.
//
//   auto swipe = Swipe::Make({.sample_rate = 48000});
//   if (!swipe.ok()) return swipe.status();
//   std::vector<float> rows(swipe->MaxRows(n) * Swipe::kColumns);
//   rows.resize(swipe->Push(samples, n, rows.data()) * Swipe::kColumns);   // as often as one likes
//   ... and at the end swipe->Finish(), which needs room for MaxRowsAtFinish() rows
#ifndef GESTUS_MODELS_PROSODY_SWIPE_H_
#define GESTUS_MODELS_PROSODY_SWIPE_H_

#include <cstddef>
#include <memory>

#include "engine/status.h"

namespace gestus::prosody {

enum class SwipeMode {
  /// As published: a natural cubic spline over all bins, half the sample rate included, candidates
  /// near the ends of the range in full, and the highest one itself where it wins.
  kTextbook,
  /// The programs in use, to their digits: SPTK, pysptk, Gorman's swipe.  Between bins they
  /// interpolate almost linearly, and they give `min_hz` where the highest candidate wins.  They
  /// weigh candidates near the ends of the range down, by how much depends on the sample rate: the
  /// strength of a voice of 500 Hz at 44.1 kHz is half of what it should be.
  kSptk,
};

struct SwipeOptions {
  double sample_rate = 16000;  ///< Hz, 4,000 to 384,000
  double hop_seconds = 0.010;  ///< one sample to a minute
  double min_hz = 50;          ///< at least 10
  double max_hz = 550;         ///< above min_hz, at most 5,000 and a quarter of the sample rate
  double threshold = 0.3;      ///< voiced where the strength is above it; 0 to 1
  SwipeMode mode = SwipeMode::kTextbook;
};

/// One recording at a time, one thread at a time.  All memory is allocated by Make(), and how much
/// does not depend on how long the recording is.
///
/// Row j describes the time j * hop_seconds: f0 in Hz, 0 where unvoiced, and the strength of the
/// best candidate, at most 1 and 0 for what is below 1e-4.  A recording of N samples has
/// ceil(N / hop) rows.  A sample that is not finite silences the frames that hold it, no others.
class Swipe {
 public:
  static constexpr std::size_t kColumns = 2;

  static Result<Swipe> Make(const SwipeOptions& options);
  ~Swipe();
  Swipe(Swipe&&) noexcept;
  Swipe& operator=(Swipe&&) noexcept;

  const SwipeOptions& options() const;
  /// A row is given at the latest when this many samples behind its time have been pushed.
  std::size_t Latency() const;

  /// Rows that pushing `n` samples can give at most.
  std::size_t MaxRows(std::size_t n) const;
  /// Takes `n` samples, full scale 1, and returns how many rows it wrote to `rows` (.., kColumns).
  std::size_t Push(const float* samples, std::size_t n, float* rows);
  std::size_t MaxRowsAtFinish() const;
  /// Writes the rows still to come, and is ready for another recording.
  std::size_t Finish(float* rows);

 private:
  class Stream;
  explicit Swipe(std::unique_ptr<Stream> stream);

  std::unique_ptr<Stream> stream_;
};

}  // namespace gestus::prosody

#endif  // GESTUS_MODELS_PROSODY_SWIPE_H_
