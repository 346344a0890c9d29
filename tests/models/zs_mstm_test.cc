// ZS-MSTM 1.0 as a whole, tiny: threads, agents, segments, styles, inputs that are refused, files
// with damage.  Numbers are compared with PyTorch's in golden_test.cc.
#include "models/zs_mstm/zs_mstm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>

#include "models/run_support.h"
#include "tests/engine/dense.h"
#include "tests/models/damage.h"
#include "tests/models/tiny_zs_mstm.h"
#include "tests/tolerance.h"

namespace gestus::test {
namespace {

using models::Array;
using models::Arrays;
using models::RunOptions;
using models::RunReport;
using models::ZsMstm;

constexpr std::int64_t kFrames = 8, kMel = 8, kText = 4, kPose = 6;

Arrays RunOrFail(models::Network& network, const Arrays& inputs, const RunOptions& options = {},
                 RunReport* report = nullptr) {
  auto outputs = network.Run(inputs, options, report);
  EXPECT_TRUE(outputs.ok()) << outputs.status().message();
  return outputs.ok() ? *std::move(outputs) : Arrays{};
}

bool SameBytes(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

struct Mode {
  const char* name;
  fb::DecoderMode mode;
  fb::Granularity granularity;
  std::uint32_t context = 1;
};
const Mode kModes[] = {
    {"Autoregressive", fb::DecoderMode::Autoregressive, fb::Granularity::Frame},
    {"ShiftedParallel", fb::DecoderMode::ShiftedParallel, fb::Granularity::Frame},
    {"Parallel", fb::DecoderMode::Parallel, fb::Granularity::Frame},
    {"SegmentAutoregressive", fb::DecoderMode::Autoregressive, fb::Granularity::Segment, 3},
    {"SegmentParallel", fb::DecoderMode::Parallel, fb::Granularity::Segment, 2},
};

class ZsMstmModeTest : public testing::TestWithParam<Mode> {
 protected:
  static FileSpec File() {
    TinyZsMstm c;
    c.decoder_mode = GetParam().mode;
    c.granularity = GetParam().granularity;
    c.context_segments = GetParam().context;
    FileSpec file = c.File();
    file.networks[0].statistics = {{"speech", {0.1f}, {0.8f}}, {"pose", {0.5f}, {2.0f}, 1.0f}};
    return file;
  }
  static std::int64_t Window() { return kFrames * GetParam().context; }
};
INSTANTIATE_TEST_SUITE_P(All, ZsMstmModeTest, testing::ValuesIn(kModes),
                         [](const auto& test) { return test.param.name; });

TEST_P(ZsMstmModeTest, TheSameBytesForAnyNumberOfThreadsAndRuns) {
  const auto network = MakeOrFail(File());
  const Arrays inputs = TinyInputs(3 * Window() - 2, 20, 5);
  const Arrays want = RunOrFail(*network, inputs);
  ASSERT_EQ(want.at("pose").shape, (std::vector<std::int64_t>{3 * Window() - 2, kPose}));
  for (const int threads : {1, 2, 3, 4, 8}) {
    for (int run = 0; run < 3; ++run) {
      const Arrays got = RunOrFail(*network, inputs, {.threads = threads, .least_shared_flops = 0});
      EXPECT_TRUE(SameBytes(got.at("pose").f32, want.at("pose").f32)) << threads << " threads";
      EXPECT_TRUE(SameBytes(got.at("style").f32, want.at("style").f32)) << threads << " threads";
    }
  }
}

TEST_P(ZsMstmModeTest, TheTypedWayGivesTheBytesOfTheNamedOne) {
  const FileSpec spec = File();
  const auto network = MakeOrFail(spec);
  const Arrays inputs = TinyInputs(Window(), 2 * kFrames, 6);
  const Arrays want = RunOrFail(*network, inputs);
  const auto model = ZsMstm::Make(OpenOrFail(spec), "");
  ASSERT_TRUE(model.ok()) << model.status().message();
  const auto agent = ZsMstm::NewAgent(*model);
  ASSERT_TRUE(agent.ok());
  const auto at = [&](const char* name, std::int64_t row) {
    const Array& a = inputs.at(name);
    return a.f32.data() + row * a.shape[1];
  };
  for (const std::int64_t row : {std::int64_t{0}, kFrames})
    (*agent)->AddStyleSegment(
        {at("style_speech", row), at("style_text", row), at("style_pose", row)});
  std::vector<float> pose(static_cast<std::size_t>(Window() * kPose));
  (*agent)->Generate(at("speech", 0), at("text", 0), pose.data());
  EXPECT_TRUE(SameBytes(pose, want.at("pose").f32));
  const std::vector<float>& style = want.at("style").f32;
  EXPECT_EQ(std::memcmp((*agent)->style(), style.data(), style.size() * sizeof(float)), 0);
}

TEST_P(ZsMstmModeTest, AgentsOfOneModelDoNotTouchEachOther) {
  const auto model = ZsMstm::Make(OpenOrFail(File()), "");
  ASSERT_TRUE(model.ok());
  const auto size = static_cast<std::size_t>(Window());
  const std::vector<float> text = Noise(Window() * kText, 3);
  const auto run = [&](models::ZsMstmAgent& agent, std::uint32_t seed) {
    const std::vector<float> speech = Noise(Window() * kMel, seed);
    const std::vector<float> style = Noise((*model)->config().StyleWidth(), seed + 1);
    std::vector<float> pose(size * kPose);
    agent.SetStyle(style.data());
    agent.Generate(speech.data(), text.data(), pose.data());
    return pose;
  };
  auto solo = ZsMstm::NewAgent(*model);
  std::vector<std::vector<float>> want;
  for (std::uint32_t i = 0; i < 16; ++i) want.push_back(run(**solo, i));
  std::vector<std::unique_ptr<models::ZsMstmAgent>> agents;
  for (int i = 0; i < 16; ++i) agents.push_back(*ZsMstm::NewAgent(*model));
  const std::vector<float> garbage(size * kMel, std::numeric_limits<float>::quiet_NaN());
  std::vector<float> lost(size * kPose);
  for (int round = 0; round < 3; ++round) {
    for (std::uint32_t i = 0; i < 16; ++i) {
      const std::size_t which = (i * 7 + static_cast<std::uint32_t>(round)) % 16;
      agents[5]->Generate(garbage.data(), text.data(), lost.data());
      EXPECT_TRUE(std::isnan(lost[0]));
      EXPECT_TRUE(SameBytes(run(*agents[which], static_cast<std::uint32_t>(which)), want[which]));
    }
  }
}

TEST_P(ZsMstmModeTest, APartialLastSegmentIsMovedBack) {
  const auto network = MakeOrFail(File());
  const std::int64_t total = 2 * Window() + 3;
  Arrays inputs = TinyInputs(total, kFrames, 9);
  RunReport report;
  const Arrays all = RunOrFail(*network, inputs, {}, &report);
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_NE(report.notes[0].find("the last 3 frames"), std::string::npos) << report.notes[0];
  EXPECT_EQ(report.segment_seconds.size(), 3u);
  EXPECT_EQ(report.frames, static_cast<std::size_t>(total));
  // The same frames as a stream of their own: the last window, which ends with the stream.
  for (auto [name, cols] : {std::pair("speech", kMel), std::pair("text", kText)}) {
    Array& a = inputs[name];
    a.f32.erase(a.f32.begin(), a.f32.begin() + (total - Window()) * cols);
    a.shape[0] = Window();
  }
  const Arrays last = RunOrFail(*network, inputs);
  const float* tail = all.at("pose").f32.data() + (total - 3) * kPose;
  EXPECT_EQ(std::memcmp(tail, last.at("pose").f32.data() + (Window() - 3) * kPose,
                        3 * kPose * sizeof(float)),
            0);
}

TEST_P(ZsMstmModeTest, AStreamShorterThanASegmentIsFilledUp) {
  const auto network = MakeOrFail(File());
  Arrays inputs = TinyInputs(3, kFrames, 9);
  RunReport report;
  const Arrays got = RunOrFail(*network, inputs, {}, &report);
  ASSERT_EQ(got.at("pose").shape[0], 3);
  EXPECT_NE(report.notes.at(0).find("repeated"), std::string::npos);
  for (auto [name, cols] : {std::pair("speech", kMel), std::pair("text", kText)}) {
    Array& a = inputs[name];
    while (a.shape[0] < Window()) {
      a.f32.insert(a.f32.end(), a.f32.begin() + 2 * cols, a.f32.begin() + 3 * cols);
      ++a.shape[0];
    }
  }
  const Arrays full = RunOrFail(*network, inputs);
  EXPECT_EQ(
      std::memcmp(got.at("pose").f32.data(), full.at("pose").f32.data(), 3 * kPose * sizeof(float)),
      0);
}

TEST(ZsMstmStyleTest, IsTheMeanOverTheSegmentsOfTheClip) {
  const auto network = MakeOrFail(TinyZsMstm().File());
  const Arrays clip = TinyInputs(0, 3 * kFrames, 4);
  const Array style = RunOrFail(*network, clip).at("style");
  std::vector<double> mean(style.f32.size());
  for (std::int64_t s = 0; s < 3; ++s) {
    Arrays one;
    for (const auto& [name, a] : clip) {
      Array part = models::MakeArray({kFrames, a.shape[1]});
      std::copy_n(a.f32.begin() + s * kFrames * a.shape[1], part.f32.size(), part.f32.begin());
      one[name] = part;
    }
    const Array part = RunOrFail(*network, one).at("style");
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += double{part.f32[i]} / 3;
  }
  // Three steps of a running mean round three times each, at the size of the values.
  for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(style.f32[i], mean[i], 9 * kEps * 4);
}

TEST(ZsMstmStyleTest, KeptAndGivenAgainIsTheSame) {
  const auto network = MakeOrFail(TinyZsMstm().File());
  Arrays inputs = TinyInputs(kFrames, kFrames, 4);
  const Arrays first = RunOrFail(*network, inputs);
  for (const char* name : {"style_speech", "style_text", "style_pose"}) inputs.erase(name);
  inputs["style"] = first.at("style");
  const Arrays second = RunOrFail(*network, inputs);
  EXPECT_TRUE(SameBytes(first.at("pose").f32, second.at("pose").f32));
  EXPECT_TRUE(SameBytes(first.at("style").f32, second.at("style").f32));
}

TEST(ZsMstmStyleTest, ResetForgetsEverythingEvenNan) {
  const auto model = ZsMstm::Make(OpenOrFail(TinyZsMstm().File()), "");
  ASSERT_TRUE(model.ok());
  const auto agent = *ZsMstm::NewAgent(*model), fresh = *ZsMstm::NewAgent(*model);
  const std::vector<float> speech = Noise(kFrames * kMel, 1), text = Noise(kFrames * kText, 2);
  const std::vector<float> pose = Noise(kFrames * kPose, 3);
  const std::vector<float> nan(kFrames * kMel, std::numeric_limits<float>::quiet_NaN());
  const auto width = static_cast<std::size_t>((*model)->config().StyleWidth());
  for (std::size_t i = 0; i < width; ++i) EXPECT_EQ(fresh->style()[i], 0.0f);
  agent->AddStyleSegment({nan.data(), text.data(), pose.data()});
  EXPECT_TRUE(std::isnan(agent->style()[0]));
  agent->ResetStyle();
  agent->AddStyleSegment({speech.data(), text.data(), pose.data()});
  fresh->AddStyleSegment({speech.data(), text.data(), pose.data()});
  EXPECT_EQ(std::memcmp(agent->style(), fresh->style(), width * sizeof(float)), 0);
}

// Found by tests/fuzz/weights_fuzz.cc: the columns come from a configuration that nobody has
// checked.
TEST(ZsMstmNormalisationTest, IsNotWidenedToSillyNumbersOfColumns) {
  FileSpec spec = TinyZsMstm().File();
  spec.networks[0].statistics = {{"speech", {1}, {2}}};
  const auto file = OpenOrFail(spec);
  const fb::Network& network = *file->FindNetwork("");
  const auto widened = models::ReadNormalisation(network, "speech", 1000);
  ASSERT_TRUE(widened.ok()) << widened.status().message();
  EXPECT_EQ(widened->mean.size(), 1000u);
  for (const std::int64_t columns : {std::int64_t{0}, std::int64_t{65537}, std::int64_t{1} << 40}) {
    const auto refused = models::ReadNormalisation(network, "speech", columns);
    ASSERT_FALSE(refused.ok()) << columns;
    EXPECT_NE(refused.status().message().find("columns, expected 1 to 65536"), std::string::npos)
        << refused.status().message();
  }
}

TEST(ZsMstmNormalisationTest, ScalesInputsAndUndoesTheOutput) {
  // Statistics by column on the pose: what the network gives without them, times deviation, plus
  // mean; on the speech: the same as normalised input without them.
  const FileSpec plain = TinyZsMstm().File();
  FileSpec scaled = plain;
  const std::vector<float> mean = {1, -2, 3, 0, 0.5f, 10}, deviation = {1, 2, 0.5f, 4, 1, 0.25f};
  scaled.networks[0].statistics = {{"pose", mean, deviation, 1.0f}, {"speech", {3}, {0.25f}, 2.0f}};
  const auto a = MakeOrFail(plain), b = MakeOrFail(scaled);
  Arrays inputs = TinyInputs(kFrames, 0, 4);
  inputs["style"] = models::MakeArray({17});
  inputs["style"].f32 = Noise(17, 99);
  const Arrays want = RunOrFail(*a, inputs);
  for (float& v : inputs["speech"].f32) v = v * 0.5f + 3;
  const Arrays got = RunOrFail(*b, inputs);
  for (std::size_t i = 0; i < want.at("pose").f32.size(); ++i) {
    const double expected = double{want.at("pose").f32[i]} * deviation[i % 6] + mean[i % 6];
    // x / 2 + 3 rounds at 4 and is multiplied by 2 again, through a network of about ten layers.
    EXPECT_NEAR(got.at("pose").f32[i], expected, 10 * 8 * 4 * kEps * (1 + std::fabs(expected)));
  }
}

TEST(ZsMstmTapsTest, AreNamedAndChangeNothing) {
  const auto network = MakeOrFail(TinyZsMstm().File());
  const Arrays inputs = TinyInputs(kFrames, kFrames, 4);
  const Arrays plain = RunOrFail(*network, inputs);
  RunReport report;
  const Arrays tapped = RunOrFail(*network, inputs, {.profile = true, .taps = true}, &report);
  EXPECT_TRUE(SameBytes(plain.at("pose").f32, tapped.at("pose").f32));
  for (const char* name : {"tap/content/ast/patches", "tap/content/attention", "tap/generator/z",
                           "tap/generator/decoder.1", "tap/generator/head", "tap/style/attention",
                           "tap/style/pose_lstm.1", "tap/style/h_style"})
    EXPECT_EQ(tapped.count(name), 1u) << name;
  EXPECT_EQ(plain.size(), 2u);
  EXPECT_GT(report.ops.size(), 50u);
}

// Inputs that are refused, each with one sentence that names the array.

struct InputCase {
  const char* name;
  const char* expect;
  void (*change)(Arrays& inputs);
};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

const InputCase kInputs[] = {
    {"NanInSpeech", "speech: NaN at row 1, column 2, expected finite values",
     [](Arrays& a) { a["speech"].f32[10] = kNan; }},
    {"InfinityInText", "text: infinity at row 7, column 3",
     [](Arrays& a) { a["text"].f32.back() = -kInf; }},
    {"NanInTheClip", "style_pose: NaN at row 0, column 0",
     [](Arrays& a) { a["style_pose"].f32[0] = kNan; }},
    {"OtherMel", "speech: (4, 16) float32, expected (frames, 8) float32",
     [](Arrays& a) {
       a["speech"].shape = {4, 16};
     }},
    {"OtherRank", "speech: (64,) float32", [](Arrays& a) { a["speech"].shape = {64}; }},
    {"NoFrames", "speech: (0, 8) float32",
     [](Arrays& a) {
       a["speech"].shape = {0, 8};
       a["speech"].f32.clear();
     }},
    {"Integers", "text: (8, 4) int32, expected (frames, 4) float32",
     [](Arrays& a) {
       a["text"].dtype = DType::kI32;
       a["text"].i32.resize(32);
     }},
    {"NoText", "text: missing, expected beside speech", [](Arrays& a) { a.erase("text"); }},
    {"NoSpeech", "speech: missing, expected beside text", [](Arrays& a) { a.erase("speech"); }},
    {"TextShorter", "text: 7 frames, expected those of speech, 8",
     [](Arrays& a) {
       a["text"].shape[0] = 7;
       a["text"].f32.resize(28);
     }},
    {"NoStyleAtAll", "style: missing",
     [](Arrays& a) {
       for (const char* name : {"style_speech", "style_text", "style_pose"}) a.erase(name);
     }},
    {"HalfAClip", "style_pose: missing, expected beside style_speech",
     [](Arrays& a) { a.erase("style_pose"); }},
    {"TwoStyles", "style: given twice", [](Arrays& a) { a["style"] = models::MakeArray({17}); }},
    {"StyleOfOtherWidth", "style: (16,) float32, expected (17,) float32",
     [](Arrays& a) { a["style"] = models::MakeArray({16}); }},
    {"FewerElementsThanTheShape", "speech: ", [](Arrays& a) { a["speech"].f32.resize(10); }},
    {"Nothing", "style: missing", [](Arrays& a) { a.clear(); }},
};

class ZsMstmInputTest : public testing::TestWithParam<InputCase> {};
INSTANTIATE_TEST_SUITE_P(All, ZsMstmInputTest, testing::ValuesIn(kInputs),
                         [](const auto& test) { return test.param.name; });

TEST_P(ZsMstmInputTest, IsRefusedByName) {
  const auto network = MakeOrFail(TinyZsMstm().File());
  Arrays inputs = TinyInputs(kFrames, kFrames, 4);
  GetParam().change(inputs);
  const auto outputs = network->Run(inputs, {}, nullptr);
  ASSERT_FALSE(outputs.ok());
  EXPECT_EQ(outputs.status().code(), Code::kBadInput);
  EXPECT_EQ(outputs.status().message().rfind(GetParam().expect, 0), 0u)
      << outputs.status().message();
}

TEST(ZsMstmInputsTest, ResultsThatOverflowAreAnErrorNotNan) {
  const auto network = MakeOrFail(TinyZsMstm().File());
  Arrays inputs = TinyInputs(kFrames, 0, 4);
  inputs["style"] = models::MakeArray({17});
  for (float& v : inputs["style"].f32) v = 3e38f;
  const auto outputs = network->Run(inputs, {}, nullptr);
  if (outputs.ok()) {
    for (float v : outputs->at("pose").f32) EXPECT_TRUE(std::isfinite(v));
  } else {
    EXPECT_EQ(outputs.status().code(), Code::kNonFinite) << outputs.status().message();
  }
}

TEST(ZsMstmOptionsTest, OutOfRangeIsAnError) {
  const Bytes bytes = TinyZsMstm().File().Build();
  const auto file = WeightsFile::FromMemory(bytes.data(), bytes.size(), "tiny");
  ASSERT_TRUE(file.ok());
  const auto network = models::MakeNetwork(*file, "");
  ASSERT_TRUE(network.ok());
  const Arrays inputs = TinyInputs(kFrames, kFrames, 4);
  for (const models::RunOptions& options :
       {models::RunOptions{.repeat = 0}, {.repeat = -1}, {.threads = 0}, {.threads = 65}}) {
    const auto outputs = (*network)->Run(inputs, options, nullptr);
    ASSERT_FALSE(outputs.ok());
    EXPECT_NE(outputs.status().message().find("expected 1"), std::string::npos);
  }
}

// Damage whose checksum fits: refused, or a network whose results are finite or an error.
TEST(ZsMstmDamageTest, AnyBitOfTheMetadataMayFlip) {
  Damage damage;
  FlipMetadata(TinyZsMstm().File().Build(), TinyInputs(kFrames, kFrames, 4), 17, &damage);
  EXPECT_GT(damage.ran, 10u);
  EXPECT_GT(damage.refused, 100u);
}

}  // namespace
}  // namespace gestus::test
