#include "models/features/pitch.h"

#include "tests/features/recordings.h"

namespace gestus::features {
namespace {

TEST(PitchTest, IsSwipeOverTheResampledRecording) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "a.wav", Voice(2.5, 22050), 22050, 2);
  FeatureSpec spec = FramesSpec();
  spec.pitch = PitchReading::kTextbook;
  spec.pitch_sample_rate = 16000;
  spec.pitch_minimum = 80;
  spec.pitch_maximum = 400;
  const Result<Pitch> pitch = ReadPitch(path, spec);
  ASSERT_TRUE(pitch.ok()) << pitch.status().message();

  prosody::SwipeOptions options;
  options.sample_rate = 16000;
  options.min_hz = 80;
  options.max_hz = 400;
  auto swipe = prosody::Swipe::Make(options);
  ASSERT_TRUE(swipe.ok());
  const std::vector<float> samples = Resampled(path, 16000);
  std::vector<float> rows(2 * (swipe->MaxRows(samples.size()) + swipe->MaxRowsAtFinish()));
  std::size_t n = swipe->Push(samples.data(), samples.size(), rows.data());
  n += swipe->Finish(rows.data() + 2 * n);
  ASSERT_EQ(pitch->f0.size(), n);
  std::size_t voiced = 0;
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(pitch->f0[i], rows[2 * i]);
    EXPECT_EQ(pitch->strength[i], rows[2 * i + 1]);
    voiced += pitch->f0[i] > 0;
  }
  EXPECT_GT(voiced, 60u);
  EXPECT_LT(voiced, n);
  EXPECT_DOUBLE_EQ(pitch->seconds, 2.5);
  EXPECT_EQ(pitch->description, "2.50 s, 22050 Hz, mean of 2 channels, resampled to 16000 Hz");
}

TEST(PitchTest, OptionsFollowTheSpec) {
  FeatureSpec spec;
  spec.pitch_hop = 0.005;
  spec.pitch_threshold = 0.4;
  EXPECT_EQ(SwipeOptionsOf(spec).mode, prosody::SwipeMode::kSptk);
  EXPECT_EQ(SwipeOptionsOf(spec).hop_seconds, 0.005);
  EXPECT_EQ(SwipeOptionsOf(spec).threshold, 0.4);
}

TEST(PitchTest, WithoutSamplesThereIsNone) {
  const TempFolder folder;
  const std::string path = WriteWav(folder, "empty.wav", {}, 8000);
  const Result<Pitch> pitch = ReadPitch(path, FeatureSpec());
  ASSERT_FALSE(pitch.ok());
  EXPECT_EQ(pitch.status().message(), path + ": has no samples, expected recorded speech");
}

}  // namespace
}  // namespace gestus::features
