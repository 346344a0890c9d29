// Sound files that libsndfile reads, or that a build without it names.
#include "models/audio/source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "tests/audio/wav_builder.h"
#include "tests/engine/temp_file.h"
#ifdef GESTUS_HAVE_SNDFILE
#include <sndfile.h>
#endif
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace gestus::audio {
namespace {

std::string ErrorOf(const std::string& bytes) {
  const test::TempFile file(std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
  const auto source = OpenAudio(file.path());
  if (source.ok()) return "";
  const std::string message = source.status().message();
  EXPECT_EQ(message.substr(0, file.path().size() + 2), file.path() + ": ");
  return message.substr(file.path().size() + 2);
}

#ifdef GESTUS_HAVE_SNDFILE

// A file written by libsndfile that goes when the test ends.
class Written {
 public:
  Written(int format, int rate, const std::vector<float>& samples, int channels = 1) : file_({}) {
    SF_INFO info = {};
    info.samplerate = rate, info.channels = channels, info.format = format;
    SNDFILE* sound = sf_open(file_.path().c_str(), SFM_WRITE, &info);
    EXPECT_NE(sound, nullptr) << sf_strerror(nullptr);
    if (sound == nullptr) return;
    sf_write_float(sound, samples.data(), static_cast<sf_count_t>(samples.size()));
    sf_close(sound);
  }
  const std::string& path() const { return file_.path(); }

 private:
  test::TempFile file_;
};

std::vector<float> Tone(std::size_t n, int rate) {
  std::vector<float> samples(n);
  for (std::size_t i = 0; i < n; ++i) {
    samples[i] = 0.5f * static_cast<float>(
                            std::sin(2 * std::numbers::pi * 440 * static_cast<double>(i) / rate));
  }
  return samples;
}

std::vector<float> ReadAll(AudioSource* source) {
  std::vector<float> all, part(777);
  for (;;) {
    const Result<std::size_t> got = source->Read(part.data(), part.size());
    EXPECT_TRUE(got.ok());
    if (!got.ok() || *got == 0) return all;
    all.insert(all.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(*got));
  }
}

TEST(SourceTest, ReadsLosslessFormats) {
  const std::vector<float> tone = Tone(30000, 44100);
  for (const int format :
       {SF_FORMAT_FLAC | SF_FORMAT_PCM_16, SF_FORMAT_AIFF | SF_FORMAT_PCM_16,
        SF_FORMAT_CAF | SF_FORMAT_PCM_16, SF_FORMAT_AU | SF_FORMAT_PCM_16,
        SF_FORMAT_WAV | SF_FORMAT_PCM_16, SF_FORMAT_WAV | SF_FORMAT_PCM_16 | SF_ENDIAN_BIG,
        SF_FORMAT_RF64 | SF_FORMAT_PCM_16, SF_FORMAT_W64 | SF_FORMAT_PCM_16,
        SF_FORMAT_WAVEX | SF_FORMAT_FLOAT, SF_FORMAT_WAV | SF_FORMAT_DOUBLE}) {
    const Written file(format, 44100, tone);
    auto source = OpenAudio(file.path());
    ASSERT_TRUE(source.ok()) << source.status().message();
    EXPECT_EQ((*source)->sample_rate(), 44100);
    EXPECT_EQ((*source)->frames(), 30000);
    const std::vector<float> got = ReadAll(source->get());
    ASSERT_EQ(got.size(), tone.size()) << std::hex << format;
    for (std::size_t i = 0; i < got.size(); ++i) ASSERT_NEAR(got[i], tone[i], 4e-5f) << i;
    EXPECT_TRUE((*source)->notes().empty());
  }
}

TEST(SourceTest, MixesChannels) {
  std::vector<float> six(6 * 1000);
  for (std::size_t i = 0; i < six.size(); ++i) six[i] = static_cast<float>(i % 6) / 16;
  const Written file(SF_FORMAT_FLAC | SF_FORMAT_PCM_16, 96000, six, 6);
  auto source = OpenAudio(file.path());
  ASSERT_TRUE(source.ok()) << source.status().message();
  EXPECT_EQ((*source)->channels(), 6);
  EXPECT_EQ(ReadAll(source->get()), std::vector<float>(1000, 15 / 96.0f));
}

// Lossy files are not compared by samples: the loudness must be there, and about the length.
TEST(SourceTest, ReadsLossyFormats) {
  const std::vector<float> tone = Tone(48000, 48000);
  for (const int format : {SF_FORMAT_OGG | SF_FORMAT_VORBIS, SF_FORMAT_OGG | SF_FORMAT_OPUS,
                           SF_FORMAT_MPEG | SF_FORMAT_MPEG_LAYER_III,
                           SF_FORMAT_WAV | SF_FORMAT_ULAW, SF_FORMAT_WAV | SF_FORMAT_IMA_ADPCM}) {
    const Written file(format, 48000, tone);
    auto source = OpenAudio(file.path());
    ASSERT_TRUE(source.ok()) << source.status().message();
    EXPECT_EQ((*source)->sample_rate(), 48000);
    const std::vector<float> got = ReadAll(source->get());
    EXPECT_NEAR(static_cast<double>(got.size()), 48000, 3000) << std::hex << format;
    double square = 0;
    for (const float sample : got) square += static_cast<double>(sample * sample);
    EXPECT_NEAR(std::sqrt(square / 48000), 0.5 / std::sqrt(2.0), 0.02) << std::hex << format;
  }
}

// Opens a file written by libsndfile cut short in many places; returns how many were read.
int ReadTruncations(int format) {
  const Written file(format, 8000, Tone(3000, 8000));
  std::ifstream in(file.path(), std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_GT(bytes.size(), 500u);
  int read = 0;
  for (std::size_t size = 0; size < bytes.size(); size += size < 300 ? 1 : 37) {
    const test::TempFile cut({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
    auto source = OpenAudio(cut.path());
    if (!source.ok()) continue;
    for (const float sample : ReadAll(source->get())) EXPECT_TRUE(std::isfinite(sample));
    ++read;
  }
  return read;
}

TEST(SourceTest, TakesTruncatedFlac) {
  EXPECT_GT(ReadTruncations(SF_FORMAT_FLAC | SF_FORMAT_PCM_16), 10);
}

TEST(SourceTest, TakesTruncatedVorbis) {
#ifdef __SANITIZE_ADDRESS__
  // libsndfile 1.2.0 loses some kilobytes for each Ogg file that it refuses.
  const __lsan::ScopedDisabler disabler;
#endif
  EXPECT_GT(ReadTruncations(SF_FORMAT_OGG | SF_FORMAT_VORBIS), 5);
}

TEST(SourceTest, SaysWhatIsWrong) {
  EXPECT_TRUE(HaveSndfile());
  EXPECT_EQ(
      ErrorOf("this is a text"),
      "is no sound file that libsndfile can read (Format not recognised), expected WAV, FLAC, "
      "OGG or MP3");
  EXPECT_NE(ErrorOf("fLaC and then nothing"), "");
  EXPECT_NE(ErrorOf("OggS"), "");
}

#else

TEST(SourceTest, NamesWhatItCannotRead) {
  EXPECT_FALSE(HaveSndfile());
  EXPECT_EQ(ErrorOf("this is a text"),
            "is no WAV file, expected WAV: this build has no libsndfile to read more");
  EXPECT_EQ(ErrorOf("fLaC..."),
            "is a FLAC file, expected WAV: this build has no libsndfile to read more");
  const std::vector<std::uint8_t> law = Wav({.format = 7, .bits = 8}, {1, 2, 3});
  EXPECT_EQ(ErrorOf({law.begin(), law.end()}),
            "fmt: samples in format 7, expected PCM (1) or float (3): this build has no libsndfile "
            "to read more");
}

#endif

}  // namespace
}  // namespace gestus::audio
