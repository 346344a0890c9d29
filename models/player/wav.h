// Recordings as WAV files in memory.  A private header of models/player.
#ifndef GESTUS_MODELS_PLAYER_WAV_H_
#define GESTUS_MODELS_PLAYER_WAV_H_

#include <span>
#include <string>
#include <string_view>

namespace gestus::player {

/// A WAV file of 16-bit mono PCM; samples beyond full scale are clipped.
std::string MakeWav(std::span<const float> samples, int sample_rate);

/// Whether `file` is WAV that every browser plays: 16-bit PCM, one or two channels, 8 to 48 kHz,
/// all sizes true.
bool IsPlainWav(std::string_view file);

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_WAV_H_
