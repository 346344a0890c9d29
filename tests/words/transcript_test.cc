// Each format as its tools write it, and what a transcript does about oddities.
#include "models/words/transcript.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/words/samples.h"

namespace gestus::words {
namespace {

TEST(TranscriptTest, ReadsEveryFormat) {
  for (const Sample& sample : Samples()) {
    const Result<Transcript> transcript = ParseTranscript(sample.bytes, "t");
    ASSERT_TRUE(transcript.ok()) << sample.name << ": " << transcript.status().message();
    EXPECT_EQ(transcript->format, sample.format) << sample.name;
    EXPECT_EQ(Show(transcript->words), sample.words) << sample.name;
  }
}

TEST(TranscriptTest, TakesAByteOrderMark) {
  for (const Sample& sample : Samples()) {
    if ((sample.bytes[0] & 0x80) != 0) continue;  // it has one
    EXPECT_EQ(ShowBytes("\xEF\xBB\xBF" + sample.bytes), sample.words) << sample.name;
  }
}

TEST(TranscriptTest, KeepsEmptyOnesEmpty) {
  for (const std::string bytes :
       {"", " \n", "\xEF\xBB\xBF", "[]", R"({"transcription": []})",
        R"({"text": "", "segments": [], "language": "en"})", R"({"results": []})",
        R"({"transcript": "", "words": []})", R"({"words": []})", "WEBVTT\n", "WEBVTT",
        "Word,Start,End\n", "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n0 1 <absent>",
        "1\n00:00:01,000 --> 00:00:02,000\n\n"}) {
    const Result<Transcript> transcript = ParseTranscript(bytes, "t");
    ASSERT_TRUE(transcript.ok()) << bytes << ": " << transcript.status().message();
    EXPECT_TRUE(transcript->words.empty()) << bytes;
  }
}

TEST(TranscriptTest, KeepsTheBytesOfWords) {
  // Emoji with joiners and a variation selector, right to left, combining marks, a NUL.
  for (const std::string& word :
       {std::string("\U0001F468\u200D\U0001F469\u200D\U0001F467"), std::string("\u2764\uFE0F"),
        std::string("\u0645\u0631\u062D\u0628\u0627"), std::string("cafe\u0301\u0323"),
        std::string("\u5B66\u4E60"), std::string("\u00A320")}) {
    EXPECT_EQ(ShowBytes("0.5 1 " + word), word + " 0.50-1.00");
    EXPECT_EQ(ShowBytes("[{\"word\": \"" + word + "\", \"start\": 0.5, \"end\": 1}]"),
              word + " 0.50-1.00");
  }
  EXPECT_EQ(ShowBytes(R"([{"word": "\ud83d\udc4d", "start": 0, "end": 1}])"),
            "\U0001F44D 0.00-1.00");
}

TEST(TranscriptTest, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(ShowBytes("0.5 1 caf\xE9"), "caf\uFFFD 0.50-1.00");
  EXPECT_EQ(Notes("0.5 1 caf\xE9"), "1 byte of the words is not UTF-8 and became U+FFFD");
  EXPECT_EQ(ShowBytes("[{\"word\": \"caf\xE9\", \"start\": 0, \"end\": 1}]"),
            "caf\uFFFD 0.00-1.00");
  // whisper.cpp cuts tokens within characters.
  const std::string tokens =
      "{\"transcription\": [{\"text\": \" a\", \"tokens\": ["
      "{\"text\": \" \xF0\x9F\", \"offsets\": {\"from\": 0, \"to\": 100}},"
      "{\"text\": \"\x91\x8D\", \"offsets\": {\"from\": 100, \"to\": 200}}]}]}";
  EXPECT_EQ(ShowBytes(tokens), "\U0001F44D 0.00-0.20");
  EXPECT_EQ(Notes(tokens), "");
}

TEST(TranscriptTest, MendsTimes) {
  EXPECT_EQ(ShowBytes("-0.2 0.5 a\n1 0.8 b\n2 3 c"), "a 0.00-0.50, b 1.00-1.30*, c 2.00-3.00");
  EXPECT_EQ(Notes("-0.2 0.5 a\n1 0.8 b\n2 3 c"),
            "1 time before 0 s, the first -0.20 s; set to 0 s | 1 word ends before it starts, the "
            "first at 1.00 s; the ends were filled in | 1 word has no time of its own, the first "
            "at 1.00 s; filled in by length");
  EXPECT_EQ(ShowBytes("3 4 c\n1 2.5 a\n2 3 b\n1 1.5 d"),
            "a 1.00-1.00, d 1.00-1.50, b 2.00-3.00, c 3.00-4.00");
  EXPECT_EQ(Notes("3 4 c\n1 2.5 a\n2 3 b\n1 1.5 d"),
            "2 words start before the ones in front of them, the first at 1.00 s; all were sorted "
            "by time | 1 word overlaps the next one, the first at 1.00 s; cut short");
  // Rounding is not worth a note.
  EXPECT_EQ(Notes("1 2.0005 a\n2 3 b"), "");
  EXPECT_EQ(ShowBytes("0.1 0.5 a\n1e308 1e308 b"),
            "t: word 2: has the time 1e+308 s, expected at most 10,000,000 s");
}

TEST(TranscriptTest, RefusesTimesThatAreNone) {
  for (const std::string time : {"inf", "-inf", "0x10", "1e", "1.2.3", "1:2:3:4", "1e999"}) {
    EXPECT_EQ(ShowBytes("word,start,end\na,0,1\nb," + time + ",2\n"),
              "t: line 3: '" + time + "', expected a time, the start of a word");
    EXPECT_EQ(ShowBytes("0.5 1 a\n" + time + " 2 b"),
              "t: line 2: '" + time + " 2 b', expected start, end and word");
  }
  EXPECT_EQ(ShowBytes("word,start,end\na,0.5,1\nb,NaN,nan\nc,2,3\n"),
            "a 0.50-1.00, b 1.00-2.00*, c 2.00-3.00");
}

TEST(TranscriptTest, FillsTimes) {
  const auto words = [](const std::string& list) {
    return ShowBytes("{\"words\": [" + list + "]}");
  };
  // Only a start, only an end.
  EXPECT_EQ(words(R"({"word": "aa", "start": 1}, {"word": "bb", "start": 1.1, "end": 1.3},
                     {"word": "cc", "end": 2})"),
            "aa 1.00-1.10*, bb 1.10-1.30, cc 1.80-2.00*");
  // Before the first and behind the last known time, at the pace of the known words.
  EXPECT_EQ(words(R"({"word": "aa"}, {"word": "bb", "start": 1, "end": 1.2}, {"word": "c"})"),
            "aa 0.80-1.00*, bb 1.00-1.20, c 1.20-1.30*");
  EXPECT_EQ(words(R"({"word": "abcdefghi"}, {"word": "bb", "start": 0.1, "end": 0.3})"),
            "abcdefghi 0.00-0.10*, bb 0.10-0.30");
  // By numbers of characters, not of bytes.
  EXPECT_EQ(words("{\"word\": \"a\", \"start\": 0, \"end\": 1}, {\"word\": \"\u00E4\u00F6\u00FC\"},"
                  "{\"word\": \"x\"}, {\"word\": \"b\", \"start\": 3, \"end\": 4}"),
            "a 0.00-1.00, \u00E4\u00F6\u00FC 1.00-2.50*, x 2.50-3.00*, b 3.00-4.00");
  EXPECT_EQ(words(R"({"word": "a"}, {"word": "b"})"),
            "t: has 2 words but no times, expected a start and an end in seconds");
  // A whole segment without times of words.
  EXPECT_EQ(
      ShowBytes(
          R"({"segments": [{"start": 1, "end": 2, "words": [{"word": "a"}, {"word": "b"}]}]})"),
      "a 1.00-1.50*, b 1.50-2.00*");
}

TEST(TranscriptTest, SaysWhatIsWrong) {
  EXPECT_EQ(ShowBytes("Once upon a time."),
            "t: holds no words with times in a form that gestus knows, expected the JSON of a "
            "speech recogniser, TextGrid, WebVTT, SRT, CTM, CSV, or lines of start, end and word");
  EXPECT_EQ(ShowBytes("{\"a\": 1"), "t: is not JSON at byte 8, expected a JSON document");
  EXPECT_EQ(
      ShowBytes("{\"a\": 1}"),
      "t: is JSON of a kind that gestus does not know, expected 'transcription' "
      "(whisper.cpp), 'segments' (Whisper, WhisperX), 'results' (Google), 'words' (Gentle) or "
      "'tiers' (MFA)");
  EXPECT_EQ(ShowBytes(R"({"segments": [{"words": [{"word": "a", "start": 1}, {"start": 2}]}]})"),
            "t: segments[0].words[1]: has no string 'word'");
  EXPECT_EQ(ShowBytes(R"({"transcription": [3]})"),
            "t: transcription[0]: is no object, expected one with 'text'");
  EXPECT_EQ(ShowBytes("0.5 1 a\nno \x1b[31m"),
            "t: line 2: 'no \\x1b[31m', expected start, end and word");
  EXPECT_EQ(
      ShowBytes("WEBVTT\n\n00:00:01.000 --> 00:0x"),
      "t: line 3: '00:00:01.000 --> 00:0x', expected times as in 00:00:01.000 --> 00:00:02.000");
  EXPECT_EQ(ShowBytes("r 1 0.5 0.5 a\nr 1 x 0.5 b\n"),
            "t: line 2: 'r 1 x 0.5 b', expected recording, channel, start, duration and word");
  EXPECT_EQ(ShowBytes("word,start,end\n\"a,1,2\nb,2,3"),
            "t: line 2: '\"a,1,2\\x0ab,2,3', expected a second quotation mark");
  EXPECT_EQ(ShowBytes("ooBinaryFile\x08TextGrid"),
            "t: is a binary Praat file, expected a TextGrid saved as text (Save as text file)");
  EXPECT_EQ(ShowBytes("File type = \"ooTextFile\"\nObject class = \"Pitch 1\"\n"),
            "t: is a Praat file of another kind, expected a TextGrid");
  const std::string grid =
      "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n0 1 <exists> 1\n";
  EXPECT_EQ(ShowBytes(grid + "\"IntervalTier\" \"words\" 0 1 1e18\n0 0.5 \"a\"\n"),
            "t: line 6: expected tier 1: the time of an entry, a number");
  EXPECT_EQ(ShowBytes(grid + "\"IntervalTier\" \"phones\" 0 1 0\n"),
            "t: has 1 interval tier, none of words, expected a tier named 'words'");
  EXPECT_EQ(ShowBytes("\xFF\xFE"
                      "a"),
            "t: is UTF-16 of 3 bytes, expected an even number");
}

TEST(TranscriptTest, SaysWhatIsWrongWithFiles) {
  const Result<Transcript> missing = ReadTranscript("no/such/file.json");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.status().message().find("no/such/file.json: cannot be opened"),
            std::string::npos);
  const std::string path = testing::TempDir() + "/words.txt";
  std::ofstream(path) << "0.5 1 a\nb\n";
  EXPECT_EQ(ReadTranscript(path).status().message(),
            path + ": line 2: 'b', expected start, end and word");
}

TEST(TranscriptTest, LeavesOutWhatIsNotSpoken) {
  EXPECT_EQ(ShowBytes("0 1 [Music]\n1 2 [upbeat\n2 3 music].\n3 4 [a\n4 5 -\n5 6 ...\n6 7 b"),
            "[a... 3.00-4.00, b 6.00-7.00");
  EXPECT_EQ(Notes("0 1 [Music]\n1 2 a"), "1 description in square brackets left out");
  EXPECT_EQ(ShowBytes("0 1 SIL\n1 2 <eps>\n2 3 sp\n3 4 &"), "& 3.00-4.00");
}

TEST(TranscriptTest, KeepsRepeatedSubtitles) {
  // What is said twice is no caption that rolls.
  EXPECT_EQ(
      ShowBytes("1\n00:00:01,000 --> 00:00:02,000\nNo.\n\n2\n00:00:03,000 --> 00:00:04,000\nNo.\n"),
      "No. 1.00-2.00, No. 3.00-4.00");
  std::string rolling;
  for (int i = 1; i < 6; ++i) {
    const std::string second = std::to_string(i);
    rolling += second + "\n00:00:0" + second + ",000 --> 00:00:0" + second + ",900\n" +
               (i > 1 ? "w" + std::to_string(i - 1) + "\n" : "") + "w" + second + "\n\n";
  }
  EXPECT_EQ(ShowBytes(rolling),
            "w1 1.00-1.90, w2 2.00-2.90, w3 3.00-3.90, w4 4.00-4.90, w5 5.00-5.90");
  EXPECT_EQ(Notes(rolling), "the captions roll; 4 lines shown again left out");
}

TEST(TranscriptTest, ReadsOddSubtitles) {
  // Cues that overlap, in the wrong order, without empty lines, with an empty line within.
  EXPECT_EQ(
      ShowBytes("2\n00:00:03.000 --> 00:00:04.000\nc\n1\n00:00:01,000 --> 00:00:03,500\na\n\nb\n"),
      "a 1.00-2.00*, b 2.00-3.00*, c 3.00-4.00");
  // Angles and ampersands that are no markup; entities; times that leave the cue.
  EXPECT_EQ(ShowBytes("WEBVTT\n\n00:01.000 --> 00:02.000\n3 < 4 &co &#x41;&#66;&nbsp;&bad;\n"),
            "3 1.00-1.08*, 4 1.08-1.17*, &co 1.17-1.42*, AB 1.42-1.58*, &bad; 1.58-2.00*");
  EXPECT_EQ(ShowBytes("WEBVTT\n\n00:01.000 --> 00:02.000\na<00:09.000> b<00:01.500> c\n"),
            "a 1.00-2.00, b 2.00-2.00, c 2.00-2.00");
  EXPECT_EQ(ShowBytes("WEBVTT\n\n00:01.000 --> 00:02.000\ngram<00:01.500>mar \u266A la \u266A\n"),
            "grammar 1.00-1.80, la 1.80-2.00*");
}

TEST(TranscriptTest, KnowsNumbersAsWords) {
  EXPECT_EQ(
      ShowBytes("0.5 0.9 20 30 40\n1 2 5 6 7\n"),
      "20 0.50-0.63*, 30 0.63-0.77*, 40 0.77-0.90*, 5 1.00-1.33*, 6 1.33-1.67*, 7 1.67-2.00*");
  EXPECT_EQ(ShowBytes("0 1 hello everybody\n1 3 out there\n"),
            "hello 0.00-0.36*, everybody 0.36-1.00*, out 1.00-1.75*, there 1.75-3.00*");
}

TEST(TranscriptTest, TakesOneRecordingOfACtm) {
  const std::string ctm = "a 1 0 0.5 x\nb 1 0 0.5 y\na 2 0.5 0.5 z\n";
  EXPECT_EQ(ShowBytes(ctm), "x 0.00-0.50, z 0.50-1.00");
  EXPECT_EQ(Notes(ctm), "1 line of other recordings than 'a' left out");
}

TEST(TranscriptTest, ChoosesTiers) {
  const auto grid = [](const std::string& tiers, int count) {
    return "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n0 2 <exists> " +
           std::to_string(count) + "\n" + tiers;
  };
  const std::string phones = "\"IntervalTier\" \"phones\" 0 2 1 0 1 \"AH\"\n";
  const std::string other = "\"IntervalTier\" \"Anna\" 0 2 1 0 1 \"hi you\"\n";
  const std::string words = "\"IntervalTier\" \"Word\" 0 2 1 1 2 \"yes\"\n";
  EXPECT_EQ(ShowBytes(grid(phones + other, 2)), "hi 0.00-0.40*, you 0.40-1.00*");
  EXPECT_EQ(
      Notes(grid(phones + other, 2)),
      "no tier is named 'words'; tier 'Anna' was taken | no word has a time of its own; those "
      "of phrases were shared out by length");
  EXPECT_EQ(ShowBytes(grid(phones + other + words, 3)), "yes 1.00-2.00");
  EXPECT_EQ(Notes(grid(words + words, 2)),
            "the words of 2 tiers were put together | 1 word overlaps the next one, the first at "
            "1.00 s; cut short");
}

TEST(StrippedTest, TakesPunctuationOffTheEnds) {
  for (const auto& [word, bare] :
       std::initializer_list<std::pair<const char*, const char*>>{{"deep", "deep"},
                                                                  {"(deep),", "deep"},
                                                                  {"it's", "it's"},
                                                                  {"'cause", "cause"},
                                                                  {"...", ""},
                                                                  {"", ""},
                                                                  {"\u00BFqu\u00E9?", "qu\u00E9"},
                                                                  {"\u201CHi\u201D", "Hi"},
                                                                  {"$5", "$5"},
                                                                  {"\u5B66\u3002", "\u5B66"},
                                                                  {"\xFF", "\xFF"},
                                                                  {".\xE2\x80", "\xE2\x80"}}) {
    EXPECT_EQ(Stripped(word), bare);
  }
}

}  // namespace
}  // namespace gestus::words
