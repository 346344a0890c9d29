// Columns of PATS from pixels, and back.
#include "models/motion/select.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "models/motion/joints.h"

namespace gestus::motion {
namespace {

Track RandomTrack(std::vector<std::string> names, std::int64_t frames, unsigned seed) {
  Track track(std::move(names), 2, frames, 15);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> pixel(100, 900), found(0.1f, 1);
  for (float& v : track.values) v = pixel(random);
  for (float& c : track.confidence) c = found(random);
  return track;
}

Track Body(std::int64_t frames = 9, unsigned seed = 1) {
  return RandomTrack(PatsJointNames(), frames, seed);
}

TEST(SelectTest, NormalisesAsPatsDoes) {
  Track body = Body(1);
  body.value(0, 0, kNeck) = 500;
  body.value(0, 1, kNeck) = 300;
  body.value(0, 0, kRShoulder) = 470;
  body.value(0, 1, kRShoulder) = 340;  // 50 long
  body.value(0, 0, kLWrist) = 510;
  body.value(0, 1, kLWrist) = 320;
  const auto stances = FindStances(body);
  ASSERT_TRUE(stances.ok()) << stances.status().message();
  EXPECT_EQ(stances->frames[0].shoulder, 50);
  EXPECT_TRUE(stances->notes.empty());
  const std::vector<std::int32_t> joints = {kLWrist, kNeck, kRShoulder};
  using Columns = std::vector<float>;
  const auto columns = [&](PoseSource source, NeckColumns neck) {
    return *PoseColumns(body, {joints, source, neck}, stances->frames);
  };
  EXPECT_EQ(columns(PoseSource::kData, NeckColumns::kPosition),
            (Columns{10, 500, -30, 20, 300, 40}));
  EXPECT_EQ(columns(PoseSource::kData, NeckColumns::kZero), (Columns{10, 0, -30, 20, 0, 40}));
  const Columns got = columns(PoseSource::kNormalize, NeckColumns::kPosition);
  const Columns want = {33.4f, 500, -100.2f, 66.8f, 300, 133.6f};
  for (std::size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(got[i], want[i], 1e-4) << i;
  EXPECT_NEAR(std::hypot(got[2], got[5]), kShoulder, 1e-4);
}

TEST(SelectTest, BackAndForth) {
  const Track body = Body(200), face = RandomTrack(FacePointNames(), 200, 2);
  const auto stances = FindStances(body);
  ASSERT_TRUE(stances.ok());
  std::vector<std::int32_t> all(kPatsJoints), landmarks = {0, 4, 8, 17, 41, 69};
  for (std::int32_t j = 0; j < kPatsJoints; ++j) all[static_cast<std::size_t>(j)] = j;
  for (const PoseSource source : {PoseSource::kNormalize, PoseSource::kData}) {
    for (const NeckColumns neck : {NeckColumns::kPosition, NeckColumns::kZero}) {
      const PoseLayout layout = {all, source, neck};
      const auto pose = PoseColumns(body, layout, stances->frames);
      ASSERT_TRUE(pose.ok());
      const auto pixels = PosePixels(*pose, layout, stances->frames);
      ASSERT_TRUE(pixels.ok());
      ASSERT_EQ(pixels->size(), body.values.size());
      // Two roundings of numbers up to 900 and a scale.
      for (std::size_t i = 0; i < pixels->size(); ++i) {
        ASSERT_NEAR((*pixels)[i], body.values[i], 3e-4) << i;
      }
    }
    const auto columns = FaceColumns(face, landmarks, source, stances->frames);
    ASSERT_TRUE(columns.ok());
    const auto pixels = FacePixels(*columns, std::ssize(landmarks), source, stances->frames);
    ASSERT_TRUE(pixels.ok());
    for (std::int64_t t = 0; t < 200; ++t) {
      for (std::size_t i = 0; i < landmarks.size(); ++i) {
        const std::size_t at = static_cast<std::size_t>(t) * 12 + i;
        ASSERT_NEAR((*pixels)[at], face.value(t, 0, landmarks[i]), 3e-4);
        ASSERT_NEAR((*pixels)[at + 6], face.value(t, 1, landmarks[i]), 3e-4);
      }
    }
  }
}

TEST(SelectTest, OneStanceServesAllFrames) {
  const PoseLayout layout = {{kNeck, kLWrist}};
  const std::vector<float> columns = {1, 2, 3, 4, 1, 5, 3, 6};
  const std::vector<Stance> one = {{640, 360, 83.5f}}, many = {one[0], one[0]};
  const auto pixels = PosePixels(columns, layout, one);
  ASSERT_TRUE(pixels.ok());
  EXPECT_EQ(*pixels, (std::vector<float>{640, 641, 360, 362, 640, 642.5f, 360, 363}));
  EXPECT_EQ(*pixels, *PosePixels(columns, layout, many));
}

TEST(SelectTest, InterpolatesShouldersWithoutLength) {
  Track body = Body(8);
  for (std::int64_t t = 0; t < 8; ++t) {
    const float length = t == 0 ? 0.0f : t == 3 ? 1.0f : t == 4 ? 3.0f : static_cast<float>(40 + t);
    body.value(t, 0, kRShoulder) = body.value(t, 0, kNeck) + length;
    body.value(t, 1, kRShoulder) = body.value(t, 1, kNeck);
  }
  const auto stances = FindStances(body);
  ASSERT_TRUE(stances.ok());
  const float want[] = {41, 41, 42, 43, 44, 45, 46, 47};
  for (std::size_t t = 0; t < 8; ++t) EXPECT_NEAR(stances->frames[t].shoulder, want[t], 1e-3) << t;
  EXPECT_EQ(stances->notes,
            std::vector<std::string>{
                "3 frames with hardly any distance from Neck to RShoulder: interpolated"});
}

TEST(SelectTest, SaysWhatIsWrong) {
  const Track body = Body(3);
  const auto stances = FindStances(body)->frames;
  const auto error = [&](const Track& track, std::vector<std::int32_t> joints,
                         std::span<const Stance> where) {
    return PoseColumns(track, {std::move(joints)}, where).status().message();
  };
  EXPECT_EQ(error(body, {}, stances), "no joints, expected one at least");
  EXPECT_EQ(error(body, {0, 52}, stances), "joint 52, expected 0 to 51");
  EXPECT_EQ(error(body, {-1}, stances), "joint -1, expected 0 to 51");
  EXPECT_EQ(error(body, {0}, std::span(stances).first(1)),
            "1 stance for 3 frames, expected as many");
  EXPECT_EQ(error(Track({"a"}, 2, 3, 15), {0}, stances),
            "body: 3 frames of 1 point, expected frames of 52");
  Track lost = Body(3);
  for (std::int64_t t = 0; t < 3; ++t) lost.seen(t, 11) = lost.seen(t, kNeck) = 0;
  EXPECT_EQ(error(lost, {11}, stances),
            "LHandThumb1 was not seen in any of 3 frames, but the pose needs it");
  EXPECT_EQ(FindStances(lost).status().message(),
            "Neck was not seen in any of 3 frames, but the pose needs it");
  Track flat = Body(3);
  flat.values.assign(flat.values.size(), 5);
  EXPECT_EQ(FindStances(flat).status().message(),
            "Neck and RShoulder are at one place in most frames, expected a distance");

  const Track face = RandomTrack(FacePointNames(), 3, 3);
  EXPECT_EQ(FaceColumns(face, {70}, PoseSource::kData, stances).status().message(),
            "landmark 70, expected 0 to 69");
  EXPECT_EQ(FaceColumns(Track(), {1}, PoseSource::kData, stances).status().message(),
            "face: 0 frames of 0 points, expected frames of 70");

  const std::vector<float> five(5), four(4);
  EXPECT_EQ(PosePixels(five, {{0, 1}}, stances).status().message(),
            "5 values, expected a multiple of 4");
  EXPECT_EQ(PosePixels(four, {{0, 1}}, stances).status().message(),
            "3 stances for 1 frame, expected as many");
  EXPECT_EQ(PosePixels(four, {{0, 1}}, std::vector<Stance>{{0, 0, 0}}).status().message(),
            "a shoulder of no length, expected one above 0");
  EXPECT_FALSE(FacePixels(four, 0, PoseSource::kData, stances).ok());
}

}  // namespace
}  // namespace gestus::motion
