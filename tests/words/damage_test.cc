// Damaged and hostile files: truncated at every byte, mutated, very long.  What counts is that each
// gives words in order or one line; under the sanitizers, also that nothing else happens.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "models/words/utf8.h"
#include "tests/words/samples.h"

namespace gestus::words {
namespace {

void ExpectSane(std::string_view bytes, const std::string& what) {
  // Exactly as large as the file, so that a sanitizer sees a byte read past its end.
  const std::vector<char> exact(bytes.begin(), bytes.end());
  const Result<Transcript> transcript =
      ParseTranscript(std::string_view(exact.data(), exact.size()), "t");
  if (!transcript.ok()) {
    const std::string& message = transcript.status().message();
    ASSERT_TRUE(message.starts_with("t: ")) << what << ": " << message;
    ASSERT_LT(message.size(), 400u) << what;
    return;
  }
  double before = 0;
  std::size_t replaced = 0;
  for (const Word& word : transcript->words) {
    ASSERT_TRUE(word.start >= before && word.end >= word.start && std::isfinite(word.end)) << what;
    ASSERT_FALSE(word.text.empty()) << what;
    RepairUtf8(word.text, &replaced);
    ASSERT_EQ(replaced, 0u) << what;
    before = word.end;
  }
}

TEST(DamageTest, TruncatedAnywhere) {
  for (const Sample& sample : Samples()) {
    for (std::size_t size = 0; size <= sample.bytes.size(); ++size) {
      const std::string what = sample.name + ", " + std::to_string(size) + " bytes";
      ASSERT_NO_FATAL_FAILURE(ExpectSane(sample.bytes.substr(0, size), what));
    }
  }
}

TEST(DamageTest, MutatedAnyhow) {
  std::mt19937 random(20110601);
  const char* const pieces[] = {
      "\"",  "\\",           "{",  "}",   "[",     "]",  ",",   ":",    "<",    ">",
      "-->", "\n\n",         "\r", "\t",  "1e308", "-1", "NaN", "null", "\xFF", "\xF0\x9F",
      "\0",  "999999999999", " ",  "&#0;"};
  for (int round = 0; round < 60000; ++round) {
    const Sample& sample = Samples()[random() % Samples().size()];
    std::string bytes = sample.bytes;
    for (unsigned i = 0, n = 1 + random() % 4; i < n && !bytes.empty(); ++i) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 4) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.erase(at, 1 + random() % 8);
          break;
        case 2:
          bytes.insert(at, pieces[random() % std::size(pieces)]);
          break;
        default:
          bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 64));
      }
    }
    ASSERT_NO_FATAL_FAILURE(ExpectSane(bytes, sample.name + ", round " + std::to_string(round)));
  }
}

// A file of many words is made of the same words again and again; were any step quadratic, this
// would take hours.
TEST(DamageTest, HasNoQuadraticSteps) {
  const std::size_t n = 200000;
  std::string json = "{\"segments\": [{\"words\": [{\"word\": \"a\", \"start\": 1, \"end\": 2}",
              lines, vtt = "WEBVTT\n\n00:01.000 --> 00:02.000\n", csv = "word,start,end\n";
  for (std::size_t i = 0; i < n; ++i) {
    const std::string start = std::to_string(i) + ".25", end = std::to_string(i) + ".75";
    json += ", {\"word\": \"w\"}";
    lines += start + " " + end + " w\n";
    vtt += "w<";
    csv += "w," + start + "," + end + "\n";
  }
  for (const std::string& bytes : {json + "]}]}", lines, csv}) {
    const Result<Transcript> transcript = ParseTranscript(bytes, "t");
    ASSERT_TRUE(transcript.ok()) << transcript.status().message();
    EXPECT_GE(transcript->words.size(), n);
  }
  EXPECT_TRUE(ParseTranscript(vtt, "t").ok());
  const std::size_t long_file = std::size_t{4} << 20;
  for (const std::string start :
       {"{", "[", "[[", "\"", "\"a\t", "<", "WEBVTT\n\n00:01.000 --> 00:02.000\n<", "&", "a,", "1 ",
        "\n", "\xFF", "ooTextFile \"", "0 1 [", "0 1 ["}) {
    std::string bytes = start;
    while (bytes.size() < long_file) bytes += start.back();
    ExpectSane(bytes, start);
  }
  // One word of a megabyte.
  const std::string word(1 << 20, 'w');
  EXPECT_EQ(ShowBytes("1 2 " + word), word + " 1.00-2.00");
}

TEST(DamageTest, BoundsTheNumberOfWords) {
  std::string bytes = "0 1 ";
  for (int i = 0; i < 4'000'001; ++i) bytes += "w ";
  EXPECT_EQ(ShowBytes(bytes), "t: has more words than expected, at most 4,000,000");
  EXPECT_EQ(ShowBytes(std::string(kMaxTranscriptBytes + 1, ' ')),
            "t: has more than 64 MiB, expected a transcript");
}

}  // namespace
}  // namespace gestus::words
