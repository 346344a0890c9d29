// Stages of the audio front end: samples in, rows of features out, in pieces of any size.
//
//   LogMel stage = *LogMel::Make(PatsLogMel512(44100));
//   std::vector<float> rows(stage.MaxRows(kPiece) * 128);
//   while (piece of at most kPiece samples) {
//     const std::size_t n = stage.Push(piece, size, rows.data());   // n rows of 128
//   }
//   rows.resize(stage.MaxRowsAtFinish() * 128);
//   const std::size_t n = stage.Finish(rows.data());
#ifndef GESTUS_MODELS_AUDIO_STAGE_H_
#define GESTUS_MODELS_AUDIO_STAGE_H_

#include <cstddef>

namespace gestus::audio {

/// However the samples of a recording are cut into pieces, the rows have the same bytes.  All
/// memory is allocated when a stage is made.  Samples should be finite: one that is not spoils the
/// rows whose frames it lies in, and no others.
class Stage {
 public:
  virtual ~Stage() = default;

  /// Floats in a row.
  virtual int width() const = 0;
  /// No Push() of this many samples gives more rows, whatever came before.
  virtual std::size_t MaxRows(std::size_t samples) const = 0;
  /// Takes `n` samples and writes the rows that they complete, (MaxRows(n), width) at most; returns
  /// their number.
  virtual std::size_t Push(const float* samples, std::size_t n, float* rows) = 0;
  /// No Finish() gives more rows.
  virtual std::size_t MaxRowsAtFinish() const = 0;
  /// Writes the rows that waited for more samples and returns their number.  The stage then is as
  /// new: the next sample begins another recording.
  virtual std::size_t Finish(float* rows) = 0;

 protected:
  Stage() = default;
  Stage(const Stage&) = default;
  Stage& operator=(const Stage&) = default;
};

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_STAGE_H_
