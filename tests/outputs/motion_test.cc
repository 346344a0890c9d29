#include "models/outputs/motion.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "engine/weights_file.h"
#include "tests/engine/weights_builder.h"
#include "weights_generated.h"

namespace gestus::outputs {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;
using models::Array;
using models::Arrays;
using Config = std::function<Offset<void>(FlatBufferBuilder&)>;

std::vector<std::string> NamesOf(const Motion& motion) {
  std::vector<std::string> names;
  for (const auto* figure : {&motion.body, &motion.face}) {
    if (!*figure) continue;
    for (const Point& point : (*figure)->points)
      names.push_back(point.name + " " + std::to_string(point.source));
  }
  if (!motion.curves) return names;
  for (const Curve& curve : motion.curves->curves) names.push_back(curve.name);
  return names;
}

/// The motion; its layout, which needs no outputs, must have the same names.
Result<Motion> Of(fb::Config type, Config config, const Arrays& outputs,
                  std::vector<test::JointSpec> joints = {}) {
  test::FileSpec file;
  file.networks[0].type = type;
  file.networks[0].config = std::move(config);
  file.networks[0].joints = std::move(joints);
  file.tensors = {{"x", {1}, {0}}};
  const test::Bytes bytes = file.Build();
  const auto weights = WeightsFile::FromMemory(bytes.data(), bytes.size(), "w.fb");
  if (!weights.ok()) return weights.status();
  const fb::Network& record = *(*weights)->FindNetwork("");
  Result<Motion> motion = MotionOf(record, outputs);
  if (!motion.ok()) return motion;
  const Result<Motion> layout = LayoutOf(record);
  EXPECT_TRUE(layout.ok()) << layout.status().message();
  if (layout.ok()) {
    EXPECT_EQ(NamesOf(*layout), NamesOf(*motion));
    EXPECT_EQ(layout->frames, 0);
  }
  return motion;
}

Array F32(std::vector<std::int64_t> shape, std::vector<float> values) {
  Array array;
  array.shape = std::move(shape);
  array.f32 = std::move(values);
  return array;
}

Array I32(std::vector<std::int64_t> shape, std::vector<std::int32_t> values) {
  Array array;
  array.dtype = DType::kI32;
  array.shape = std::move(shape);
  array.i32 = std::move(values);
  return array;
}

Offset<void> TwoJoints(FlatBufferBuilder& b) {
  return fb::CreateZsMstm1Config(b, 2, 8, 4, 8, fb::CreateAstConfig(b)).Union();
}

Offset<void> OneChannel(FlatBufferBuilder& b) {
  const std::vector<Offset<fb::Channel>> channels = {
      fb::CreateChannel(b, b.CreateString("AU01"), b.CreateString("intensity"), 0, 0.5f, 11)};
  const auto list = b.CreateVector(channels);
  fb::Model1ConfigBuilder config(b);
  config.add_channels(list);
  return config.Finish().Union();
}

TEST(MotionTest, PosesHavePointsAndSeams) {
  const Result<Motion> motion =
      Of(fb::Config::ZsMstm1Config, TwoJoints,
         {{"pose",
           F32({5, 4}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19})}},
         {{"Neck"}, {"RShoulder", 0}});
  ASSERT_TRUE(motion.ok()) << motion.status().message();
  EXPECT_EQ(motion->frames, 5);
  EXPECT_EQ(motion->frame_rate, 15);
  EXPECT_EQ(motion->seams, (std::vector<std::int64_t>{2, 4}));
  ASSERT_TRUE(motion->body.has_value());
  EXPECT_EQ(motion->body->points[1].name, "RShoulder");
  EXPECT_EQ(motion->body->points[1].parent, 0);
  EXPECT_EQ(motion->body->x(1, 1), 5);
  EXPECT_EQ(motion->body->y(1, 0), 6);
  EXPECT_FALSE(motion->face.has_value());
}

TEST(MotionTest, ArraysMustFit) {
  for (const Arrays& arrays : {Arrays{}, Arrays{{"pose", F32({1, 3}, {1, 2, 3})}},
                               Arrays{{"pose", F32({4}, {1, 2, 3, 4})}}}) {
    const Result<Motion> motion = Of(fb::Config::ZsMstm1Config, TwoJoints, arrays);
    ASSERT_FALSE(motion.ok());
    EXPECT_NE(motion.status().message().find("pose: does not fit"), std::string::npos);
  }
  EXPECT_FALSE(Of(fb::Config::AstConfig, nullptr, {}).ok());
}

// 24 frames a second: word 0 begins at frame 2 and has 2 values, word 1 at frame 6 and has 5, of
// which there is room for 4.
TEST(MotionTest, SequencesArePlacedInTimeAndJoined) {
  const Arrays outputs = {{"face", F32({2, 6, 1}, {1, 2, 9, 9, 9, 9, 4, 4, 3, 2, 1, 9})},
                          {"lengths", I32({2, 1}, {2, 5})},
                          {"times_ms", I32({2, 2}, {83, 150, 250, 417})}};
  const Result<Motion> motion = Of(fb::Config::Model1Config, OneChannel, outputs);
  ASSERT_TRUE(motion.ok()) << motion.status().message();
  EXPECT_EQ(motion->frame_rate, 24);
  EXPECT_EQ(motion->frames, 10);
  const float third = 2.0f / 3;
  const std::vector<float> want = {1, 1, 1, 2, 2 + third, 2 + 2 * third, 4, 4, 3, 2};
  ASSERT_EQ(motion->curves->values.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i)
    EXPECT_NEAR(motion->curves->values[i], want[i], 1e-6) << i;
  EXPECT_EQ(motion->seams, (std::vector<std::int64_t>{6}));
  EXPECT_EQ(motion->curves->curves[0].maximum, 5);
}

TEST(MotionTest, WithoutTimesSequencesFollowOneAnother) {
  const Result<Motion> motion =
      Of(fb::Config::Model1Config, OneChannel,
         {{"face", F32({2, 3, 1}, {1, 2, 9, 5, 9, 9})}, {"lengths", I32({2, 1}, {2, 1})}});
  ASSERT_TRUE(motion.ok());
  EXPECT_EQ(motion->curves->values, (std::vector<float>{1, 2, 5}));
}

TEST(MotionTest, NothingSaidIsOneFrameOfRest) {
  const Result<Motion> motion =
      Of(fb::Config::Model1Config, OneChannel,
         {{"face", F32({1, 3, 1}, {9, 9, 9})}, {"lengths", I32({1, 1}, {0})}});
  ASSERT_TRUE(motion.ok());
  EXPECT_EQ(motion->curves->values, (std::vector<float>{0}));
}

}  // namespace
}  // namespace gestus::outputs
