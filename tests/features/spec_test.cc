#include "models/features/spec.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/weights_file.h"
#include "tests/engine/weights_builder.h"
#include "weights_generated.h"

namespace gestus::features {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

// A ZS-MSTM 2.0 whose record says `features`.
test::FileSpec Zs2(std::function<Offset<fb::Features>(FlatBufferBuilder&)> features) {
  test::FileSpec file;
  test::NetworkSpec& network = file.networks[0];
  network.type = fb::Config::ZsMstm2Config;
  network.config = [](FlatBufferBuilder& b) {
    const auto core = fb::CreateZsMstm1Config(b, 16, 768, 22, 64, fb::CreateAstConfig(b));
    return fb::CreateZsMstm2Config(b, core, 4, 3).Union();
  };
  network.features = std::move(features);
  file.tensors = {{"x", {1}, {0}}};
  return file;
}

Result<FeatureSpec> Read(const test::FileSpec& spec) {
  const test::Bytes bytes = spec.Build();
  const auto file = WeightsFile::FromMemory(bytes.data(), bytes.size(), "w.fb");
  if (!file.ok()) return file.status();
  return ReadFeatureSpec(*(*file)->FindNetwork(""));
}

TEST(FeatureSpecTest, AbsentMeansDefaults) {
  const Result<FeatureSpec> spec = Read(Zs2(nullptr));
  ASSERT_TRUE(spec.ok()) << spec.status().message();
  EXPECT_EQ(spec->layout, Layout::kFrames);
  EXPECT_EQ(spec->frames, 16);
  EXPECT_EQ(spec->d_face, 4);
  EXPECT_EQ(spec->d_tags, 3);
  EXPECT_EQ(spec->speech, SpeechFeature::kLogMel);
  EXPECT_EQ(spec->sample_rate, 44100);
  EXPECT_EQ(spec->pitch_sample_rate, 16000);
  EXPECT_EQ(spec->pause, 0.2);  // the decimal, not the float next to it
  EXPECT_EQ(spec->pitch_hop, 0.01);
  EXPECT_TRUE(spec->landmarks.empty());
}

TEST(FeatureSpecTest, FieldsAreTaken) {
  const Result<FeatureSpec> spec = Read(Zs2([](FlatBufferBuilder& b) {
    const std::vector<Offset<fb::Joint>> points = {
        fb::CreateJoint(b, b.CreateString("chin"), -1, 8),
        fb::CreateJoint(b, b.CreateString("brow"), -1, 17)};
    const std::vector<Offset<flatbuffers::String>> tags = {
        b.CreateString("Hedge"), b.CreateString("Apology"), b.CreateString("Thanking")};
    const auto landmarks = b.CreateVector(points);
    const auto names = b.CreateVector(tags);
    fb::FeaturesBuilder f(b);
    f.add_sample_rate(22050);
    f.add_rows(fb::RowPlacement::Pats);
    f.add_pitch(fb::PitchReading::Textbook);
    f.add_pitch_ends(fb::PitchEnds::Linear);
    f.add_landmarks(landmarks);
    f.add_tags(names);
    return f.Finish();
  }));
  ASSERT_TRUE(spec.ok()) << spec.status().message();
  EXPECT_EQ(spec->sample_rate, 22050);
  EXPECT_EQ(spec->rows, RowPlacement::kPats);
  EXPECT_EQ(spec->pitch, PitchReading::kTextbook);
  EXPECT_EQ(spec->pitch_ends, PitchEnds::kLinear);
  EXPECT_EQ(spec->landmarks, (std::vector<std::int64_t>{8, 17}));
  EXPECT_EQ(spec->tags, (std::vector<std::string>{"Hedge", "Apology", "Thanking"}));
}

TEST(FeatureSpecTest, TheFilterBankHasARateOfItsOwn) {
  test::FileSpec file;
  file.networks[0].features = [](FlatBufferBuilder& b) {
    fb::FeaturesBuilder f(b);
    f.add_speech(fb::SpeechFeature::FilterBank);
    return f.Finish();
  };
  file.tensors = {{"x", {1}, {0}}};
  const Result<FeatureSpec> spec = Read(file);
  ASSERT_TRUE(spec.ok()) << spec.status().message();
  EXPECT_EQ(spec->sample_rate, 16000);
  EXPECT_EQ(spec->frame_rate, 100);
}

struct Bad {
  const char* expect;
  void (*add)(fb::FeaturesBuilder&);
};

TEST(FeatureSpecTest, WhatIsOutOfRangeIsNamed) {
  const Bad kBad[] = {
      {"sample_rate: 0", [](auto& f) { f.add_sample_rate(0); }},
      {"pitch_hop", [](auto& f) { f.add_pitch_hop(0); }},
      {"pitch_maximum", [](auto& f) { f.add_pitch_maximum(45); }},
      {"pitch_threshold", [](auto& f) { f.add_pitch_threshold(2); }},
      {"rows: 9", [](auto& f) { f.add_rows(static_cast<fb::RowPlacement>(9)); }},
      {"pause", [](auto& f) { f.add_pause(-1); }},
  };
  for (const Bad& bad : kBad) {
    const Result<FeatureSpec> spec = Read(Zs2([&](FlatBufferBuilder& b) {
      fb::FeaturesBuilder f(b);
      bad.add(f);
      return f.Finish();
    }));
    ASSERT_FALSE(spec.ok()) << bad.expect;
    EXPECT_NE(spec.status().message().find(bad.expect), std::string::npos)
        << spec.status().message();
  }
}

// Found by tests/fuzz/front_end_fuzz.cc: a front end allocates by these before the network checks
// them.
TEST(FeatureSpecTest, TheNetworksOwnNumbersAreInRange) {
  struct Core {
    std::uint32_t frames, d_text, mel_bins;
    float rate;
    std::uint32_t context;
    const char* expect;
  };
  constexpr std::uint32_t kHuge = 0xffffffff;
  const Core kCores[] = {
      {0, 768, 128, 15, 1, "network net: frames: 0, expected 1 to 4096"},
      {kHuge, 768, 128, 15, 1, "network net: frames: 4294967295"},
      {16, kHuge, 128, 15, 1, "network net: d_text: 4294967295"},
      {16, 768, 0, 15, 1, "network net: mel_bins: 0"},
      {16, 768, 128, 0, 1, "network net: frame_rate: 0"},
      {16, 768, 128, 15, kHuge, "network net: context_segments: 4294967295"},
      {4096, 16384, 128, 15, 1, "values of a segment's text: 67108864, expected 0 to 33554432"},
  };
  for (const Core& core : kCores) {
    test::FileSpec file = Zs2(nullptr);
    file.networks[0].config = [&core](FlatBufferBuilder& b) {
      const auto ast = fb::CreateAstConfig(b, 16, core.mel_bins);
      fb::ZsMstm1ConfigBuilder c(b);
      c.add_frames(core.frames);
      c.add_d_text(core.d_text);
      c.add_ast_content(ast);
      c.add_frame_rate(core.rate);
      c.add_granularity(fb::Granularity::Segment);
      c.add_context_segments(core.context);
      const auto made = c.Finish();
      return fb::CreateZsMstm2Config(b, made, 4, 3).Union();
    };
    const Result<FeatureSpec> spec = Read(file);
    ASSERT_FALSE(spec.ok()) << core.expect;
    EXPECT_TRUE(spec.status().message().find(core.expect) != std::string::npos)
        << spec.status().message();
  }
}

TEST(FeatureSpecTest, ListsFitTheirWidths) {
  for (const bool landmarks : {true, false}) {
    const Result<FeatureSpec> spec = Read(Zs2([&](FlatBufferBuilder& b) {
      const std::vector<Offset<fb::Joint>> points = {
          fb::CreateJoint(b, b.CreateString("chin"), -1, landmarks ? 8u : 70u)};
      const auto list = b.CreateVector(points);
      fb::FeaturesBuilder f(b);
      f.add_landmarks(list);
      return f.Finish();
    }));
    ASSERT_FALSE(spec.ok());
    EXPECT_NE(spec.status().message().find(landmarks ? "expected half of d_face, 4"
                                                     : "landmarks: 70, expected 0 to 69"),
              std::string::npos)
        << spec.status().message();
  }
}

}  // namespace
}  // namespace gestus::features
