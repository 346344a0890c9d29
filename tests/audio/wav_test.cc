// Our WAV reader on files that are as they should be, that lie, and that are damaged.
#include "models/audio/wav.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "models/audio/source.h"
#include "models/io/text.h"
#include "tests/audio/wav_builder.h"
#include "tests/engine/temp_file.h"

namespace gestus::audio {
namespace {

struct Sound {
  std::string error;  // less the path
  int rate = 0, channels = 0;
  std::int64_t frames = 0;
  std::vector<float> mono;
  std::vector<std::string> notes;
};

// Opens and reads a file, `piece` samples at a time.
Sound ReadPath(const std::string& path, std::size_t piece = 1000) {
  Sound sound;
  auto source = OpenAudio(path);
  if (!source.ok()) {
    sound.error = source.status().message();
    EXPECT_EQ(sound.error.substr(0, path.size() + 2), path + ": ");
    sound.error.erase(0, path.size() + 2);
    EXPECT_FALSE(sound.error.empty());
    return sound;
  }
  AudioSource& s = **source;
  sound.rate = s.sample_rate(), sound.channels = s.channels(), sound.frames = s.frames();
  EXPECT_GT(sound.rate, 0);
  EXPECT_GT(sound.channels, 0);
  std::vector<float> part(piece);
  for (;;) {
    const Result<std::size_t> got = s.Read(part.data(), piece);
    EXPECT_TRUE(got.ok());
    if (!got.ok() || *got == 0) break;
    EXPECT_LE(*got, piece);
    sound.mono.insert(sound.mono.end(), part.begin(),
                      part.begin() + static_cast<std::ptrdiff_t>(*got));
  }
  for (const float sample : sound.mono) EXPECT_TRUE(std::isfinite(sample));
  EXPECT_EQ(sound.frames, std::ssize(sound.mono));
  sound.notes = s.notes();
  return sound;
}

Sound Read(const ByteVector& bytes, std::size_t piece = 1000) {
  const test::TempFile file(bytes);
  return ReadPath(file.path(), piece);
}

std::string Notes(const Sound& sound) {
  std::string all;
  for (const std::string& note : sound.notes) all += note + "|";
  return all;
}

// Samples -4/8 .. 3/8 in a format.
const std::vector<float> kRamp = {-0.5f, -0.375f, -0.25f, -0.125f, 0, 0.125f, 0.25f, 0.375f};

ByteVector Ramp(std::uint16_t format, int bits) {
  const int bytes = (bits + 7) / 8;
  ByteVector data;
  for (const float sample : kRamp) {
    if (format == 3 && bits == 32) {
      Put(&data, std::bit_cast<std::uint32_t>(sample), 4);
    } else if (format == 3) {
      Put(&data, std::bit_cast<std::uint64_t>(static_cast<double>(sample)), 8);
    } else {
      const auto value = static_cast<std::int64_t>(std::ldexp(sample, 8 * bytes - 1));
      Put(&data, static_cast<std::uint64_t>(bytes == 1 ? value + 128 : value), bytes);
    }
  }
  return data;
}

struct Format {
  std::uint16_t format, bits;
};
constexpr Format kFormats[] = {{1, 8},  {1, 16}, {1, 24}, {1, 32}, {3, 32},
                               {3, 64}, {1, 4},  {1, 12}, {1, 20}};

TEST(WavTest, ReadsEveryFormat) {
  for (const Format& f : kFormats) {
    for (const bool extensible : {false, true}) {
      for (const std::size_t piece : {1u, 3u, 1000u}) {
        const Sound sound = Read(Wav({.format = f.format, .bits = f.bits, .extensible = extensible},
                                     Ramp(f.format, f.bits)),
                                 piece);
        EXPECT_EQ(sound.error, "");
        EXPECT_EQ(sound.mono, kRamp) << f.format << ", " << f.bits;
        EXPECT_EQ(sound.rate, 16000);
        EXPECT_EQ(sound.frames, 8);
        EXPECT_EQ(Notes(sound), "");
      }
    }
  }
}

TEST(WavTest, ReadsTheEndsOfEveryRange) {
  ByteVector bytes8 = {0, 255}, bytes16, bytes24, bytes32;
  Put(&bytes16, 0x8000, 2), Put(&bytes16, 0x7FFF, 2);
  Put(&bytes24, 0x800000, 3), Put(&bytes24, 0x7FFFFF, 3);
  Put(&bytes32, 0x80000000, 4), Put(&bytes32, 0x7FFFFFFF, 4);
  const auto ends = [](std::uint16_t bits, const ByteVector& data) {
    return Read(Wav({.bits = bits}, data)).mono;
  };
  EXPECT_EQ(ends(8, bytes8), (std::vector<float>{-1, 127 / 128.0f}));
  EXPECT_EQ(ends(16, bytes16), (std::vector<float>{-1, 32767 / 32768.0f}));
  EXPECT_EQ(ends(24, bytes24), (std::vector<float>{-1, 8388607 / 8388608.0f}));
  EXPECT_EQ(ends(32, bytes32), (std::vector<float>{-1, 1}));
}

TEST(WavTest, MixesChannels) {
  constexpr std::uint16_t kChannels[] = {1, 2, 3, 6, 255, 65535};
  for (const std::uint16_t channels : kChannels) {
    ByteVector data;
    std::vector<float> want;
    for (int frame = 0; frame < 3; ++frame) {
      double sum = 0;
      for (int c = 0; c < channels; ++c) {
        const auto value = static_cast<std::int16_t>((frame + 1) * (c % 97) * 100);
        Put(&data, static_cast<std::uint16_t>(value), 2);
        sum += value / 32768.0;
      }
      want.push_back(static_cast<float>(sum / channels));
    }
    const auto block = static_cast<std::uint16_t>(2 * channels);  // wraps for the largest number
    const Sound sound = Read(Wav({.channels = channels, .rate = 96000, .block = block}, data));
    EXPECT_EQ(sound.error, "");
    EXPECT_EQ(sound.channels, channels);
    EXPECT_EQ(sound.mono, want) << channels;
    EXPECT_EQ(sound.frames, 3);
  }
}

TEST(WavTest, StepsOverOtherChunks) {
  ByteVector odd, even;
  PutChunk(&odd, "LIST", {1, 2, 3});
  PutChunk(&odd, "JUNK", {});
  PutChunk(&even, "bext", ByteVector(600));
  const ByteVector data = Ramp(1, 16);
  const Sound sound = Read(Wav({.before_fmt = odd, .before_data = even, .after_data = odd}, data));
  EXPECT_EQ(sound.error, "");
  EXPECT_EQ(sound.mono, kRamp);
  EXPECT_EQ(Notes(sound), "");
  // An odd number of samples of 8 bits, with its pad byte and a chunk behind it.
  const Sound eight = Read(Wav({.bits = 8, .after_data = odd}, {128, 192, 64}));
  EXPECT_EQ(eight.mono, (std::vector<float>{0, 0.5f, -0.5f}));
  EXPECT_EQ(Notes(eight), "");
}

TEST(WavTest, ForgivesAMissingPadByte) {
  ByteVector chunk;
  PutChunk(&chunk, "LIST", {1, 2, 3});
  chunk.pop_back();
  const Sound sound = Read(Wav({.before_fmt = chunk}, Ramp(1, 16)));
  EXPECT_EQ(sound.mono, kRamp);
  EXPECT_EQ(Notes(sound),
            "has a chunk of odd size at byte 12 without the zero byte that belongs behind it|");
}

TEST(WavTest, ReadsLongForms) {
  for (const char* form : {"RF64", "BW64"}) {
    ByteVector sizes, ds64;
    Put(&sizes, 1000, 8), Put(&sizes, 16, 8), Put(&sizes, 8, 8), Put(&sizes, 0, 4);
    PutChunk(&ds64, "ds64", sizes);
    ByteVector after;
    PutChunk(&after, "LIST", {1, 2});
    const Sound sound = Read(Wav({.form = form,
                                  .riff_size = 0xFFFFFFFF,
                                  .data_size = 0xFFFFFFFF,
                                  .before_fmt = ds64,
                                  .after_data = after},
                                 Ramp(1, 16)));
    EXPECT_EQ(sound.mono, kRamp) << form;
    EXPECT_EQ(Notes(sound), "");
  }
}

TEST(WavTest, DoesNotBelieveSizes) {
  const ByteVector data = Ramp(1, 16);
  for (const std::uint32_t said : {0u, 17u, 1000u, 0x7FFFFFFFu, 0xFFFFFFFEu, 0xFFFFFFFFu}) {
    const Sound sound =
        Read(Wav({.riff_size = said == 0 ? 0 : 0xFFFFFFFF, .data_size = said}, data));
    EXPECT_EQ(sound.mono, kRamp) << said;
    EXPECT_EQ(sound.frames, 8);
    EXPECT_EQ(Notes(sound), "data: says " + Grouped(said) +
                                " bytes, but 16 follow; read to the end of the file|");
  }
  // A long form whose size is missing, and one that says more than there is.
  EXPECT_EQ(Read(Wav({.form = "RF64", .data_size = 0xFFFFFFFF}, data)).mono, kRamp);
  ByteVector sizes, ds64;
  Put(&sizes, ~std::uint64_t{0}, 8), Put(&sizes, ~std::uint64_t{0}, 8), Put(&sizes, 0, 8),
      Put(&sizes, 0, 4);
  PutChunk(&ds64, "ds64", sizes);
  const Sound sound =
      Read(Wav({.form = "RF64", .data_size = 0xFFFFFFFF, .before_fmt = ds64}, data));
  EXPECT_EQ(sound.mono, kRamp);
  EXPECT_EQ(
      Notes(sound),
      "data: says 18,446,744,073,709,551,615 bytes, but 16 follow; read to the end of the file|");
}

TEST(WavTest, BelievesAnEmptyRecording) {
  ByteVector after;
  PutChunk(&after, "LIST", {1, 2, 3, 4});
  const Sound sound = Read(Wav({.after_data = after}, {}));
  EXPECT_EQ(sound.error, "");
  EXPECT_EQ(sound.mono.size(), 0u);
  EXPECT_EQ(sound.frames, 0);
  EXPECT_EQ(Notes(sound), "data: holds no samples|");
  EXPECT_EQ(Notes(Read(Wav({}, {}))), "data: holds no samples|");
}

TEST(WavTest, LeavesOutAPartialFrame) {
  ByteVector data = Ramp(1, 16);
  data.push_back(7);
  const Sound sound = Read(Wav({}, data));
  EXPECT_EQ(sound.mono, kRamp);
  EXPECT_EQ(Notes(sound), "data: 1 byte left out at the end, less than a frame of 2 bytes|");
}

TEST(WavTest, WeighsBlockAlign) {
  // 24 bits in 4 bytes, which byte rate confirms.
  const Sound wide = Read(Wav({.bits = 24, .block = 4}, Ramp(1, 32)));
  EXPECT_EQ(wide.mono, kRamp);
  EXPECT_EQ(Notes(wide), "fmt: samples of 24 bits in 4 bytes, read from the top|");
  // Block aligns that nothing confirms.
  constexpr std::uint16_t kBlocks[] = {0, 1, 3, 4, 7, 65535};
  for (const std::uint16_t block : kBlocks) {
    const Sound sound = Read(Wav({.byte_rate = 32000, .block = block}, Ramp(1, 16)));
    EXPECT_EQ(sound.mono, kRamp) << block;
    EXPECT_EQ(Notes(sound), "fmt: block align is " + std::to_string(block) +
                                ", but 1 channel of 16 bits make 2; read by the bits|");
  }
}

TEST(WavTest, CountsSamplesThatAreNoNumbers) {
  ByteVector data;
  const float inf = std::numeric_limits<float>::infinity();
  for (const float v : {0.5f, std::nanf(""), inf, -inf, 0.25f, 0.25f}) {
    Put(&data, std::bit_cast<std::uint32_t>(v), 4);
  }
  for (const std::size_t piece : {1u, 100u}) {
    const Sound mono = Read(Wav({.format = 3, .bits = 32}, data), piece);
    EXPECT_EQ(mono.mono, (std::vector<float>{0.5f, 0, 0, 0, 0.25f, 0.25f}));
    EXPECT_EQ(Notes(mono), "3 samples are not finite numbers, taken as 0|");
    const Sound stereo = Read(Wav({.format = 3, .channels = 2, .bits = 32}, data), piece);
    EXPECT_EQ(stereo.mono, (std::vector<float>{0.25f, 0, 0.25f}));
    EXPECT_EQ(Notes(stereo), "3 samples are not finite numbers, taken as 0|");
  }
  ByteVector large;
  Put(&large, std::bit_cast<std::uint64_t>(1e300), 8);
  const Sound sound = Read(Wav({.format = 3, .bits = 64}, large));
  EXPECT_EQ(sound.mono, (std::vector<float>{0}));
  EXPECT_EQ(Notes(sound), "1 sample is not a finite number, taken as 0|");
}

TEST(WavTest, SaysWhatIsWrong) {
  const ByteVector data = Ramp(1, 16);
  const auto error = [&](const WavSpec& spec) { return Read(Wav(spec, data)).error; };
  EXPECT_EQ(Read({}).error, "is empty, expected a sound file");
  EXPECT_EQ(error({.channels = 0}), "fmt: 0 channels, expected at least 1");
  EXPECT_EQ(error({.rate = 0}), "fmt: a sample rate of 0 Hz, expected more than 0");
  EXPECT_EQ(error({.rate = 0x80000000}),
            "fmt: a sample rate of 2147483648 Hz, expected 1 to 2147483647");
  EXPECT_EQ(error({.bits = 0}), "fmt: samples of 0 bits, expected 1 to 32 for PCM");
  EXPECT_EQ(error({.bits = 33}), "fmt: samples of 33 bits, expected 1 to 32 for PCM");
  EXPECT_EQ(error({.format = 3, .bits = 16}),
            "fmt: samples of 16 bits, expected 32 or 64 for float");
  ByteVector early = {};
  PutChunk(&early, "data", data);
  EXPECT_EQ(error({.before_fmt = early}),
            "data: comes before any fmt chunk, which must say what it holds");
  ByteVector header = Wav({}, data);
  header.resize(44);
  EXPECT_EQ(
      Notes(Read(header)),
      "data: says 16 bytes, but 0 follow; read to the end of the file|data: holds no samples|");
  header.resize(12);
  EXPECT_EQ(Read(header).error,
            "ends at byte 12 without a data chunk, and without a fmt chunk, expected the samples "
            "there");
  header = Wav({}, data);
  header.resize(36);
  EXPECT_EQ(Read(header).error, "ends at byte 36 without a data chunk, expected the samples there");
  header.resize(30);
  EXPECT_EQ(Read(header).error, "fmt: the file ends after 10 bytes of it, expected 16");
  header[16] = 10;  // the size of the fmt chunk
  EXPECT_EQ(Read(header).error, "fmt: has 10 bytes, expected at least 16");
  ByteVector extensible = Wav({.extensible = true}, data);
  extensible[16] = 18;
  EXPECT_EQ(Read(extensible).error, "fmt: has 18 bytes, expected 40 for WAVE_FORMAT_EXTENSIBLE");
  ByteVector chunks;
  for (int i = 0; i < 10000; ++i) PutChunk(&chunks, "JUNK", {});
  EXPECT_EQ(error({.before_data = chunks}), "has no data chunk among its first 10000 chunks");
}

TEST(WavTest, KeepsTheFirstOfTwoFormats) {
  ByteVector second;
  PutChunk(&second, "fmt ", Fmt({.format = 3, .channels = 7, .bits = 64}));
  const Sound sound = Read(Wav({.before_data = second}, Ramp(1, 16)));
  EXPECT_EQ(sound.mono, kRamp);
  EXPECT_EQ(Notes(sound), "has a second fmt chunk, which was left out|");
}

TEST(WavTest, RefusesWhatIsNoFile) {
  const std::string folder = testing::TempDir() + "gestus_wav_" + std::to_string(::getpid());
  ASSERT_EQ(::mkdir(folder.c_str(), 0700), 0);
  const std::string pipe = folder + "/pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(ReadPath(folder).error, "is a directory, expected a file");
  EXPECT_EQ(ReadPath(pipe).error, "is a pipe or device, expected a file");
  EXPECT_EQ(ReadPath("/dev/zero").error, "is a pipe or device, expected a file");
  EXPECT_EQ(ReadPath(folder + "/none").error,
            "cannot be opened (No such file or directory), expected a readable file");
  ::unlink(pipe.c_str());
  ::rmdir(folder.c_str());
}

TEST(WavTest, StopsWhereTheFileWasCutWhileReading) {
  const test::TempFile file(Wav({.bits = 8}, ByteVector(200000, 192)));
  auto source = OpenAudio(file.path());
  ASSERT_TRUE(source.ok());
  std::vector<float> samples(200001);
  ASSERT_EQ(*(*source)->Read(samples.data(), 70000), 70000u);
  ASSERT_EQ(::truncate(file.path().c_str(), 100044), 0);
  EXPECT_EQ(*(*source)->Read(samples.data(), samples.size()), 30000u);
  EXPECT_EQ(*(*source)->Read(samples.data(), samples.size()), 0u);
  ASSERT_EQ((*source)->notes().size(), 1u);
  EXPECT_EQ((*source)->notes()[0], "data: the file became shorter while it was read");
}

// Small files of every shape, to be damaged.
std::vector<ByteVector> Victims() {
  std::vector<ByteVector> files;
  ByteVector odd, ds64, sizes;
  PutChunk(&odd, "LIST", {1, 2, 3});
  Put(&sizes, 1000, 8), Put(&sizes, 16, 8), Put(&sizes, 8, 8), Put(&sizes, 0, 4);
  PutChunk(&ds64, "ds64", sizes);
  for (const Format& f : kFormats) {
    files.push_back(Wav({.format = f.format,
                         .bits = f.bits,
                         .extensible = f.bits % 16 == 0,
                         .before_fmt = odd,
                         .after_data = odd},
                        Ramp(f.format, f.bits)));
  }
  files.push_back(Wav({.channels = 2, .form = "RF64", .data_size = 0xFFFFFFFF, .before_fmt = ds64},
                      Ramp(1, 16)));
  return files;
}

TEST(WavTest, TakesEveryTruncation) {
  int read = 0;
  for (const ByteVector& whole : Victims()) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const Sound sound = Read(ByteVector(whole.begin(), whole.begin() + static_cast<long>(size)));
      ASSERT_LE(sound.mono.size(), kRamp.size());
      read += sound.error.empty() ? 1 : 0;
    }
  }
  EXPECT_GT(read, 100);
}

