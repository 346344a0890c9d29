#include "models/features/speech_rows.h"

#include <algorithm>
#include <cmath>

#include "models/audio/fbank.h"
#include "models/audio/log_mel.h"
#include "models/audio/rows.h"
#include "tests/features/recordings.h"

namespace gestus::features {
namespace {

std::vector<float> Read(const std::string& path, const FeatureSpec& spec,
                        const std::vector<std::int64_t>& sizes, std::int64_t* total = nullptr) {
  Result<SpeechRows> rows = SpeechRows::Open(path, spec);
  EXPECT_TRUE(rows.ok()) << rows.status().message();
  if (total != nullptr) *total = rows->total();
  std::vector<float> all;
  for (std::size_t i = 0, before = 1; all.size() != before; ++i) {
    before = all.size();
    EXPECT_TRUE(rows->Read(sizes[i % sizes.size()], &all).ok());
  }
  return all;
}

// Every row of log-mel of the samples as the front end hears them.
std::vector<float> LogMel(const std::string& path, const FeatureSpec& spec) {
  audio::LogMelOptions options = audio::PatsLogMel512(spec.sample_rate);
  options.mels = static_cast<int>(spec.mel_bins);
  auto stage = audio::LogMel::Make(options);
  EXPECT_TRUE(stage.ok());
  const std::vector<float> samples = Resampled(path, spec.sample_rate);
  return audio::AllRows(&*stage, samples.data(), samples.size());
}

std::vector<float> Pick(const std::vector<float>& rows, std::int64_t width,
                        const std::vector<std::int64_t>& which) {
  std::vector<float> picked;
  const std::int64_t last = static_cast<std::int64_t>(rows.size()) / width - 1;
  for (const std::int64_t row : which) {
    const auto from = rows.begin() + std::min(row, last) * width;
    picked.insert(picked.end(), from, from + width);
  }
  return picked;
}

std::int64_t Nearest(double row) { return std::llround(std::floor(row + 0.5)); }

TEST(SpeechRowsTest, ExactRowsAreTheNearestInTime) {
  const TempFolder folder;
  for (const int rate : {8000, 11025, 48000}) {
    const std::string path = WriteWav(folder, "a.wav", Voice(3.37, rate), rate);
    for (const int heard : {8000, 22050}) {
      FeatureSpec spec = FramesSpec();
      spec.sample_rate = heard;
      std::int64_t total = 0;
      const std::vector<float> got = Read(path, spec, {1 << 20}, &total);
      EXPECT_EQ(total, 50);  // int(3.37 * 15)
      std::vector<std::int64_t> which;
      for (int i = 0; i < 50; ++i) which.push_back(Nearest(i / 15.0 * heard / 512));
      EXPECT_EQ(got, Pick(LogMel(path, spec), 10, which)) << rate << " heard at " << heard;
    }
  }
}

// Rows of a segment run ahead of its time, by 21 at 8 kHz; the next one begins at its own.
TEST(SpeechRowsTest, RowsOfPatsGoOnByTheirStrideWithinASegment) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "a.wav", Voice(20, 8000), 8000);
  for (const int heard : {8000, 44100}) {
    for (const std::int64_t segment : {8, 64}) {
      FeatureSpec spec = FramesSpec();
      spec.rows = RowPlacement::kPats;
      spec.sample_rate = heard;
      spec.style_frames = segment;
      std::vector<std::int64_t> which;
      for (std::int64_t i = 0; i < 300; ++i) {
        const std::int64_t begin = i / segment * segment;
        which.push_back(Nearest(static_cast<double>(begin) / 15 * heard / 512) + (i - begin) * 6);
      }
      const std::vector<float> want = Pick(LogMel(path, spec), 10, which);
      EXPECT_TRUE(Read(path, spec, {1 << 20}) == want) << heard << ", " << segment;
      EXPECT_TRUE(Read(path, spec, {3, 1, 40}) == want) << heard << ", " << segment;
    }
  }
}

