#include "models/features/word_inputs.h"

#include <gtest/gtest.h>

#include "models/prosody/contour.h"
#include "tests/features/recordings.h"

namespace gestus::features {
namespace {

// Two units; in the first a comma of 0.1 s, and between 2.0 and 2.005 no silence worth one.
std::vector<words::Word> SomeWords() {
  return {{"word1", 0.1, 0.5},
          {"(word2),", 0.6, 1.0},
          {"no-such", 1.0, 2.0},
          {"word3", 2.005, 2.2},
          {"word4", 2.6, 2.9}};
}

class WordInputsTest : public testing::Test {
 protected:
  WordInputsTest() {
    spec_.layout = Layout::kWords;
    spec_.d_text = 16;
    spec_.f0_length = 50;
    spec_.pitch_sample_rate = 8000;
    transcript_.words = SomeWords();
  }
  WordSources Whole() {
    WordSources sources;
    sources.audio = WriteWav(folder_, "talk.wav", Voice(3.2, 8000), 8000);
    sources.transcript = &transcript_;
    sources.transcript_path = "talk.txt";
    sources.encoder = &encoder_;
    return sources;
  }
  std::unique_ptr<WordInputs> Open(const WordSources& sources) {
    account_ = {};
    auto inputs = WordInputs::Open(spec_, sources, &account_);
    EXPECT_TRUE(inputs.ok()) << inputs.status().message();
    return inputs.ok() ? *std::move(inputs) : nullptr;
  }
  std::string Error(const WordSources& sources) {
    const auto inputs = WordInputs::Open(spec_, sources, &account_);
    return inputs.ok() ? "" : inputs.status().message();
  }
  // f0 of spans of time, by models/prosody.
  std::vector<float> F0(const std::vector<prosody::WordSpan>& spans, std::size_t rows) {
    const Result<Pitch> pitch = ReadPitch(Whole().audio, spec_);
    prosody::ContourOptions options;
    options.values = static_cast<std::size_t>(spec_.f0_length);
    auto contours = prosody::ContoursOfWords(pitch->f0.data(), pitch->f0.size(), 1, spans, options);
    EXPECT_TRUE(contours.ok());
    contours->hz.resize(rows * options.values);
    return contours->hz;
  }

