// What is embedded in a page is taken out again and compared with what it was made from.
#include "models/player/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/player/show_data.h"

namespace gestus::player {
namespace {

using nlohmann::json;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::string PageOf(const Show& show) {
  std::vector<std::string> notes;
  const Result<std::string> page = MakePage(show, &notes);
  EXPECT_TRUE(page.ok()) << page.status().message();
  return page.ok() ? *page : "";
}

/// What stands between `begin` and the next `end`.
std::string Between(const std::string& page, const std::string& begin, const std::string& end) {
  const std::size_t at = page.find(begin);
  if (at == std::string::npos) return "";
  const std::size_t from = at + begin.size();
  return page.substr(from, page.find(end, from) - from);
}

json DataOf(const std::string& page) {
  return json::parse(Between(page, "<script type=\"application/json\" id=\"data\">", "</script>"));
}

std::string Decode(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    if ((count += 6) >= 8) out += static_cast<char>(bits >> (count -= 8) & 255U);
  }
  return out;
}

std::vector<float> Values(const json& packed) {
  const std::string bytes = Decode(packed.at("numbers"));
  std::vector<float> values;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const int number = static_cast<std::int16_t>(static_cast<unsigned char>(bytes[i]) |
                                                 static_cast<unsigned char>(bytes[i + 1]) << 8);
    values.push_back(static_cast<float>(packed.at("offset").get<double>() +
                                        packed.at("scale").get<double>() * number));
  }
  return values;
}

TEST(PageTest, PointsComeBackWithinAQuarter) {
  Show show = test::BodyShow(40);
  show.prediction.body->values[7] = 12345.5f;  // a range that is wide
  show.prediction.body->values[8] = -15000.25f;
  const json data = DataOf(PageOf(show));
  const json& body = data["takes"][0]["body"];
  EXPECT_EQ(body["names"], (json{"Neck", "RShoulder", "RWrist", "Nose"}));
  EXPECT_EQ(body["parents"], (json{-1, 0, 1, 0}));
  const std::vector<float> got = Values(body), want = show.prediction.body->values;
  ASSERT_EQ(got.size(), want.size());
  EXPECT_LT(body["scale"].get<double>(), 0.5);
  for (std::size_t i = 0; i < want.size(); ++i) {
    // The neck is where everything is measured from, whatever its columns hold.
    const bool neck = i % 4 == 0;
    EXPECT_NEAR(got[i], neck ? 0 : want[i], 0.25) << i;
  }
}

TEST(PageTest, CurvesComeBackWithinTheirRangeBy65534) {
  const Show show = test::HeadShow(31);
  const json takes = DataOf(PageOf(show))["takes"];
  const outputs::Curves& curves = *show.prediction.curves;
  for (std::size_t n = 0; n < curves.curves.size(); ++n) {
    const json& curve = takes[0]["curves"][n];
    EXPECT_EQ(curve["name"], curves.curves[n].name);
    const std::vector<float> got = Values(curve);
    ASSERT_EQ(got.size(), 31u);
    for (std::int64_t i = 0; i < 31; ++i)
      EXPECT_NEAR(got[static_cast<std::size_t>(i)], curves.at(i, n),
                  curve["scale"].get<double>() / 2 + 1e-6);
  }
}

TEST(PageTest, SoundComesBackAsItWas) {
  Show show = test::BodyShow(10);
  show.sound.sample_rate = 8000;
  show.sound.samples = {0, 0.5f, -1, 1, 2, kNan, -0.25f};
  const auto wav = [&] {
    return Decode(Between(PageOf(show), "src=\"data:audio/wav;base64,", "\""));
  };
  const std::string made = wav();
  ASSERT_EQ(made.size(), 44u + 14);
  const std::vector<std::int16_t> want = {0, 16384, -32767, 32767, 32767, 0, -8192};
  for (std::size_t i = 0; i < want.size(); ++i) {
    const auto low = static_cast<unsigned char>(made[44 + 2 * i]);
    const auto high = static_cast<unsigned char>(made[45 + 2 * i]);
    EXPECT_EQ(static_cast<std::int16_t>(low | high << 8), want[i]) << i;
  }
  // A plain file is embedded byte for byte, one that is cut short is not.
  show.sound.file = made;
  show.sound.file[50] = 99;
  EXPECT_EQ(wav(), show.sound.file);
  show.sound.file.pop_back();
  EXPECT_EQ(wav(), made);
  show.sound.file = made;
  show.sound.file[20] = 3;  // float
  EXPECT_EQ(wav(), made);
}

TEST(PageTest, TextCannotLeaveItsPlace) {
  Show show = test::BodyShow(3);
  const std::vector<std::string> texts = {"</script><script>alert(1)</script>",
                                          "<!--",
                                          "\"'`&amp;",
                                          "{{data}}",
                                          "\xf0\x9f\x99\x82",
                                          "\xd7\xa9\xd7\x9c",
                                          "a\\b\n\x01",
                                          "\xe2\x80\xa8"};
  for (const std::string& text : texts) show.words.push_back({text, 0, 1, true});
  show.title = texts[0] + texts[2];
  const std::string page = PageOf(show);
  const json words = DataOf(page)["words"];
  ASSERT_EQ(words.size(), texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) EXPECT_EQ(words[i][0], texts[i]);
  // Our own scripts, the data and no other.
  std::size_t scripts = 0;
  for (std::size_t at = 0; (at = page.find("</script", at)) != std::string::npos; ++at) ++scripts;
  EXPECT_EQ(scripts, 2u);
  EXPECT_NE(
      page.find("<title>&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;`&amp;amp;"
                "</title>"),
      std::string::npos);
}

