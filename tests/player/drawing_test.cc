// Pictures: what the rasteriser paints where, and that figures stand where their numbers say.
#include "models/player/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "models/player/letters.h"
#include "models/player/raster.h"
#include "models/player/sheet.h"
#include "tests/player/show_data.h"

namespace gestus::player {
namespace {

constexpr Colour kWhite = {255, 255, 255}, kBlack = {0, 0, 0};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How much of the white ground is black, in pixels.
double Painted(const Raster& raster) {
  double sum = 0;
  for (int y = 0; y < raster.height(); ++y)
    for (int x = 0; x < raster.width(); ++x) sum += (255 - raster.at(x, y).r) / 255.0;
  return sum;
}

TEST(RasterTest, AreasAreAsLargeAsGeometrySays) {
  Raster raster(101, 83, kWhite);
  raster.Disc({50.3, 40.7}, 20, kBlack);
  EXPECT_NEAR(Painted(raster), 3.14159265 * 400, 2);
  raster.Clear(kWhite);
  const Vec2 ends[2] = {{20.25, 30.5}, {70.5, 52.75}};
  raster.Line(ends, 6, kBlack);
  EXPECT_NEAR(Painted(raster), 6 * std::hypot(50.25, 22.25) + 3.14159265 * 9, 2);
  raster.Clear(kWhite);
  const Vec2 corners[3] = {{10.5, 10}, {90, 12.5}, {40, 70}};
  raster.Area(corners, kBlack);
  EXPECT_NEAR(Painted(raster), 0.5 * std::abs(79.5 * 60 - 29.5 * 2.5), 2);
}

TEST(RasterTest, EdgesAreSmoothAndInsidesFull) {
  Raster raster(40, 40, kWhite);
  const Vec2 ends[2] = {{10, 20.5}, {30, 20.5}};
  raster.Line(ends, 4, kBlack);  // from 18.5 to 22.5
  EXPECT_EQ(raster.at(20, 20), kBlack);
  EXPECT_EQ(raster.at(20, 18), (Colour{128, 128, 128}));
  EXPECT_EQ(raster.at(20, 17), kWhite);
  EXPECT_EQ(raster.at(2, 20), kWhite);
}

TEST(RasterTest, CrossingItselfIsNoDarker) {
  Raster raster(40, 40, kWhite);
  const Vec2 cross[4] = {{5, 20}, {35, 20}, {20, 5}, {20, 35}};
  raster.Line(cross, 6, kBlack, 0.5);
  EXPECT_EQ(raster.at(20, 20), raster.at(8, 20));
}

TEST(RasterTest, WhatLiesOutsideIsLeftOut) {
  Raster raster(16, 9, kWhite);
  const Vec2 far[2] = {{-1e9, -1e9}, {-2e9, 5}};
  raster.Line(far, 3, kBlack);
  raster.Disc({1e12, 4}, 5, kBlack);
  const Vec2 bad[3] = {{kInfinity, 0}, {std::nan(""), 5}, {3, 4}};
  raster.Line(bad, 3, kBlack);
  raster.Area(bad, kBlack);
  EXPECT_EQ(Painted(raster), 0);
  const Vec2 through[2] = {{-1e6, 4.5}, {1e6, 4.5}};
  raster.Line(through, 2, kBlack);
  EXPECT_NEAR(Painted(raster), 32, 0.1);  // rounded to 8 bits
}

TEST(LettersTest, EveryLetterHasStrokesOfItsOwn) {
  const std::string all = "ABCDEFGHIJKLMNPQRSTUVWXYZ0123456789:.-/";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto strokes = StrokesOf(all[i]);
    EXPECT_FALSE(strokes.empty()) << all[i];
    for (const auto& stroke : strokes) {
      EXPECT_GE(stroke.size(), 2u) << all[i];
      for (const Vec2 p : stroke)
        EXPECT_TRUE(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1) << all[i];
    }
    for (std::size_t j = 0; j < i; ++j) {
      const auto others = StrokesOf(all[j]);
      const auto same = [](const auto& a, const auto& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](Vec2 p, Vec2 q) { return p.x == q.x && p.y == q.y; });
      };
      EXPECT_FALSE(std::equal(strokes.begin(), strokes.end(), others.begin(), others.end(), same))
          << all[i] << all[j];
    }
  }
  EXPECT_EQ(StrokesOf('a').size(), StrokesOf('A').size());
  EXPECT_TRUE(StrokesOf('\xe9').empty());
}

