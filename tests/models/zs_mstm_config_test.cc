// What a ZS-MSTM 1.0 file may not say: every field out of its range, every tensor missing, of
// another shape or too many, statistics that make no sense.  Each is one sentence.
#include <gtest/gtest.h>

#include <limits>

#include "tests/models/tiny_zs_mstm.h"

namespace gestus::test {
namespace {

std::string ErrorOf(const FileSpec& spec) {
  const auto network = models::MakeNetwork(OpenOrFail(spec), "");
  EXPECT_FALSE(network.ok());
  if (network.ok()) return "accepted";
  EXPECT_NE(network.status().code(), Code::kOk);
  const std::string message = network.status().message();
  EXPECT_EQ(message.rfind("tiny: ", 0), 0u) << message;
  EXPECT_EQ(message.find("tiny: ", 1), std::string::npos) << "file is named twice: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LE(message.size(), 300u) << message;
  return message;
}

struct FieldCase {
  const char* name;
  const char* expect;
  void (*change)(TinyZsMstm& c);
};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kHuge = 0xffffffffu;

const FieldCase kFields[] = {
    {"FramesZero", "frames: 0, expected 1 to 4096", [](TinyZsMstm& c) { c.frames = 0; }},
    {"FramesHuge", "frames: 4294967295", [](TinyZsMstm& c) { c.frames = kHuge; }},
    {"FramesOther", "ast frames: 8, expected those of a segment, 9",
     [](TinyZsMstm& c) { c.frames = 9; }},
    {"TextZero", "d_text: 0", [](TinyZsMstm& c) { c.d_text = 0; }},
    {"TextHuge", "d_text: 16385", [](TinyZsMstm& c) { c.d_text = 16385; }},
    {"PoseZero", "d_pose: 0", [](TinyZsMstm& c) { c.d_pose = 0; }},
    {"PoseHuge", "d_pose: 1025", [](TinyZsMstm& c) { c.d_pose = 1025; }},
    {"WidthZero", "d_model: 0", [](TinyZsMstm& c) { c.d_model = 0; }},
    {"WidthHuge", "d_model: 4294967295", [](TinyZsMstm& c) { c.d_model = kHuge; }},
    {"LstmLayersZero", "lstm_layers: 0", [](TinyZsMstm& c) { c.lstm_layers = 0; }},
    {"LstmLayersHuge", "lstm_layers: 33", [](TinyZsMstm& c) { c.lstm_layers = 33; }},
    {"LstmHiddenZero", "lstm_hidden: 0", [](TinyZsMstm& c) { c.lstm_hidden = 0; }},
    {"LstmHiddenHuge", "lstm_hidden: 8193", [](TinyZsMstm& c) { c.lstm_hidden = 8193; }},
    {"DecoderLayersZero", "decoder_layers: 0", [](TinyZsMstm& c) { c.decoder_layers = 0; }},
    {"DecoderLayersHuge", "decoder_layers: 65", [](TinyZsMstm& c) { c.decoder_layers = 65; }},
    {"DecoderFfZero", "decoder_ff: 0", [](TinyZsMstm& c) { c.decoder_ff = 0; }},
    {"DecoderFfHuge", "decoder_ff: 65537", [](TinyZsMstm& c) { c.decoder_ff = 65537; }},
    {"DecoderHeadsZero", "decoder_heads: 0, expected a divisor of d_model = 8",
     [](TinyZsMstm& c) { c.decoder_heads = 0; }},
    {"DecoderHeadsOdd", "decoder_heads: 3", [](TinyZsMstm& c) { c.decoder_heads = 3; }},
    {"AttentionHeadsZero", "attention_heads: 0", [](TinyZsMstm& c) { c.attention_heads = 0; }},
    {"AttentionHeadsOdd", "attention_heads: 5, expected a divisor of speech + text = 12",
     [](TinyZsMstm& c) { c.attention_heads = 5; }},
    {"DecoderEpsZero", "decoder_ln_eps: 0", [](TinyZsMstm& c) { c.decoder_ln_eps = 0; }},
    {"DecoderEpsNan", "decoder_ln_eps: nan", [](TinyZsMstm& c) { c.decoder_ln_eps = kNan; }},
    {"DecoderEpsNegative", "decoder_ln_eps: -", [](TinyZsMstm& c) { c.decoder_ln_eps = -1e-5f; }},
    {"GranularityUnknown", "granularity: 2",
     [](TinyZsMstm& c) { c.granularity = static_cast<fb::Granularity>(2); }},
    {"ContextZero", "context_segments: 0", [](TinyZsMstm& c) { c.context_segments = 0; }},
    {"ContextOfFrames", "context_segments: 2, expected 1 to 1",
     [](TinyZsMstm& c) { c.context_segments = 2; }},
    {"ContextHuge", "context_segments: 65",
     [](TinyZsMstm& c) {
       c.granularity = fb::Granularity::Segment;
       c.context_segments = 65;
     }},
    {"StylePoolUnknown", "style_pool: 9",
     [](TinyZsMstm& c) { c.style_pool = static_cast<fb::StylePool>(9); }},
    {"DecoderModeUnknown", "decoder_mode: 3",
     [](TinyZsMstm& c) { c.decoder_mode = static_cast<fb::DecoderMode>(3); }},
    {"PositionsUnknown", "positions: 255",
     [](TinyZsMstm& c) { c.positions = static_cast<fb::PositionalEncoding>(255); }},
    {"PoseSourceUnknown", "pose_source: 2",
     [](TinyZsMstm& c) { c.pose_source = static_cast<fb::PoseSource>(2); }},
    {"FrameRateZero", "frame_rate: 0", [](TinyZsMstm& c) { c.frame_rate = 0; }},
    {"FrameRateNan", "frame_rate: nan", [](TinyZsMstm& c) { c.frame_rate = kNan; }},
    {"FrameRateHuge", "frame_rate: 1001", [](TinyZsMstm& c) { c.frame_rate = 1001; }},
    {"StyleAstAbsent", "ast_style: absent", [](TinyZsMstm& c) { c.with_style_ast = false; }},
    {"StyleAstOtherMel", "ast_style mel_bins: 9", [](TinyZsMstm& c) { c.style.mel_bins = 9; }},
    {"AstFramesZero", "ast_content: frames: 0", [](TinyZsMstm& c) { c.content.frames = 0; }},
    {"AstMelZero", "ast_style: mel_bins: 0", [](TinyZsMstm& c) { c.style.mel_bins = 0; }},
    {"AstPatchZero", "ast_content: patch: 0", [](TinyZsMstm& c) { c.content.patch = 0; }},
    {"AstPatchLarge", "ast_content: patch: 9, expected 1 to 8",
     [](TinyZsMstm& c) { c.content.patch = 9; }},
    {"AstStrideZero", "ast_style: stride: 0", [](TinyZsMstm& c) { c.style.stride = 0; }},
    {"AstStrideLarge", "ast_content: stride: 5, expected 1 to 4",
     [](TinyZsMstm& c) { c.content.stride = 5; }},
    {"AstWidthZero", "ast_content: d_model: 0", [](TinyZsMstm& c) { c.content.d_model = 0; }},
    {"AstLayersZero", "ast_content: layers: 0", [](TinyZsMstm& c) { c.content.layers = 0; }},
    {"AstLayersHuge", "ast_content: layers: 257", [](TinyZsMstm& c) { c.content.layers = 257; }},
    {"AstHeadsZero", "ast_content: heads: 0", [](TinyZsMstm& c) { c.content.heads = 0; }},
    {"AstHeadsOdd", "ast_content: heads: 3, expected a divisor of d_model = 8",
     [](TinyZsMstm& c) { c.content.heads = 3; }},
    {"AstMlpZero", "ast_content: d_mlp: 0", [](TinyZsMstm& c) { c.content.d_mlp = 0; }},
    {"AstPoolUnknown", "ast_content: pool: 2",
     [](TinyZsMstm& c) { c.content.pool = static_cast<fb::AstPool>(2); }},
    {"AstHeadUnknown", "ast_content: head: 3",
     [](TinyZsMstm& c) { c.content.head = static_cast<fb::AstHead>(3); }},
    {"AstOutZero", "ast_content: d_out: 0",
     [](TinyZsMstm& c) {
       c.content.head = fb::AstHead::Linear;
       c.content.d_out = 0;
     }},
    {"AstEpsOne", "ast_content: ln_eps: 1.0", [](TinyZsMstm& c) { c.content.ln_eps = 1; }},
    {"AstHeadEpsNan", "ast_content: head_ln_eps: nan",
     [](TinyZsMstm& c) { c.content.head_ln_eps = kNan; }},
};

class ZsMstmFieldTest : public testing::TestWithParam<FieldCase> {};
INSTANTIATE_TEST_SUITE_P(All, ZsMstmFieldTest, testing::ValuesIn(kFields),
                         [](const auto& test) { return test.param.name; });

TEST_P(ZsMstmFieldTest, IsNamedWhenOutOfRange) {
  // The tensors stay those of the good configuration; the field is checked before them.
  TinyZsMstm bad;
  GetParam().change(bad);
  FileSpec file = TinyZsMstm().File();
  file.networks[0].config = [&bad](flatbuffers::FlatBufferBuilder& b) { return bad.Config(b); };
  const std::string message = ErrorOf(file);
  EXPECT_NE(message.find(GetParam().expect), std::string::npos) << message;
  EXPECT_NE(message.find("network net: "), std::string::npos) << message;
}

TEST(ZsMstmTensorsTest, EveryMissingTensorIsNamed) {
  const FileSpec good = TinyZsMstm().File();
  for (std::size_t i = 0; i < good.tensors.size(); ++i) {
    FileSpec file = good;
    file.tensors.erase(file.tensors.begin() + static_cast<std::ptrdiff_t>(i));
    const std::string message = ErrorOf(file);
    EXPECT_EQ(message.rfind("tiny: tensor " + good.tensors[i].name + ": missing, expected (", 0),
              0u)
        << message;
  }
}

TEST(ZsMstmTensorsTest, EveryMisshapenTensorIsNamedWithBothShapes) {
  const FileSpec good = TinyZsMstm().File();
  for (std::size_t i = 0; i < good.tensors.size(); ++i) {
    FileSpec file = good;
    ++file.tensors[i].shape.back();
    const std::string message = ErrorOf(file);
    EXPECT_EQ(message.rfind("tiny: tensor " + good.tensors[i].name + ": (", 0), 0u) << message;
    EXPECT_NE(message.find("float32, expected ("), std::string::npos) << message;
    file = good;
    file.tensors[i].dtype = fb::DType::I32;
    EXPECT_NE(ErrorOf(file).find("int32, expected ("), std::string::npos);
  }
}

TEST(ZsMstmTensorsTest, ATensorTooManyIsNamed) {
  FileSpec file = TinyZsMstm().File();
  file.tensors.push_back({"decoder.layers.2.norm1.bias", {8}, {}});
  EXPECT_EQ(ErrorOf(file),
            "tiny: tensor decoder.layers.2.norm1.bias: not part of this network, expected none");
}

TEST(ZsMstmTensorsTest, ThePrefixSetsNetworksApart) {
  FileSpec file = TinyZsMstm().File();
  for (TensorSpec& t : file.tensors) t.name = "a." + t.name;
  file.networks[0].prefix = "a.";
  file.tensors.push_back({"b.other", {1}, {1}});
  EXPECT_NE(MakeOrFail(file), nullptr);
  file.networks[0].prefix = "b.";
  EXPECT_NE(ErrorOf(file).find("tensor b.ast_content.v.cls_token: missing"), std::string::npos);
}

TEST(ZsMstmTensorsTest, AnUnknownNetworkNameIsAnError) {
  const auto network = models::MakeNetwork(OpenOrFail(TinyZsMstm().File()), "other");
  ASSERT_FALSE(network.ok());
  EXPECT_EQ(network.status().code(), Code::kNotFound);
  EXPECT_EQ(network.status().message(), "tiny: no network called other");
}

TEST(ZsMstmStatisticsTest, AreCheckedAndNamed) {
  const auto with = [](StatisticsSpec s) {
    FileSpec file = TinyZsMstm().File();
    file.networks[0].statistics = {std::move(s)};
    return ErrorOf(file);
  };
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (const StatisticsSpec& s :
       {StatisticsSpec{"speech", {1, 2, 3}, {1, 1, 1}}, StatisticsSpec{"speech", {1}, {1, 1}},
        StatisticsSpec{"text", {}, {}}, StatisticsSpec{"pose", {0}, {0}},
        StatisticsSpec{"pose", {0}, {-1}}, StatisticsSpec{"pose", {kNan}, {1}},
        StatisticsSpec{"pose", {0}, {kInf}}, StatisticsSpec{"pose", {kInf}, {1}},
        StatisticsSpec{"text", {0}, {1}, 0}, StatisticsSpec{"text", {0}, {1}, -2},
        StatisticsSpec{"text", {0}, {1}, kNan}, StatisticsSpec{"text", {0}, {1e-40f}}}) {
    const std::string message = with(s);
    EXPECT_NE(message.find("network net: normalisation of " + s.stream + ": "), std::string::npos)
        << message;
  }
}

TEST(ZsMstmArenaTest, IsBoundedBeforeAnythingIsAllocated) {
  const auto network =
      models::MakeNetwork(OpenOrFail(TinyZsMstm().File()), "", {.max_arena_bytes = 1000});
  ASSERT_FALSE(network.ok());
  EXPECT_EQ(network.status().code(), Code::kResourceExhausted);
  EXPECT_NE(network.status().message().find("more than 1000 bytes"), std::string::npos);
}

}  // namespace
}  // namespace gestus::test
