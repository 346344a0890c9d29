// Every kind of network beside ZS-MSTM 1.0, as a golden: inputs that are refused, results that are
// not finite, files with damage, networks made without a plan.  Numbers are compared in
// golden_test.cc.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>

#include "models/run_support.h"
#include "tests/models/damage.h"
#include "tests/models/tiny_zs_mstm.h"

namespace gestus::test {
namespace {

using models::Array;
using models::Arrays;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

Bytes GoldenBytes(const std::string& name) {
  std::ifstream file(std::string(GESTUS_GOLDENS) + "/" + name + ".fb", std::ios::binary);
  Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_FALSE(bytes.empty()) << name;
  return bytes;
}

std::shared_ptr<const WeightsFile> OpenGolden(const std::string& name) {
  const Bytes bytes = GoldenBytes(name);
  const auto file = WeightsFile::FromMemory(bytes.data(), bytes.size(), name);
  EXPECT_TRUE(file.ok()) << file.status().message();
  return file.ok() ? *file : nullptr;
}

std::unique_ptr<models::Network> MakeGolden(const std::string& name,
                                            const models::NetworkOptions& options = {}) {
  auto network = models::MakeNetwork(OpenGolden(name), "", options);
  EXPECT_TRUE(network.ok()) << network.status().message();
  return network.ok() ? *std::move(network) : nullptr;
}

/// What the file itself runs its network on.
Arrays SelfTestInputs(const WeightsFile& file) {
  const fb::SelfTest& test = *file.FindNetwork("")->self_test();
  Arrays inputs;
  for (flatbuffers::uoffset_t i = 0; i < test.inputs()->size(); ++i) {
    const TensorView& view = file.Find(test.inputs()->Get(i)->string_view())->view;
    std::vector<std::int64_t> shape;
    for (int d = 0; d < view.shape.rank(); ++d) shape.push_back(view.shape[d]);
    Array a = models::MakeArray(shape, view.dtype);
    if (view.dtype == DType::kI32) std::copy_n(view.i32(), a.i32.size(), a.i32.begin());
    if (view.dtype == DType::kF32) std::copy_n(view.f32(), a.f32.size(), a.f32.begin());
    inputs[test.input_names()->Get(i)->str()] = std::move(a);
  }
  return inputs;
}

// Networks without a plan.

class UnplannedTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, UnplannedTest,
                         testing::Values("ast_cls", "autoencoder_vector", "bert_hidden",
                                         "classifier_one_layer", "discriminator_mean",
                                         "frame_autoregressive", "model1_vector", "model2_text",
                                         "zs_mstm2_autoregressive"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(UnplannedTest, TellsItsSignatureAndDoesNotRun) {
  const auto file = OpenGolden(GetParam());
  const auto planned = MakeGolden(GetParam());
  const auto unplanned = MakeGolden(GetParam(), {.plan = false});
  EXPECT_STREQ(unplanned->kind(), planned->kind());
  const models::Signature &got = unplanned->signature(), &want = planned->signature();
  ASSERT_EQ(got.inputs.size(), want.inputs.size());
  for (std::size_t i = 0; i < want.inputs.size(); ++i) {
    EXPECT_EQ(got.inputs[i].name, want.inputs[i].name);
    EXPECT_EQ(got.inputs[i].shape, want.inputs[i].shape);
  }
  EXPECT_EQ(unplanned->PlanText(), "");
  EXPECT_NE(planned->PlanText(), "");
  const Arrays inputs = SelfTestInputs(*file);
  EXPECT_TRUE(planned->Run(inputs, {}, nullptr).ok());
  for (const bool taps : {false, true}) {
    const auto outputs = unplanned->Run(inputs, {.taps = taps}, nullptr);
    ASSERT_FALSE(outputs.ok());
    EXPECT_EQ(outputs.status().code(), Code::kInvalidArgument);
    EXPECT_NE(outputs.status().message().find("made without a plan"), std::string::npos);
  }
}

TEST(UnplannedZsMstmTest, ATensorThatIsMissingIsToldAllTheSame) {
  FileSpec file = TinyZsMstm().File();
  file.tensors.pop_back();
  const auto network = models::MakeNetwork(OpenOrFail(file), "", {.plan = false});
  ASSERT_FALSE(network.ok());
  EXPECT_EQ(network.status().message().rfind("tiny: tensor head.bias: missing, ", 0), 0u)
      << network.status().message();
}

// Inputs that are refused, each with one sentence that names the array.

/// Cuts or fills up an array to `rows` rows.
void Rows(Array& a, std::int64_t rows) {
  std::int64_t row = 1;
  for (std::size_t i = 1; i < a.shape.size(); ++i) row *= a.shape[i];
  a.shape[0] = rows;
  (a.dtype == DType::kI32 ? a.i32.resize(static_cast<std::size_t>(rows * row))
                          : a.f32.resize(static_cast<std::size_t>(rows * row)));
}

/// The same rows, each with one column more.
void Widen(Array& a) {
  std::vector<std::int64_t> shape = a.shape;
  ++shape.back();
  a = models::MakeArray(shape, a.dtype);
}

Array Ids(std::vector<std::int64_t> shape, std::vector<std::int32_t> values) {
  Array a = models::MakeArray(std::move(shape), DType::kI32);
  a.i32 = std::move(values);
  return a;
}

struct InputCase {
  const char* golden;
  const char* name;
  const char* expect;
  void (*change)(Arrays& inputs);
};

const InputCase kInputs[] = {
    {"ast_cls", "Nan", "speech: NaN at row 0, column 3, expected finite values",
     [](Arrays& a) { a["speech"].f32[3] = kNan; }},
    {"ast_cls", "OtherMel", "speech: (8, 17) float32, expected (frames, 16) float32",
     [](Arrays& a) { Widen(a["speech"]); }},
    {"ast_cls", "Empty", "speech: (0, 16) float32", [](Arrays& a) { Rows(a["speech"], 0); }},
    {"ast_cls", "Missing", "speech: missing, expected log-mel", [](Arrays& a) { a.clear(); }},

    {"autoencoder_vector", "Nan", "values: NaN at row 1, column 0",
     [](Arrays& a) { a["values"].f32[9] = kNan; }},
    {"autoencoder_vector", "OtherLength",
     "values: (2, 10) float32, expected (sequences, 9) float32",
     [](Arrays& a) { Widen(a["values"]); }},
    {"autoencoder_vector", "Empty", "values: (0, 9) float32",
     [](Arrays& a) { Rows(a["values"], 0); }},
    {"autoencoder_vector", "Missing", "values: missing, expected sequences",
     [](Arrays& a) { a.clear(); }},
    {"autoencoder_decoder", "Infinity", "code: infinity at row 0, column 1",
     [](Arrays& a) { a["code"].f32[1] = kInf; }},
    {"autoencoder_decoder", "OtherWidth", "code: (2, 13) float32, expected (sequences, 12) float32",
     [](Arrays& a) { Widen(a["code"]); }},
    {"autoencoder_decoder_sequence", "OtherRank",
     "code: (2, 12) float32, expected (sequences, 9, 12) float32",
     [](Arrays& a) {
       a["code"] = models::MakeArray({2, 12});
     }},

    {"bert_hidden", "IdTooLarge", "ids: 110 at row 0, column 1, expected 0 to 109",
     [](Arrays& a) {
       a["ids"] = Ids({1, 3}, {5, 110, 7});
     }},
    {"bert_hidden", "IdNegative", "ids: -1 at row 1, column 0, expected 0 to 109",
     [](Arrays& a) {
       a["ids"] = Ids({2, 2}, {5, 6, -1, 0});
     }},
    {"bert_hidden", "IdFarNegative", "ids: -2147483648 at row 0, column 1",
     [](Arrays& a) {
       a["ids"] = Ids({1, 2}, {5, std::numeric_limits<std::int32_t>::min()});
     }},
    {"bert_hidden", "Floats", "ids: (1, 4) float32, expected (sequences, pieces) int32",
     [](Arrays& a) {
       a["ids"] = models::MakeArray({1, 4});
     }},
    {"bert_hidden", "OtherRank", "ids: (4,) int32, expected (sequences, pieces) int32",
     [](Arrays& a) {
       a["ids"] = Ids({4}, {1, 2, 3, 4});
     }},
    {"bert_hidden", "Empty", "ids: (0, 4) int32",
     [](Arrays& a) {
       a["ids"] = Ids({0, 4}, {});
     }},
    {"bert_hidden", "NoPieces", "ids: (4, 0) int32",
     [](Arrays& a) {
       a["ids"] = Ids({4, 0}, {});
     }},
    {"bert_hidden", "FewerThanTheShape", "ids: 3 elements, expected those of (2, 2)",
     [](Arrays& a) {
       a["ids"] = Ids({2, 2}, {1, 2, 3});
     }},
    {"bert_vocabulary", "IdBehindTheVocabulary", "ids: 20 at row 0, column 0, expected 0 to 19",
     [](Arrays& a) {
       a["ids"] = Ids({1, 1}, {20});
     }},
    {"bert_classifier", "SentenceTooLong",
     "ids: 11 pieces in row 1, expected at most 10 in one sentence",
     [](Arrays& a) {
       a["ids"] = Ids({2, 12}, {1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0,  //
                                1, 2, 3, 4, 5, 6, 7, 8, 9, 8, 7, 0});
     }},
    {"bert_classifier", "IdTooLarge", "ids: 110 at row 0, column 0, expected 0 to 109",
     [](Arrays& a) {
       a["ids"] = Ids({1, 2}, {110, 1});
     }},

    {"classifier_one_layer", "Nan", "motion: NaN at row 1, column 2",
     [](Arrays& a) { a["motion"].f32[8] = kNan; }},
    {"classifier_one_layer", "OtherWidth", "motion: (2, 7) float32, expected (frames, 6) float32",
     [](Arrays& a) { Widen(a["motion"]); }},
    {"classifier_one_layer", "Empty", "motion: (0, 6) float32",
     [](Arrays& a) { Rows(a["motion"], 0); }},
    {"classifier_one_layer", "Missing", "motion: missing, expected poses",
     [](Arrays& a) { a.clear(); }},

    {"discriminator_mean", "Infinity", "content: infinity at row 0, column 0",
     [](Arrays& a) { a["content"].f32[0] = -kInf; }},
    {"discriminator_mean", "OtherWidth", "content: (4, 11) float32, expected (rows, 10) float32",
     [](Arrays& a) { Widen(a["content"]); }},
    {"discriminator_mean", "Empty", "content: (0, 10) float32",
     [](Arrays& a) { Rows(a["content"], 0); }},
    {"discriminator_mean", "Missing", "content: missing, expected h_content",
     [](Arrays& a) { a.clear(); }},

    {"model1_vector", "TextOfFewerWords", "text: 3 words, expected those of f0, 4",
     [](Arrays& a) { Rows(a["text"], 3); }},
    {"model1_vector", "F0OfFewerWords", "text: 4 words, expected those of f0, 1",
     [](Arrays& a) { Rows(a["f0"], 1); }},
    {"model1_vector", "NanInF0", "f0: NaN at row 0, column 0",
     [](Arrays& a) { a["f0"].f32[0] = kNan; }},
    {"model1_vector", "F0OfOtherLength", "f0: (4, 8) float32, expected (words, 7) float32",
     [](Arrays& a) { Widen(a["f0"]); }},
    {"model1_vector", "TextOfOtherWidth", "text: (4, 6) float32, expected (words, 5) float32",
     [](Arrays& a) { Widen(a["text"]); }},
    {"model1_vector", "NoText", "text: missing, expected BERT features",
     [](Arrays& a) { a.erase("text"); }},
    {"model1_vector", "Empty", "f0: (0, 7) float32",
     [](Arrays& a) {
       Rows(a["f0"], 0);
       Rows(a["text"], 0);
     }},
    {"model1_text_rows", "TextOfOtherRank", "text: (2, 5) float32, expected (words, 3, 5) float32",
     [](Arrays& a) {
       a["text"] = models::MakeArray({2, 5});
     }},

    {"model2_text", "TextOfMoreWords", "text: 4 words, expected those of f0, 3",
     [](Arrays& a) { Rows(a["text"], 4); }},
    {"model2_text", "NanInText", "text: NaN at row 2, column 5",
     [](Arrays& a) { a["text"].f32.back() = kNan; }},
    {"model2_text", "F0OfOtherLength", "f0: (3, 6) float32, expected (words, 5) float32",
     [](Arrays& a) { Widen(a["f0"]); }},
    {"model2_text", "TextOfOtherWidth", "text: (3, 7) float32, expected (words, 6) float32",
     [](Arrays& a) { Widen(a["text"]); }},
    {"model2_text", "NoF0", "f0: missing, expected f0 of each word",
     [](Arrays& a) { a.erase("f0"); }},
    {"model2_text", "Empty", "f0: (0, 5) float32",
     [](Arrays& a) {
       Rows(a["f0"], 0);
       Rows(a["text"], 0);
     }},

    {"zs_mstm2_autoregressive", "TagsOfTwoSegments",
     "style_tags: 2 rows, expected one for each segment of the clip, 1",
     [](Arrays& a) { Rows(a["style_tags"], 2); }},
    {"zs_mstm2_autoregressive", "TagsOfTooFewSegments",
     "style_tags: 1 rows, expected one for each segment of the clip, 2",
     [](Arrays& a) {
       for (const char* name : {"style_speech", "style_text", "style_pose", "style_face"})
         Rows(a[name], 9);
     }},
    {"zs_mstm2_autoregressive", "TagsOfOtherWidth",
     "style_tags: (1, 6) float32, expected (segments, 5) float32",
     [](Arrays& a) { Widen(a["style_tags"]); }},
    {"zs_mstm2_autoregressive", "NoTags", "style_tags: missing, expected beside style_speech",
     [](Arrays& a) { a.erase("style_tags"); }},
    {"zs_mstm2_autoregressive", "NanInTags", "style_tags: NaN at row 0, column 4",
     [](Arrays& a) { a["style_tags"].f32[4] = kNan; }},
    {"zs_mstm2_autoregressive", "TagsWithoutAClip",
     "style_speech: missing, expected beside style_tags",
     [](Arrays& a) {
       for (const char* name : {"style_speech", "style_text", "style_pose", "style_face"})
         a.erase(name);
       a["style"] = models::MakeArray({27});
     }},
    {"zs_mstm2_autoregressive", "NoFace", "style_face: missing, expected beside style_speech",
     [](Arrays& a) { a.erase("style_face"); }},
    {"zs_mstm2_autoregressive", "FaceShorter",
     "style_face: 7 frames, expected those of style_speech, 8",
     [](Arrays& a) { Rows(a["style_face"], 7); }},
    {"zs_mstm2_autoregressive", "FaceOfOtherWidth",
     "style_face: (8, 5) float32, expected (frames, 4) float32",
     [](Arrays& a) { Widen(a["style_face"]); }},
    {"zs_mstm2_autoregressive", "NoStyleAtAll",
     "style: missing, expected style, or style_speech, style_text, style_face, style_tags",
     [](Arrays& a) {
       std::erase_if(a, [](const auto& x) { return x.first.rfind("style", 0) == 0; });
     }},
};

class NetworkInputTest : public testing::TestWithParam<InputCase> {};
INSTANTIATE_TEST_SUITE_P(All, NetworkInputTest, testing::ValuesIn(kInputs), [](const auto& test) {
  return std::string(test.param.golden) + "_" + test.param.name;
});

TEST_P(NetworkInputTest, IsRefusedByName) {
  const auto file = OpenGolden(GetParam().golden);
  const auto network = MakeGolden(GetParam().golden);
  Arrays inputs = SelfTestInputs(*file);
  ASSERT_TRUE(network->Run(inputs, {}, nullptr).ok());
  GetParam().change(inputs);
  const auto outputs = network->Run(inputs, {}, nullptr);
  ASSERT_FALSE(outputs.ok());
  EXPECT_EQ(outputs.status().code(), Code::kBadInput);
  EXPECT_EQ(outputs.status().message().rfind(GetParam().expect, 0), 0u)
      << outputs.status().message();
}

// Results that are not finite.

TEST(Model2NonFiniteTest, NamesTheFirstWindowThatHasNothingToChooseFrom) {
  const auto network = MakeGolden("model2_text");  // windows of three words
  Arrays inputs;
  inputs["f0"] = models::MakeArray({8, 5});
  inputs["text"] = models::MakeArray({8, 6});
  for (const float temperature : {0.0f, 1.0f}) {
    models::RunOptions options;
    options.sampling.temperature = temperature;
    std::fill(inputs["text"].f32.begin(), inputs["text"].f32.end(), 0.5f);
    EXPECT_TRUE(network->Run(inputs, options, nullptr).ok());
    // The fourth word's projection exceeds float32, which layer norm makes NaN of.
    std::fill_n(inputs["text"].f32.begin() + 3 * 6, 6, std::numeric_limits<float>::max());
    const auto outputs = network->Run(inputs, options, nullptr);
    ASSERT_FALSE(outputs.ok());
    EXPECT_EQ(outputs.status().code(), Code::kNonFinite);
    EXPECT_EQ(outputs.status().message(),
              "face: no probabilities for window 1, expected finite values");
  }
}

// Damage whose checksum fits: refused, or a network whose results are finite or an error.

struct DamageCase {
  const char* golden;
  std::size_t step;  // odd, so that every bit of a byte has its turn
};

class NetworkDamageTest : public testing::TestWithParam<DamageCase> {};
INSTANTIATE_TEST_SUITE_P(
    All, NetworkDamageTest,
    testing::Values(DamageCase{"autoencoder_vector", 1}, DamageCase{"bert_classifier", 1},
                    DamageCase{"bert_vocabulary", 1}, DamageCase{"classifier_one_layer", 1},
                    DamageCase{"discriminator_mean", 1}, DamageCase{"model1_vector", 3},
                    DamageCase{"model2_text", 7}, DamageCase{"model2_released", 7},
                    DamageCase{"zs_mstm2_autoregressive", 7}),
    [](const auto& test) { return std::string(test.param.golden); });

TEST_P(NetworkDamageTest, AnyBitOfTheMetadataMayFlip) {
  Damage damage;
  FlipMetadata(GoldenBytes(GetParam().golden), SelfTestInputs(*OpenGolden(GetParam().golden)),
               GetParam().step, &damage);
  EXPECT_GT(damage.ran, 10u);
  EXPECT_GT(damage.refused, 50u);
}

// The alternative reading that has no golden, since it changes no number: which of PATS' two arrays
// the poses were.  infer-cli info reports it (tests/cli/cli_test.py).
TEST(PoseSourceTest, EitherLoadsAndRunsTheSame) {
  const Arrays inputs = TinyInputs(8, 8, 4);
  std::vector<std::vector<float>> poses;
  for (const fb::PoseSource source : {fb::PoseSource::Normalize, fb::PoseSource::Data}) {
    TinyZsMstm c;
    c.pose_source = source;
    const auto file = OpenOrFail(c.File());
    EXPECT_EQ(file->FindNetwork("")->config_as_ZsMstm1Config()->pose_source(), source);
    const auto network = models::MakeNetwork(file, "");
    ASSERT_TRUE(network.ok()) << network.status().message();
    const auto outputs = (*network)->Run(inputs, {}, nullptr);
    ASSERT_TRUE(outputs.ok()) << outputs.status().message();
    poses.push_back(outputs->at("pose").f32);
  }
  EXPECT_EQ(poses[0], poses[1]);
}

}  // namespace
}  // namespace gestus::test
