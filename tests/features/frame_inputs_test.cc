#include "models/features/frame_inputs.h"

#include <gtest/gtest.h>

#include "models/words/frames.h"
#include "tests/features/recordings.h"

namespace gestus::features {
namespace {

// 13 pieces, more than a chunk of the golden BERT; one of them is punctuation only.
std::vector<words::Word> SomeWords() {
  return {{"word1", 0.1, 0.4},       {"word2", 0.4, 0.5},  {"no-such", 0.7, 1.2},
          {"\u2014", 1.2, 1.25},     {"word3", 1.3, 1.33}, {"word4", 1.34, 1.36},
          {"(word15),", 1.5, 2.0},   {"word6", 2.0, 2.4},  {"word7", 2.4, 2.5},
          {"word8-word9", 2.5, 2.9}, {"word10", 3.2, 3.21}};
}

models::Array Rows(std::int64_t rows, std::int64_t columns, float first = 0) {
  models::Array array;
  array.shape = {rows, columns};
  for (std::int64_t i = 0; i < rows * columns; ++i)
    array.f32.push_back(first + static_cast<float>(i));
  return array;
}

class FrameInputsTest : public testing::Test {
 protected:
  // Audio of 3.4 s (51 frames) and words.
  FrameSources Whole() {
    transcript_.words = SomeWords();
    FrameSources sources;
    sources.audio = WriteWav(folder_, "talk.wav", Voice(3.4, 8000), 8000);
    sources.transcript = &transcript_;
    sources.transcript_path = "talk.txt";
    sources.encoder = &encoder_;
    return sources;
  }
  std::unique_ptr<FrameInputs> Open(const FrameSources& sources) {
    account_ = {};
    auto inputs = FrameInputs::Open(spec_, sources, &account_);
    EXPECT_TRUE(inputs.ok()) << inputs.status().message();
    return inputs.ok() ? *std::move(inputs) : nullptr;
  }
  std::string Error(const FrameSources& sources) {
    const auto inputs = FrameInputs::Open(spec_, sources, &account_);
    return inputs.ok() ? "" : inputs.status().message();
  }
  // What a frame holds of the words, by the plan of models/words and all vectors at once.
  std::vector<float> Placed(std::size_t frames, float nothing) {
    std::vector<std::string> texts;
    for (const words::Word& word : transcript_.words)
      texts.emplace_back(words::Stripped(word.text));
    const Result<Pieces> pieces = encoder_.Encode(texts);
    EXPECT_TRUE(pieces.ok());
    std::vector<std::size_t> counts(pieces->counts.begin(), pieces->counts.end()), first = {0};
    for (const std::size_t count : counts) first.push_back(first.back() + count);
    const auto plan = words::PlaceOnFrames(transcript_.words, counts, {.frames = frames});
    EXPECT_TRUE(plan.ok());
    std::vector<float> want;
    for (const words::FramePiece& at : plan->frames) {
      const std::size_t row = at.word < 0 ? 0
                                          : first[static_cast<std::size_t>(at.word)] +
                                                static_cast<std::size_t>(at.piece);
      for (std::size_t i = 0; i < 16; ++i)
        want.push_back(at.word < 0 ? nothing : pieces->rows[row * 16 + i]);
    }
    return want;
  }