TEST(SpeechRowsTest, FramesNeedNotBeWholeInASecond) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "a.wav", Voice(60, 8000), 8000);
  FeatureSpec spec = FramesSpec();
  spec.frame_rate = 29.97;
  std::int64_t total = 0;
  const std::vector<float> got = Read(path, spec, {500}, &total);
  EXPECT_EQ(total, 1798);
  std::vector<std::int64_t> which;
  for (int i = 0; i < 1798; ++i) which.push_back(Nearest(i / 29.97 * 8000 / 512));
  EXPECT_TRUE(got == Pick(LogMel(path, spec), 10, which));
}

TEST(SpeechRowsTest, AnyPiecesGiveTheSameRows) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "a.wav", Voice(7.1, 44100), 44100, 2);
  const FeatureSpec spec = FramesSpec();
  const std::vector<float> whole = Read(path, spec, {1000});
  ASSERT_EQ(whole.size(), 106u * 10);
  EXPECT_EQ(Read(path, spec, {1}), whole);
  EXPECT_EQ(Read(path, spec, {7, 64, 2}), whole);
}

TEST(SpeechRowsTest, AMomentIsOneFrame) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "a.wav", Voice(0.001, 8000), 8000);
  EXPECT_EQ(Read(path, FramesSpec(), {5}).size(), 10u);
}

FeatureSpec Bank(bool every_row) {
  FeatureSpec spec = FramesSpec();
  spec.speech = SpeechFeature::kFilterBank;
  spec.every_row = every_row;
  spec.sample_rate = 16000;
  spec.frames = 64;
  spec.mel_bins = 24;
  if (every_row) spec.frame_rate = 100;
  return spec;
}

std::vector<float> BankRows(const std::string& path) {
  audio::FbankOptions options;
  options.bins = 24;
  auto stage = audio::Fbank::Make(options);
  EXPECT_TRUE(stage.ok());
  const std::vector<float> samples = Resampled(path, 16000);
  return audio::AllRows(&*stage, samples.data(), samples.size());
}

TEST(SpeechRowsTest, TheFilterBankHasRowsOfItsOwn) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "a.wav", Voice(1.23, 22050), 22050);
  const std::vector<float> want = BankRows(path);
  ASSERT_EQ(want.size(), 24u * 121);  // 1 + (19680 - 400) / 160
  std::int64_t total = 0;
  EXPECT_EQ(Read(path, Bank(true), {50}, &total), want);
  EXPECT_EQ(total, 121);
}

TEST(SpeechRowsTest, AShortRecordingIsFilledUpWithZerosForTheFilterBank) {
  const TempFolder folder;
  for (const double seconds : {0.01, 0.3}) {
    const std::string path = WriteWav(folder, "a.wav", Voice(seconds, 16000), 16000);
    std::vector<float> want = BankRows(path);
    EXPECT_EQ(want.size(), seconds < 0.1 ? 0u : 24u * 28);
    want.resize(24 * 64);
    EXPECT_EQ(Read(path, Bank(true), {50}), want);
  }
}

TEST(SpeechRowsTest, AtTheMotionsRateTheFilterBanksRowsAreTheNearestInTime) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "a.wav", Voice(2, 16000), 16000);
  std::vector<std::int64_t> which;
  for (int i = 0; i < 30; ++i)
    which.push_back(std::max<std::int64_t>(0, Nearest((i / 15.0 * 16000 - 200) / 160)));
  EXPECT_EQ(Read(path, Bank(false), {4}), Pick(BankRows(path), 24, which));
}

TEST(SpeechRowsTest, WithoutSamplesThereIsNothing) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "empty.wav", {}, 8000);
  const Result<SpeechRows> rows = SpeechRows::Open(path, FramesSpec());
  ASSERT_FALSE(rows.ok());
  EXPECT_EQ(rows.status().message(), path + ": has no samples, expected recorded speech");
  EXPECT_FALSE(SpeechRows::Open(folder.path() + "/none.wav", FramesSpec()).ok());
}

}  // namespace
}  // namespace gestus::features
