// Floats as 16-bit numbers, and sound and spectrograms as 8-bit ones: what a page carries.  A
// private header of models/player.
#ifndef GESTUS_MODELS_PLAYER_QUANTISE_H_
#define GESTUS_MODELS_PLAYER_QUANTISE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "models/player/show.h"

namespace gestus::player {

/// value = offset + scale * number
struct Quantised {
  double offset = 0, scale = 0;
  std::vector<std::int16_t> numbers;
};

/// Coordinates beyond this are drawn at it.
inline constexpr float kMaxCoordinate = 16000;

/// (rows, columns) in which what is not finite is the value before it in its column, else the first
/// that is finite, else 0.
std::vector<float> Finite(std::span<const float> values, std::size_t columns);

/// What to draw of a figure, (frames, 2 * points): finite, within +-kMaxCoordinate, and of a body
/// the neck at 0, to which all points are relative, whatever its own columns hold.
std::vector<float> DrawnValues(const outputs::Figure& figure, bool body);

/// Finite values, none further off than scale / 2.  With coordinates, scale is below 0.5.
Quantised Quantise(std::span<const float> values);

/// How loud a recording is: `rate` times a second, 255 being full scale.
struct Levels {
  static constexpr int kRate = 100;
  std::vector<std::uint8_t> peak;  ///< the largest sample
  std::vector<std::uint8_t> rms;   ///< root of the mean square
};
Levels LevelsOf(const Sound& sound);

/// A spectrogram as a picture, 0 the background and 255 the loudest.
struct Picture {
  double rate = 0;        ///< rows a second
  std::int64_t bins = 0;  ///< kMaxBins at most
  std::vector<std::uint8_t> values;
};
inline constexpr std::int64_t kMaxBins = 64;
inline constexpr std::int64_t kMaxPictureRows = 20000;
Picture PictureOf(const Spectrogram& spectrogram);

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_QUANTISE_H_
