// The chunks of a RIFF/WAVE file up to its samples (Microsoft, Multiple Channel Audio Data and WAVE
// Files; EBU Tech 3306 for RF64).
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>

#include "models/audio/wav.h"
#include "models/io/text.h"

namespace gestus::audio {
namespace {

constexpr unsigned kPcm = 1, kFloat = 3, kExtensible = 0xFFFE;
constexpr std::uint32_t kUnknownSize = 0xFFFFFFFF;
constexpr std::size_t kMaxChunks = 10000;  // before the samples; honest files have a handful
constexpr std::size_t kChunkHeader = 8;
constexpr std::size_t kFmtBytes = 40;  // of WAVE_FORMAT_EXTENSIBLE, the longest form

Status Bad(const std::string& sentence) { return Status(Code::kBadInput, sentence); }

unsigned U16(const std::uint8_t* p) { return p[0] | unsigned{p[1]} << 8; }
std::uint32_t U32(const std::uint8_t* p) { return U16(p) | std::uint32_t{U16(p + 2)} << 16; }
std::uint64_t U64(const std::uint8_t* p) { return U32(p) | std::uint64_t{U32(p + 4)} << 32; }

bool Is(const std::uint8_t* p, const char* id) { return std::memcmp(p, id, 4) == 0; }

// Every subtype of EXTENSIBLE that carries an ordinary format code ends so.
constexpr std::uint8_t kGuidTail[14] = {0, 0, 0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71};

// The bytes of one sample: those that its bits need, or a wider container when block align and byte
// rate agree on it, as 24 bits in 4 bytes.  Samples fill their container from the top.
std::size_t SampleBytes(unsigned bits, unsigned channels, unsigned block, std::uint64_t rate,
                        std::uint64_t byte_rate, std::vector<std::string>* notes) {
  const std::size_t needed = (bits + 7) / 8;
  if (block == needed * channels) return needed;
  const std::size_t container = block / channels;
  if (block % channels == 0 && container > needed && container <= 4 && byte_rate == rate * block) {
    notes->push_back("fmt: samples of " + Count(bits, "bit") + " in " + Count(container, "byte") +
                     ", read from the top");
    return container;
  }
  notes->push_back("fmt: block align is " + std::to_string(block) + ", but " +
                   Count(channels, "channel") + " of " + Count(bits, "bit") + " make " +
                   std::to_string(needed * channels) + "; read by the bits");
  return needed;
}

Status ParseFmt(const std::uint8_t* p, std::size_t n, WavHeader* header,
                std::vector<std::string>* notes) {
  if (n < 16) return Bad("fmt: has " + Count(n, "byte") + ", expected at least 16");
  header->format = U16(p);
  const unsigned channels = U16(p + 2), block = U16(p + 12), bits = U16(p + 14);
  const std::uint32_t rate = U32(p + 4);
  if (channels == 0) return Bad("fmt: 0 channels, expected at least 1");
  if (rate == 0 || rate > static_cast<std::uint32_t>(std::numeric_limits<int>::max())) {
    return Bad("fmt: a sample rate of " + std::to_string(rate) + " Hz, expected " +
               (rate == 0 ? "more than 0" : "1 to 2147483647"));
  }
  header->channels = static_cast<int>(channels);
  header->sample_rate = static_cast<int>(rate);
  if (header->format == kExtensible) {
    if (n < kFmtBytes) {
      return Bad("fmt: has " + Count(n, "byte") + ", expected 40 for WAVE_FORMAT_EXTENSIBLE");
    }
    if (std::memcmp(p + 26, kGuidTail, sizeof kGuidTail) != 0) return Status();
    header->format = U16(p + 24);
  }
  if (header->format != kPcm && header->format != kFloat) return Status();
  const bool is_float = header->format == kFloat;
  if (is_float ? bits != 32 && bits != 64 : bits < 1 || bits > 32) {
    return Bad("fmt: samples of " + Count(bits, "bit") + ", expected " +
               (is_float ? "32 or 64 for float" : "1 to 32 for PCM"));
  }
  const std::size_t bytes =
      is_float ? bits / 8 : SampleBytes(bits, channels, block, rate, U32(p + 8), notes);
  constexpr WavSamples kIntegers[] = {WavSamples::kUnsigned8, WavSamples::kSigned16,
                                      WavSamples::kSigned24, WavSamples::kSigned32};
  header->samples = !is_float    ? kIntegers[bytes - 1]
                    : bytes == 4 ? WavSamples::kFloat32
                                 : WavSamples::kFloat64;
  header->frame_bytes = bytes * channels;
  return Status();
}

// Walks over the chunks of a file.
class Walk {
 public:
  Walk(const InputFile& file, std::vector<std::string>* notes) : file_(file), notes_(notes) {}

  Result<WavHeader> Run();

 private:
  Status ReadFmt(std::uint64_t begin, std::uint64_t size);
  Status ReadDs64(std::uint64_t begin, std::uint64_t size);
  Result<std::uint64_t> After(std::uint64_t begin, std::uint64_t size);
  void SetData(std::uint64_t begin, std::uint32_t said);