// Reads what OpenAudio would give to our own reader, damaged or not, and nothing else.
bool ReadDamaged(const ByteVector& bytes) {
  const test::TempFile file(bytes);
  Result<InputFile> input = OpenInput(file.path());
  EXPECT_TRUE(input.ok());
  std::vector<std::string> notes;
  const Result<WavHeader> header = ReadWavHeader(*input, &notes);
  if (!header.ok()) {
    EXPECT_FALSE(header.status().message().empty());
    return false;
  }
  if (header->samples == WavSamples::kForeign) return false;
  EXPECT_LE(header->data_begin + header->data_bytes, bytes.size());
  const auto source = OpenWav("a", *std::move(input), *header, std::move(notes));
  float samples[7];
  std::int64_t frames = 0;
  for (;;) {
    const Result<std::size_t> got = source->Read(samples, 7);
    EXPECT_TRUE(got.ok());
    if (!got.ok() || *got == 0) break;
    for (std::size_t i = 0; i < *got; ++i) EXPECT_TRUE(std::isfinite(samples[i]));
    frames += static_cast<std::int64_t>(*got);
  }
  EXPECT_EQ(frames, source->frames());
  return true;
}

TEST(WavTest, TakesEveryFlippedBit) {
  int read = 0, refused = 0;
  for (ByteVector bytes : Victims()) {
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
      ++(ReadDamaged(bytes) ? read : refused);
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    }
  }
  EXPECT_GT(read, 1000);
  EXPECT_GT(refused, 1000);
}