  TempFolder folder_;
  FeatureSpec spec_;
  words::Transcript transcript_;
  WordEncoder encoder_ = GoldenEncoder();
  Account account_;
};

std::vector<float> Joined(std::vector<float> a, const std::vector<float>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST_F(WordInputsTest, EveryWordOfAUnitIsARowAndSoIsAShortSilence) {
  const auto inputs = Open(Whole());
  EXPECT_EQ(inputs->total(), 6);
  const models::Arrays arrays = ReadAll(inputs.get(), {4, 1});
  EXPECT_EQ(arrays.at("f0").shape, (std::vector<std::int64_t>{6, 50}));
  EXPECT_EQ(arrays.at("f0").f32,
            F0({{0.1, 0.5}, {0, 0}, {0.6, 1.0}, {1.0, 2.0}, {2.005, 2.2}, {2.6, 2.9}}, 6));
  EXPECT_GT(arrays.at("f0").f32[20], 80);  // Hz
  // The words of a unit see one another, and those of the next do not; pieces are averaged.
  EXPECT_EQ(arrays.at("text").f32,
            Joined(MeansOf({"word1", ",", "word2", "no-such", "word3"}), MeansOf({"word4"})));
  EXPECT_TRUE(Says(account_.used, "talk.txt: "));
  EXPECT_TRUE(Says(account_.used, "6 items in 2 inter-pausal units, text by the BERT"));
  EXPECT_TRUE(Says(account_.notes, "f0: 1 of 5 words last longer than 50 values and were cut"));
}

TEST_F(WordInputsTest, TimesStandBeside) {
  const models::Arrays beside = Open(Whole())->Beside();
  EXPECT_EQ(beside.at("times_ms").shape, (std::vector<std::int64_t>{6, 2}));
  EXPECT_EQ(beside.at("times_ms").i32,
            (std::vector<std::int32_t>{100, 500, 500, 600, 600, 1000, 1000, 2000, 2005, 2200, 2600,
                                       2900}));
}

TEST_F(WordInputsTest, WindowsAreFilledUpWithZeros) {
  spec_.layout = Layout::kWindows;
  spec_.max_words = 4;
  const auto inputs = Open(Whole());
  EXPECT_EQ(inputs->total(), 3);
  EXPECT_EQ(inputs->Beside().at("times_ms").i32,
            (std::vector<std::int32_t>{100, 2000, 2005, 2200, 2600, 2900}));
  const models::Arrays arrays = ReadAll(inputs.get(), {2});
  const std::vector<float> unit = MeansOf({"word1", ",", "word2", "no-such", "word3"});
  std::vector<float> text(unit.begin(), unit.begin() + 4 * 16);
  text.insert(text.end(), unit.begin() + 4 * 16, unit.end());
  text.resize(8 * 16);
  text = Joined(text, MeansOf({"word4"}));
  text.resize(12 * 16);
  EXPECT_EQ(arrays.at("text").shape, (std::vector<std::int64_t>{12, 16}));
  EXPECT_EQ(arrays.at("text").f32, text);
  EXPECT_EQ(arrays.at("f0").f32, Joined(Joined(F0({{0.1, 0.5}, {0, 0}, {0.6, 1.0}, {1.0, 2.0}}, 4),
                                               F0({{2.005, 2.2}}, 4)),
                                        F0({{2.6, 2.9}}, 4)));
  EXPECT_TRUE(Says(account_.used, "in 2 inter-pausal units"));
}

TEST_F(WordInputsTest, AWindowBeginsAndEndsWithAWord) {
  spec_.layout = Layout::kWindows;
  for (const std::int64_t words : {1, 2}) {  // the comma would begin, or end, a window
    spec_.max_words = words;
    const std::vector<std::int32_t> times = Open(Whole())->Beside().at("times_ms").i32;
    EXPECT_EQ(times[0], 100);
    EXPECT_EQ(times[1], 500);
    EXPECT_EQ(times[2], 600);
  }
}

TEST_F(WordInputsTest, AnyPiecesGiveTheSameRows) {
  for (const Layout layout : {Layout::kWords, Layout::kWindows}) {
    spec_.layout = layout;
    spec_.max_words = 2;
    const models::Arrays whole = ReadAll(Open(Whole()).get());
    for (const std::vector<std::int64_t>& sizes : {std::vector<std::int64_t>{1}, {3, 1}}) {
      const models::Arrays pieces = ReadAll(Open(Whole()).get(), sizes);
      EXPECT_EQ(pieces.at("f0").f32, whole.at("f0").f32);
      EXPECT_EQ(pieces.at("text").f32, whole.at("text").f32);
    }
  }
}

TEST_F(WordInputsTest, WithoutWordsTheRecordingIsCutEvenly) {
  WordSources sources = Whole();
  sources.transcript = nullptr;
  const auto inputs = Open(sources);
  EXPECT_EQ(inputs->total(), 7);  // 3.2 s in words of 0.5 s
  EXPECT_EQ(inputs->Beside().at("times_ms").i32.back(), 3200);
  const models::Arrays arrays = ReadAll(inputs.get());
  EXPECT_EQ(arrays.at("text").f32, std::vector<float>(7 * 16));
  std::vector<prosody::WordSpan> spans;
  for (int i = 0; i < 7; ++i) spans.push_back({0.5 * i, std::min(3.2, 0.5 * i + 0.5)});
  EXPECT_EQ(arrays.at("f0").f32, F0(spans, 7));
  EXPECT_TRUE(Says(account_.notes, "text: no words, zeros stand for them"));
  spec_.layout = Layout::kWindows;
  spec_.max_words = 4;
  EXPECT_EQ(Open(sources)->total(), 2);
  transcript_.words.clear();
  EXPECT_EQ(Open(Whole())->total(), 2);
}

TEST_F(WordInputsTest, WithoutARecordingNothingIsVoiced) {
  WordSources sources = Whole();
  sources.audio.clear();
  const models::Arrays arrays = ReadAll(Open(sources).get());
  EXPECT_EQ(arrays.at("f0").f32, std::vector<float>(6 * 50));
  EXPECT_TRUE(Says(account_.notes, "f0: no recording, every word counts as unvoiced"));
}

TEST_F(WordInputsTest, ReadyArraysComeFirst) {
  WordSources sources = Whole();
  models::Array f0, text;
  f0.shape = {6, 50};
  text.shape = {6, 16};
  for (int i = 0; i < 300; ++i) f0.f32.push_back(static_cast<float>(i));
  for (int i = 0; i < 96; ++i) text.f32.push_back(static_cast<float>(-i));
  sources.arrays = {{"f0", f0}, {"text", text}};
  sources.arrays_path = "in.npz";
  sources.encoder = nullptr;
  const models::Arrays arrays = ReadAll(Open(sources).get(), {4, 1});
  EXPECT_EQ(arrays.at("f0").f32, f0.f32);
  EXPECT_EQ(arrays.at("text").f32, text.f32);
  EXPECT_TRUE(Says(account_.notes, "talk.wav was not used, f0 is there already"));
  EXPECT_FALSE(Says(account_.notes, "no BERT"));
  sources.arrays["text"].shape = {5, 16};
  sources.arrays["text"].f32.resize(80);
  EXPECT_EQ(Error(sources), "in.npz: text: (5, 16) float32, expected (6, 16) float32");
}

TEST_F(WordInputsTest, WordsBehindTheRecordingHaveNoPitch) {
  transcript_.words.push_back({"word5", 50, 50.4});
  const models::Arrays arrays = ReadAll(Open(Whole()).get());
  const std::vector<float>& f0 = arrays.at("f0").f32;
  EXPECT_EQ(std::vector<float>(f0.end() - 50, f0.end()), std::vector<float>(50));
  EXPECT_TRUE(Says(account_.notes, "f0: 1 of 6 words begin behind the end of the recording"));
}

TEST_F(WordInputsTest, SomethingMustBeThere) {
  EXPECT_EQ(Error({}), "input: neither a recording nor words, expected one of them");
  WordSources sources = Whole();
  sources.encoder = nullptr;
  EXPECT_EQ(ReadAll(Open(sources).get()).at("text").f32, std::vector<float>(6 * 16));
  EXPECT_TRUE(Says(account_.notes, "text: the weights file has no BERT for the words, zeros"));
  sources.audio.clear();
  EXPECT_EQ(Error(sources),
            "talk.txt: the weights file has no BERT for the words, expected a recording");
  spec_.text_rows = 2;
  EXPECT_NE(Error(Whole()).find("text: the network takes 2 rows of each word"), std::string::npos);
}

}  // namespace
}  // namespace gestus::features