  TempFolder folder_;
  FeatureSpec spec_ = FramesSpec();
  words::Transcript transcript_;
  WordEncoder encoder_ = GoldenEncoder();
  Account account_;
};

TEST_F(FrameInputsTest, WordsLieOnFramesAsInPats) {
  const auto inputs = Open(Whole());
  EXPECT_EQ(inputs->total(), 51);
  EXPECT_EQ(inputs->unit(), 8);
  const models::Arrays arrays = ReadAll(inputs.get());
  EXPECT_EQ(arrays.at("speech").shape, (std::vector<std::int64_t>{51, 10}));
  EXPECT_EQ(arrays.at("text").shape, (std::vector<std::int64_t>{51, 16}));
  EXPECT_EQ(arrays.at("text").f32, Placed(51, 0));
  EXPECT_TRUE(Says(account_.used, "talk.wav: 3.40 s, 8000 Hz -> speech, 51 frames"));
  EXPECT_TRUE(Says(account_.used, "11 words -> text, by the BERT"));
}

TEST_F(FrameInputsTest, StretchesOfAnySizeMakeTheWhole) {
  const models::Arrays whole = ReadAll(Open(Whole()).get());
  for (const std::vector<std::int64_t>& sizes :
       {std::vector<std::int64_t>{1}, {8}, {16, 3}, {50, 1}, {7, 30, 1}}) {
    const models::Arrays pieces = ReadAll(Open(Whole()).get(), sizes);
    for (const char* name : {"speech", "text"}) {
      EXPECT_EQ(pieces.at(name).shape, whole.at(name).shape);
      EXPECT_EQ(pieces.at(name).f32, whole.at(name).f32) << name << " by " << sizes[0];
    }
  }
}

TEST_F(FrameInputsTest, WordsAlone) {
  FrameSources sources = Whole();
  sources.audio.clear();
  spec_.absent_speech.assign(10, -4.5f);
  const auto inputs = Open(sources);
  EXPECT_EQ(inputs->total(), 49);  // 3.21 s, the last frame begun
  const models::Arrays arrays = ReadAll(inputs.get(), {20});
  EXPECT_EQ(arrays.at("speech").f32, std::vector<float>(490, -4.5f));
  EXPECT_EQ(arrays.at("text").f32, Placed(49, 0));
  EXPECT_TRUE(Says(account_.notes, "speech: no recording, the mean of its statistics"));
}

TEST_F(FrameInputsTest, SpeechAlone) {
  FrameSources sources;
  sources.audio = Whole().audio;
  for (const bool mean : {true, false}) {
    spec_.absent_text.assign(mean ? 16 : 0, 2.5f);
    const models::Arrays arrays = ReadAll(Open(sources).get());
    EXPECT_EQ(arrays.at("text").f32, std::vector<float>(51 * 16, mean ? 2.5f : 0.0f));
    EXPECT_TRUE(Says(account_.notes, mean ? "text: no words, the mean of its statistics"
                                          : "text: no words, zeros stand for it"));
  }
}

TEST_F(FrameInputsTest, WordsThatCannotBeUsedAreTold) {
  FrameSources sources = Whole();
  sources.encoder = nullptr;
  EXPECT_EQ(ReadAll(Open(sources).get()).at("text").f32, std::vector<float>(51 * 16));
  EXPECT_TRUE(Says(account_.notes, "text: the weights file has no BERT for the words, zeros"));
  transcript_.words.clear();
  Open(sources);
  EXPECT_TRUE(Says(account_.notes, "text: the transcript has no words, zeros"));
}

TEST_F(FrameInputsTest, WordsBehindTheRecordingAreLeftOut) {
  FrameSources sources = Whole();
  transcript_.words.push_back({"word5", 100, 101});
  EXPECT_EQ(ReadAll(Open(sources).get()).at("text").f32, Placed(51, 0));
  EXPECT_TRUE(Says(account_.notes, "outside"));
  transcript_.words = {{"word5", 100, 101}};
  spec_.absent_text.assign(16, 7.0f);
  EXPECT_EQ(ReadAll(Open(sources).get()).at("text").f32, std::vector<float>(51 * 16, 7.0f));
}

TEST_F(FrameInputsTest, ReadyArraysComeFirst) {
  FrameSources sources = Whole();
  sources.arrays["text"] = Rows(51, 16);
  models::Arrays arrays = ReadAll(Open(sources).get(), {8});
  EXPECT_EQ(arrays.at("text").f32, Rows(51, 16).f32);
  EXPECT_TRUE(Says(account_.notes, "talk.txt was not used, text is there already"));
  sources = Whole();
  sources.arrays["speech"] = Rows(40, 10);
  arrays = ReadAll(Open(sources).get(), {9});
  EXPECT_EQ(arrays.at("speech").f32, Rows(40, 10).f32);
  EXPECT_EQ(arrays.at("text").f32, Placed(40, 0));
  EXPECT_TRUE(Says(account_.notes, "talk.wav was not used, speech is there already"));
}

TEST_F(FrameInputsTest, ArraysThatDoNotFitAreRefused) {
  FrameSources sources = Whole();
  sources.arrays_path = "in.npz";
  sources.arrays["text"] = Rows(50, 16);
  EXPECT_EQ(Error(sources), "in.npz: text: 50 frames, expected 51");
  sources.arrays["text"] = Rows(51, 15);
  EXPECT_NE(Error(sources).find("in.npz: text: (51, 15) float32, expected (frames, 16)"),
            std::string::npos)
      << Error(sources);
  sources.arrays.clear();
  sources.arrays["speech"] = Rows(51, 16);
  EXPECT_NE(Error(sources).find("in.npz: speech: (51, 16) float32, expected (frames, 10)"),
            std::string::npos)
      << Error(sources);
}

TEST_F(FrameInputsTest, SomethingMustBeThere) {
  EXPECT_EQ(Error({}), "input: no recording, expected a recording or words");
  FrameSources sources = Whole();
  sources.audio.clear();
  sources.encoder = nullptr;
  EXPECT_EQ(Error(sources),
            "talk.txt: the weights file has no BERT for the words, expected a recording");
  sources.frames = 12;  // as the poses of a style have it
  EXPECT_EQ(Open(sources)->total(), 12);
  sources.frames = 0;
  transcript_.words.clear();
  EXPECT_EQ(Error(sources), "talk.txt: no words, expected a recording or words");
}

TEST_F(FrameInputsTest, ATranscriptOfYearsIsRefused) {
  FrameSources sources = Whole();
  sources.audio.clear();
  transcript_.words.push_back({"word1", 9e6, 9.1e6});
  EXPECT_EQ(Error(sources),
            "talk.txt: the last word ends after 2528 hours, expected at most 100 without a "
            "recording");
}

TEST_F(FrameInputsTest, ANetworkWithoutTextSaysSo) {
  spec_.d_text = 0;
  FrameSources sources = Whole();
  EXPECT_EQ(ReadAll(Open(sources).get()).count("text"), 0u);
  EXPECT_TRUE(Says(account_.notes, "talk.txt was not used: the network takes no text"));
  sources.audio.clear();
  EXPECT_EQ(Error(sources), "talk.txt: no recording, expected a recording");
}

}  // namespace
}  // namespace gestus::features