// Bytes set to values that hurt, pieces cut out, doubled and swapped, several times over.
TEST(WavTest, TakesRandomDamage) {
  constexpr std::uint8_t kHurtful[] = {0, 1, 2, 3, 0x7F, 0x80, 0xFE, 0xFF};
  const std::vector<ByteVector> victims = Victims();
  std::mt19937 random(20240611);
  int read = 0;
  for (int round = 0; round < 20000; ++round) {
    ByteVector bytes = victims[random() % victims.size()];
    for (auto n = 1 + random() % 6; n > 0 && !bytes.empty(); --n) {
      const auto at = static_cast<std::ptrdiff_t>(random() % bytes.size());
      const std::ptrdiff_t size = std::min<std::ptrdiff_t>(
          1 + static_cast<std::ptrdiff_t>(random() % 8), std::ssize(bytes) - at);
      switch (random() % 4) {
        case 0:
          std::fill_n(bytes.begin() + at, size, kHurtful[random() % 8]);
          break;
        case 1:
          bytes.erase(bytes.begin() + at, bytes.begin() + at + size);
          break;
        case 2: {
          const ByteVector part(bytes.begin() + at, bytes.begin() + at + size);
          bytes.insert(bytes.begin() + at, part.begin(), part.end());
          break;
        }
        default:
          bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(random());
      }
    }
    read += ReadDamaged(bytes) ? 1 : 0;
  }
  EXPECT_GT(read, 2000);
}

}  // namespace
}  // namespace gestus::audio
