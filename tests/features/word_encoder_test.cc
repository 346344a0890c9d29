#include "models/features/word_encoder.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "weights_generated.h"

namespace gestus::features {
namespace {

// Of the golden's vocabulary: "word0" is token 3; 10 pieces fit a chunk.
constexpr std::int32_t kFirst = 3;

std::shared_ptr<const WeightsFile> Golden(const std::string& name) {
  auto file = WeightsFile::Open(std::string(GESTUS_GOLDENS) + "/" + name + ".fb");
  EXPECT_TRUE(file.ok()) << file.status().message();
  return *file;
}

std::string OnlyName(const WeightsFile& file) {
  const TextNetworks found = FindTextNetworks(file);
  return found.encoder;
}

Result<WordEncoder> Encoder() {
  const auto file = Golden("bert_vocabulary");
  auto network = TokenNetwork::Make(file, OnlyName(*file), {});
  if (!network.ok()) return network.status();
  return WordEncoder(*std::move(network));
}

// What the network itself makes of the ids.
std::vector<float> Hidden(const std::vector<std::int32_t>& ids) {
  const auto file = Golden("bert_vocabulary");
  auto network = models::MakeNetwork(file, "");
  EXPECT_TRUE(network.ok());
  models::Array array;
  array.dtype = DType::kI32;
  array.shape = {1, static_cast<std::int64_t>(ids.size())};
  array.i32 = ids;
  auto outputs = (*network)->Run({{"ids", array}}, {}, nullptr);
  EXPECT_TRUE(outputs.ok()) << outputs.status().message();
  return outputs->at("hidden").f32;
}

TEST(WordEncoderTest, GivesTheHiddenStatesOfEachWord) {
  Result<WordEncoder> encoder = Encoder();
  ASSERT_TRUE(encoder.ok()) << encoder.status().message();
  const Result<Pieces> pieces = encoder->Encode({"word4", " ", "word0 word7", "no-such"});
  ASSERT_TRUE(pieces.ok()) << pieces.status().message();
  EXPECT_EQ(pieces->counts, (std::vector<std::int64_t>{1, 0, 2, 3}));
  EXPECT_EQ(pieces->rows, Hidden({kFirst + 4, kFirst, kFirst + 7, 1, 1, 1}));
}

TEST(WordEncoderTest, MeansAreOfEachWordsPieces) {
  Pieces pieces{{1, 0, 2}, 2, {1, 2, 3, 4, 5, 8}};
  EXPECT_EQ(pieces.WordMeans(), (std::vector<float>{1, 2, 0, 0, 4, 6}));
}

TEST(WordEncoderTest, ALongTranscriptRunsInChunksInAnyOrder) {
  Result<WordEncoder> encoder = Encoder();
  ASSERT_TRUE(encoder.ok());
  std::vector<std::string> words;
  std::vector<std::int32_t> ids;
  for (std::int32_t i = 0; i < 23; ++i) {
    words.push_back("word" + std::to_string(i % 16));
    ids.push_back(kFirst + i % 16);
  }
  const std::vector<float> want = Hidden(ids);  // which runs in the same chunks
  const Result<Pieces> pieces = encoder->Encode(words);
  ASSERT_TRUE(pieces.ok());
  EXPECT_EQ(pieces->rows, want);
  PieceRows rows(&*encoder, words);
  const auto width = static_cast<std::size_t>(encoder->width());
  for (const std::int64_t piece : {22, 0, 9, 10, 19, 20, 3}) {
    const Result<const float*> row = rows.Row(piece);
    ASSERT_TRUE(row.ok());
    const auto* expected = want.data() + static_cast<std::size_t>(piece) * width;
    EXPECT_EQ(std::vector<float>(*row, *row + width),
              std::vector<float>(expected, expected + width));
  }
}

TEST(WordEncoderTest, NoWordsGiveNoRows) {
  Result<WordEncoder> encoder = Encoder();
  ASSERT_TRUE(encoder.ok());
  const Result<Pieces> pieces = encoder->Encode({});
  ASSERT_TRUE(pieces.ok());
  EXPECT_TRUE(pieces->rows.empty());
}

TEST(TextNetworksTest, WithoutAVocabularyNothingIsFound) {
  const TextNetworks found = FindTextNetworks(*Golden("bert_hidden"));
  EXPECT_TRUE(found.encoder.empty());
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("has no vocabulary"), std::string::npos);
  const auto file = Golden("bert_hidden");
  const auto made = TokenNetwork::Make(file, file->FindNetwork("")->name()->str(), {});
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.status().message().find("no vocabulary, expected the tensor"), std::string::npos);
}

}  // namespace
}  // namespace gestus::features
