// The samples of a RIFF/WAVE file, read in pieces.
#include "models/audio/wav.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace gestus::audio {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 16;

// One sample of each kind, full scale 1.
struct Unsigned8 {
  static constexpr std::size_t kBytes = 1;
  static float At(const std::uint8_t* p) { return static_cast<float>(p[0] - 128) * 0x1p-7f; }
};
struct Signed16 {
  static constexpr std::size_t kBytes = 2;
  static float At(const std::uint8_t* p) {
    return static_cast<float>(static_cast<std::int16_t>(p[0] | p[1] << 8)) * 0x1p-15f;
  }
};
struct Signed24 {
  static constexpr std::size_t kBytes = 3;
  static float At(const std::uint8_t* p) {
    const std::uint32_t bits =
        std::uint32_t{p[0]} << 8 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 24;
    return static_cast<float>(static_cast<std::int32_t>(bits)) * 0x1p-31f;
  }
};
struct Signed32 {
  static constexpr std::size_t kBytes = 4;
  static std::uint32_t Bits(const std::uint8_t* p) {
    return std::uint32_t{p[0]} | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16 |
           std::uint32_t{p[3]} << 24;
  }
  static float At(const std::uint8_t* p) {
    return static_cast<float>(static_cast<std::int32_t>(Bits(p))) * 0x1p-31f;
  }
};
struct Float32 {
  static constexpr std::size_t kBytes = 4;
  static float At(const std::uint8_t* p) { return std::bit_cast<float>(Signed32::Bits(p)); }
};
struct Float64 {
  static constexpr std::size_t kBytes = 8;
  static float At(const std::uint8_t* p) {
    const std::uint64_t bits = Signed32::Bits(p) | std::uint64_t{Signed32::Bits(p + 4)} << 32;
    return static_cast<float>(std::bit_cast<double>(bits));
  }
};

// The mean of the channels of `n` frames; returns how many samples were not finite.
template <class Sample>
std::uint64_t Mix(const std::uint8_t* bytes, std::size_t n, std::size_t channels, float* mono) {
  std::uint64_t not_finite = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t c = 0; c < channels; ++c, bytes += Sample::kBytes) {
      const float sample = Sample::At(bytes);
      if (std::isfinite(sample)) {
        sum += static_cast<double>(sample);
      } else {
        ++not_finite;
      }
    }
    mono[i] = static_cast<float>(sum / static_cast<double>(channels));
  }
  return not_finite;
}

using MixFunction = std::uint64_t (*)(const std::uint8_t*, std::size_t, std::size_t, float*);

MixFunction MixOf(WavSamples samples) {
  switch (samples) {
    case WavSamples::kUnsigned8:
      return Mix<Unsigned8>;
    case WavSamples::kSigned16:
      return Mix<Signed16>;
    case WavSamples::kSigned24:
      return Mix<Signed24>;
    case WavSamples::kSigned32:
      return Mix<Signed32>;
    case WavSamples::kFloat32:
      return Mix<Float32>;
    case WavSamples::kFloat64:
    case WavSamples::kForeign:
      break;
  }
  return Mix<Float64>;
}

class WavSource final : public AudioSource {
 public:
  WavSource(const std::string& path, InputFile file, const WavHeader& header,
            std::vector<std::string> notes)
      : path_(path), file_(std::move(file)), header_(header), mix_(MixOf(header.samples)) {
    sample_rate_ = header.sample_rate;
    channels_ = header.channels;
    frames_ = static_cast<std::int64_t>(header.data_bytes / header.frame_bytes);
    notes_ = std::move(notes);
    bytes_.resize(std::max(kPieceBytes / header.frame_bytes, std::size_t{1}) * header.frame_bytes);
  }

  Result<std::size_t> Read(float* mono, std::size_t n) override {
    std::size_t written = 0;
    while (written < n && done_ < header_.data_bytes) {
      const std::size_t frame = header_.frame_bytes;
      const std::uint64_t left = (header_.data_bytes - done_) / frame;
      const auto frames = static_cast<std::size_t>(
          std::min<std::uint64_t>(left, std::min(n - written, bytes_.size() / frame)));
      const Result<std::size_t> got =
          ReadAt(file_, header_.data_begin + done_, bytes_.data(), frames * frame);
      if (!got.ok()) return got.status().In(path_);
      const std::size_t whole = *got / frame;
      const std::uint64_t bad =
          mix_(bytes_.data(), whole, static_cast<std::size_t>(channels_), mono + written);
      if (bad > 0) NoteNotFinite(bad);
      written += whole;
      done_ += whole * frame;
      if (whole < frames) {
        notes_.push_back("data: the file became shorter while it was read");
        header_.data_bytes = done_;
      }
    }
    return written;
  }

 private:
  std::string path_;
  InputFile file_;
  WavHeader header_;
  MixFunction mix_;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t done_ = 0;  // bytes of samples read
};

}  // namespace

std::unique_ptr<AudioSource> OpenWav(const std::string& path, InputFile file,
                                     const WavHeader& header, std::vector<std::string> notes) {
  return std::make_unique<WavSource>(path, std::move(file), header, std::move(notes));
}

}  // namespace gestus::audio
