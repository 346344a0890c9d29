// Our own reader of RIFF/WAVE: PCM of 1 to 32 bits, float32 and float64, WAVE_FORMAT_EXTENSIBLE,
// any number of channels, RIFF and RF64/BW64 (EBU Tech 3306).  It trusts no size in the file.  A
// private header of the front end; OpenAudio() in source.h is for everybody.
#ifndef GESTUS_MODELS_AUDIO_WAV_H_
#define GESTUS_MODELS_AUDIO_WAV_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/audio/source.h"
#include "models/io/file.h"

namespace gestus::audio {

enum class WavSamples { kUnsigned8, kSigned16, kSigned24, kSigned32, kFloat32, kFloat64, kForeign };

struct WavHeader {
  WavSamples samples = WavSamples::kForeign;
  unsigned format = 0;  ///< the code that the file gives; kForeign when it is neither PCM nor float
  int sample_rate = 0;  ///< Hz, more than 0
  int channels = 0;     ///< 1 to 65535
  std::size_t frame_bytes = 0;
  std::uint64_t data_begin = 0, data_bytes = 0;  ///< within the file
};

/// Whether these are the first bytes of a file that ReadWavHeader() is for.
bool IsWav(const std::uint8_t* bytes, std::size_t n);

/// Finds the format and the samples.  Sizes that cannot be true are noted and read to the end of
/// the file.  Errors do not name the file.
Result<WavHeader> ReadWavHeader(const InputFile& file, std::vector<std::string>* notes);

/// The samples behind `header`, which must not be kForeign.  `path` is for errors.
std::unique_ptr<AudioSource> OpenWav(const std::string& path, InputFile file,
                                     const WavHeader& header, std::vector<std::string> notes);

/// Up to `n` bytes from `offset` on; fewer only where the file ends.
Result<std::size_t> ReadAt(const InputFile& file, std::uint64_t offset, void* bytes, std::size_t n);

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_WAV_H_