TEST(PageTest, BytesThatAreNotUtf8AreReplaced) {
  Show show = test::BodyShow(3);
  show.words = {{"a\xff\xc3z\xed\xa0\x80", 0, 1, true}};
  EXPECT_EQ(DataOf(PageOf(show))["words"][0][0],
            "a\xef\xbf\xbd\xef\xbf\xbdz\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
}

TEST(PageTest, WhatIsNotFiniteBecomesWhatWasBefore) {
  Show show = test::BodyShow(4);
  std::vector<float>& values = show.prediction.body->values;
  const float before = values[8 + 2];
  values[2] = kNan;  // no frame before it
  values[16 + 2] = std::numeric_limits<float>::infinity();
  show.spectrogram = {.rate = 50, .bins = 2, .values = {kNan, 1, 2, kNan}};
  show.pitch = {.rate = 100, .hz = {kNan, 120.26f, 0}};
  show.words = {{"a", kNan, std::numeric_limits<double>::infinity(), true}};
  const std::string page = PageOf(show);
  const json data = DataOf(page);
  const std::vector<float> got = Values(data["takes"][0]["body"]);
  EXPECT_NEAR(got[2], before, 0.25);
  EXPECT_NEAR(got[16 + 2], before, 0.25);
  EXPECT_EQ(Decode(data["pitch"]["tenths"]), std::string("\0\0\xb3\x04\0\0", 6));
  const std::string text = Between(page, "id=\"data\">", "</script>");
  for (const char* word : {"NaN", "nan", "Infinity", ":inf", "null"})
    EXPECT_EQ(text.find(word), std::string::npos) << word;
}

TEST(PageTest, OneFrameWithoutSoundOrWordsIsAPage) {
  const std::string page = PageOf(test::BodyShow(1));
  const json data = DataOf(page);
  EXPECT_EQ(data["takes"].size(), 1u);
  EXPECT_EQ(data["takes"][0]["frames"], 1);
  EXPECT_TRUE(data["words"].empty());
  EXPECT_EQ(data.count("levels"), 0u);
  EXPECT_NE(page.find("id=\"sound\" preload=\"auto\" src=\"\""), std::string::npos);
}

TEST(PageTest, TakesStandAsInTheStudies) {
  Show show = test::BodyShow(5);
  show.source = test::BodyShow(7).prediction;
  show.target = test::BodyShow(6).prediction;
  const json data = DataOf(PageOf(show));
  ASSERT_EQ(data["takes"].size(), 3u);
  EXPECT_EQ(data["takes"][0]["role"], "source");
  EXPECT_EQ(data["takes"][1]["role"], "prediction");
  EXPECT_EQ(data["takes"][2]["role"], "target");
  EXPECT_NEAR(data["seconds"].get<double>(), 7.0 / 15, 1e-9);
}

TEST(PageTest, NothingIsFetched) {
  const std::string page = PageOf(test::BodyShow(2));
  EXPECT_NE(page.find("content=\"default-src 'none';"), std::string::npos);
  for (const char* word : {"http://", "https://", "eval(", "new Function", "fetch(", "import ",
                           "@import", "onclick", "{{"})
    EXPECT_EQ(page.find(word), std::string::npos) << word;
}

TEST(PageTest, LongSoundIsLeftOutAndNoted) {
  Show show = test::BodyShow(2);
  show.sound.sample_rate = 1;
  show.sound.samples.resize(3601, 0.0f);
  std::vector<std::string> notes;
  const Result<std::string> page = MakePage(show, &notes);
  ASSERT_TRUE(page.ok());
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("3601 s"), std::string::npos) << notes[0];
  EXPECT_EQ(page->find("data:audio/wav"), std::string::npos);
}

TEST(PageTest, WhatDoesNotFitIsAnError) {
  const auto fails = [](const Show& show, const std::string& says) {
    std::vector<std::string> notes;
    const Result<std::string> page = MakePage(show, &notes);
    ASSERT_FALSE(page.ok());
    EXPECT_NE(page.status().message().find(says), std::string::npos) << page.status().message();
  };
  Show show = test::BodyShow(3);
  show.prediction.body->values.pop_back();
  fails(show, "prediction: body: ");
  show = test::BodyShow(3);
  show.prediction.body->points[1].parent = 4;
  fails(show, "parents");
  show = test::BodyShow(3);
  show.prediction.frame_rate = kNan;
  fails(show, "frame rate");
  show = test::HeadShow(3);
  show.target = show.prediction;
  show.target->curves->values.pop_back();
  fails(show, "target: curves");
  show = test::BodyShow(3);
  show.prediction.frames = 0;
  fails(show, "a frame or more");
  show = test::BodyShow(3);
  show.spectrogram = {.rate = 50, .bins = 2, .values = {1, 2, 3}};
  fails(show, "spectrogram");
}

}  // namespace
}  // namespace gestus::player