  const InputFile& file_;
  std::vector<std::string>* notes_;
  WavHeader header_;
  std::uint32_t riff_size_ = 0;
  bool have_fmt_ = false;
  std::optional<std::uint64_t> long_data_;  // the size of the samples that ds64 gives
};

Result<WavHeader> Walk::Run() {
  std::uint8_t head[12];
  Result<std::size_t> got = ReadAt(file_, 0, head, sizeof head);
  if (!got.ok()) return got.status();
  if (!IsWav(head, *got)) return Bad("does not begin as a WAV file");
  riff_size_ = U32(head + 4);
  std::uint64_t at = sizeof head;
  for (std::size_t chunk = 0; chunk < kMaxChunks; ++chunk) {
    got = ReadAt(file_, at, head, kChunkHeader);
    if (!got.ok()) return got.status();
    if (*got < kChunkHeader) {
      return Bad("ends at byte " + std::to_string(file_.size) + " without a data chunk" +
                 (have_fmt_ ? "" : ", and without a fmt chunk") + ", expected the samples there");
    }
    const std::uint64_t begin = at + kChunkHeader;
    const std::uint32_t size = U32(head + 4);
    if (Is(head, "data")) {
      if (!have_fmt_) return Bad("data: comes before any fmt chunk, which must say what it holds");
      SetData(begin, size);
      return header_;
    }
    if (Is(head, "fmt ")) GESTUS_RETURN_IF_ERROR(ReadFmt(begin, size));
    if (Is(head, "ds64")) GESTUS_RETURN_IF_ERROR(ReadDs64(begin, size));
    Result<std::uint64_t> after = After(begin, size);
    if (!after.ok()) return after.status();
    at = *after;
  }
  return Bad("has no data chunk among its first " + std::to_string(kMaxChunks) + " chunks");
}

Status Walk::ReadFmt(std::uint64_t begin, std::uint64_t size) {
  if (have_fmt_) {
    notes_->push_back("has a second fmt chunk, which was left out");
    return Status();
  }
  have_fmt_ = true;
  std::uint8_t bytes[kFmtBytes];
  const std::size_t want = static_cast<std::size_t>(std::min<std::uint64_t>(size, sizeof bytes));
  const Result<std::size_t> got = ReadAt(file_, begin, bytes, want);
  if (!got.ok()) return got.status();
  if (*got < want) {
    return Bad("fmt: the file ends after " + Count(*got, "byte") + " of it, expected " +
               std::to_string(size));
  }
  return ParseFmt(bytes, *got, &header_, notes_);
}

Status Walk::ReadDs64(std::uint64_t begin, std::uint64_t size) {
  std::uint8_t bytes[16];  // the sizes of the file and of the samples
  if (size < sizeof bytes) return Bad("ds64: has " + Count(size, "byte") + ", expected 28");
  const Result<std::size_t> got = ReadAt(file_, begin, bytes, sizeof bytes);
  if (!got.ok()) return got.status();
  if (*got == sizeof bytes) long_data_ = U64(bytes + 8);
  return Status();
}

// Where the chunk after this one begins.  A chunk of odd size is followed by a zero byte, which
// some writers forget.
Result<std::uint64_t> Walk::After(std::uint64_t begin, std::uint64_t size) {
  const std::uint64_t end = begin + size;
  if (size % 2 == 0) return end;
  std::uint8_t pad = 0;
  const Result<std::size_t> got = ReadAt(file_, end, &pad, 1);
  if (!got.ok()) return got.status();
  if (pad == 0) return end + 1;
  notes_->push_back("has a chunk of odd size at byte " + std::to_string(begin - kChunkHeader) +
                    " without the zero byte that belongs behind it");
  return end;
}

// Decides how many bytes of samples there are, whatever the file says.
void Walk::SetData(std::uint64_t begin, std::uint32_t said) {
  const std::uint64_t there = file_.size - std::min(begin, file_.size);
  const std::uint64_t size = said == kUnknownSize && long_data_ ? *long_data_ : said;
  header_.data_begin = begin;
  header_.data_bytes = size;
  // A pipe's writer could not come back to fill in the size; a writer of long files may have lost
  // its upper half.
  const bool never_set = size == 0 && riff_size_ != there + begin - kChunkHeader;
  const bool wrapped = there >= size && there - size > kUnknownSize;
  if (size != there && (never_set || wrapped || size > there)) {
    notes_->push_back("data: says " + Count(size, "byte") + ", but " + Grouped(there) +
                      " follow; read to the end of the file");
    header_.data_bytes = there;
  }
  if (header_.frame_bytes == 0) return;  // of a foreign format
  if (const std::uint64_t rest = header_.data_bytes % header_.frame_bytes; rest != 0) {
    notes_->push_back("data: " + Count(rest, "byte") +
                      " left out at the end, less than a frame of " +
                      Count(header_.frame_bytes, "byte"));
    header_.data_bytes -= rest;
  }
  if (header_.data_bytes == 0) notes_->push_back("data: holds no samples");
}

}  // namespace

bool IsWav(const std::uint8_t* bytes, std::size_t n) {
  return n >= 12 && (Is(bytes, "RIFF") || Is(bytes, "RF64") || Is(bytes, "BW64")) &&
         Is(bytes + 8, "WAVE");
}

Result<std::size_t> ReadAt(const InputFile& file, std::uint64_t offset, void* bytes,
                           std::size_t n) {
  std::size_t have = 0;
  // Beyond the size lies nothing, and an offset that a file made up may not even fit off_t.
  while (have < n && offset + have < file.size) {
    const ssize_t got = ::pread(file.fd.get(), static_cast<char*>(bytes) + have, n - have,
                                static_cast<off_t>(offset + have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      return Status(Code::kIo, std::string("cannot be read (") + std::strerror(errno) + ")");
    }
    if (got == 0) break;  // it has become shorter
    have += static_cast<std::size_t>(got);
  }
  return have;
}

Result<WavHeader> ReadWavHeader(const InputFile& file, std::vector<std::string>* notes) {
  return Walk(file, notes).Run();
}

}  // namespace gestus::audio