TEST(BodyDrawingTest, JointsStandWhereTheirNumbersSay) {
  const Show show = test::BodyShow(9);
  const outputs::Figure& figure = *show.prediction.body;
  const double shoulder = std::hypot(166, 14), share = 0.25;
  const Drawing drawing = BodyDrawing(show.prediction).At((3 + share) / 15, 0);
  // The bone to the wrist comes last but for the nose, which has none.
  const Shape& bone = drawing.back();
  EXPECT_EQ(bone.ink, Ink::kRight);
  ASSERT_EQ(bone.points.size(), 2u);
  const double x = figure.x(3, 2) + share * (figure.x(4, 2) - figure.x(3, 2));
  const double y = figure.y(3, 2) + share * (figure.y(4, 2) - figure.y(3, 2));
  EXPECT_NEAR(bone.points[1].x, x / shoulder, 1e-5);
  EXPECT_NEAR(bone.points[1].y, y / shoulder, 1e-5);
}

/// The mean of the points of the shapes with `ink`.
Vec2 MeanOf(const Drawing& drawing, Ink ink) {
  Vec2 sum;
  double count = 0;
  for (const Shape& shape : drawing) {
    if (shape.ink != ink) continue;
    for (const Vec2 p : shape.points) {
      sum.x += p.x;
      sum.y += p.y;
      ++count;
    }
  }
  return {sum.x / count, sum.y / count};
}

outputs::Motion Face(const std::vector<std::pair<std::string, float>>& values) {
  outputs::Motion motion;
  motion.frames = 1;
  outputs::Curves& curves = motion.curves.emplace();
  for (const auto& [name, value] : values) {
    curves.curves.push_back({name, "", 0, 5});
    curves.values.push_back(value);
  }
  return motion;
}

TEST(HeadTest, ActionUnitsAndAnglesMoveWhatTheyShould) {
  const Vec2 brows = MeanOf(HeadAt(Face({{"AU01", 0}}), 0), Ink::kBrow);
  EXPECT_LT(MeanOf(HeadAt(Face({{"AU01", 5}}), 0), Ink::kBrow).y, brows.y - 0.03);
  EXPECT_LT(MeanOf(HeadAt(Face({{"AU02", 5}}), 0), Ink::kBrow).y, brows.y - 0.03);
  EXPECT_GT(MeanOf(HeadAt(Face({{"AU04", 5}}), 0), Ink::kBrow).y, brows.y + 0.03);
  // OpenFace: Rx > 0 looks down; Ry > 0 to the left of the picture, since R e_z = (sin Ry, ...).
  EXPECT_GT(MeanOf(HeadAt(Face({{"Rx", 0.4f}}), 0), Ink::kPupil).y, brows.y + 0.2);
  EXPECT_LT(MeanOf(HeadAt(Face({{"Ry", 0.4f}}), 0), Ink::kPupil).x, -0.1);
  const Vec2 cheeks = MeanOf(HeadAt(Face({{"AU06", 0}}), 0), Ink::kCheek);
  EXPECT_LT(MeanOf(HeadAt(Face({{"AU06", 5}}), 0), Ink::kCheek).y, cheeks.y - 0.05);
}

std::size_t CountOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
  return count;
}

TEST(SheetTest, HasAFigureForEveryStepAndEveryWord) {
  Show show = test::BodyShow(60);  // 4 s
  show.words = {{"a<b>&\"c\"", 0.5, 1, true}, {"\xf0\x9f\x99\x82", 3, 3.5, true}};
  show.sound = test::Tone(4);
  const Result<std::string> sheet = MakeSheet(show, {.step = 0.5});
  ASSERT_TRUE(sheet.ok()) << sheet.status().message();
  EXPECT_EQ(
      CountOf(*sheet, "stroke=\"#e0703a\" stroke-width=\"") - CountOf(*sheet, "opacity=\"0.50\""),
      8u);
  EXPECT_NE(sheet->find(">a&lt;b&gt;&amp;&quot;c&quot;</text>"), std::string::npos);
  EXPECT_NE(sheet->find("\xf0\x9f\x99\x82"), std::string::npos);
  EXPECT_NE(sheet->find("Untrained weights"), std::string::npos);
  for (const char* word : {"nan", "inf"}) EXPECT_EQ(sheet->find(word), std::string::npos) << word;
}

TEST(SheetTest, OneFrameHasOneFigureAndLongMotionNotTooMany) {
  for (const Show& show : {test::BodyShow(1), test::HeadShow(1)}) {
    const Result<std::string> sheet = MakeSheet(show);
    ASSERT_TRUE(sheet.ok());
    EXPECT_NE(sheet->find("<polyline"), std::string::npos);
  }
  const Result<std::string> sheet = MakeSheet(test::BodyShow(9000));
  ASSERT_TRUE(sheet.ok());
  const std::size_t figures =
      CountOf(*sheet, "stroke=\"#e0703a\"") - CountOf(*sheet, "opacity=\"0.50\"");
  EXPECT_GT(figures, 300u);
  EXPECT_LE(figures, 400u);
}

}  // namespace
}  // namespace gestus::player
