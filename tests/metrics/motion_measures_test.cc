// Behaviour, distances, content and transfer: by hand, and against the formulas written out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "models/metrics/behaviour.h"
#include "models/metrics/points.h"
#include "models/metrics/similarity.h"
#include "models/metrics/transfer.h"

namespace gestus::metrics {
namespace {

using outputs::Figure;
using outputs::Motion;
using Values = std::vector<float>;
using Sources = std::vector<std::int64_t>;

Figure FigureOf(const Sources& sources, Values values) {
  Figure figure;
  for (const std::int64_t source : sources)
    figure.points.push_back({"joint" + std::to_string(source), -1, source});
  figure.values = std::move(values);
  return figure;
}

Values Random(std::size_t n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal(20, 90);
  Values values(n);
  for (float& value : values) value = normal(generator);
  return values;
}

TEST(Behaviour, ByHand) {
  // A wrist that goes (0,0) (3,4) (6,8) (15,20) and an elbow that stays; x of both, then y.
  const Figure body =
      FigureOf({3, 2}, {0, 1, 0, 1, /**/ 3, 1, 4, 1, /**/ 6, 1, 8, 1, /**/ 15, 1, 20, 1});
  const Behaviour b = SumBehaviour(body, 4, 10, Sources{3, 2}).Mean();
  EXPECT_DOUBLE_EQ(*b[0], 10 * (5 + 5 + 15) / 6.0);
  EXPECT_DOUBLE_EQ(*b[1], 100 * (0 + 10) / 4.0);
  EXPECT_DOUBLE_EQ(*b[2], 1000 * 10 / 2.0);
  EXPECT_DOUBLE_EQ(*b[3], 10 * 25 / 3.0);
  EXPECT_DOUBLE_EQ(*b[4], 100 * 10 / 2.0);
  EXPECT_DOUBLE_EQ(*b[5], 1000 * 10);
  EXPECT_DOUBLE_EQ(*b[6], 2 * ((1 + 1) + (2 + 3) + (5 + 7) + (14 + 19)) / 4.0);
}

TEST(Behaviour, NeckIsTheOriginOfTheBox) {
  // The neck's own columns hold its place in the picture and do not matter.
  const Figure body = FigureOf({0, 3}, {500, 10, 300, 20, /**/ 900, -10, 1, -20});
  const Behaviour b =
      SumBehaviour(body, 2, 1, SharedSources(std::vector{&body}, Part::kBody)).Mean();
  EXPECT_DOUBLE_EQ(*b[6], 60);
  EXPECT_DOUBLE_EQ(*b[0], std::hypot(20, 40));
}

TEST(Behaviour, UndefinedForShortMotion) {
  const Figure body = FigureOf({3}, {1, 2, 3, 4, 5, 6});
  const auto defined = [&](std::int64_t frames) {
    std::size_t count = 0;
    for (const Measure& m : SumBehaviour(body, frames, 15, Sources{3}).Mean()) count += m ? 1 : 0;
    return count;
  };
  EXPECT_EQ(defined(0), 0u);
  EXPECT_EQ(defined(1), 1u);  // the box
  EXPECT_EQ(defined(2), 3u);
  EXPECT_EQ(defined(3), 5u);
}

TEST(Behaviour, UndefinedWithoutWristsOrJoints) {
  const Figure body = FigureOf({1}, {1, 2, 3, 4, 5, 6, 7, 8});
  const Behaviour b = SumBehaviour(body, 4, 15, Sources{1}).Mean();
  EXPECT_TRUE(b[0] && b[1] && b[2] && b[6]);
  EXPECT_FALSE(b[3] || b[4] || b[5]);
  for (const Measure& m : SumBehaviour(body, 4, 15, {}).Mean()) EXPECT_FALSE(m);
}

TEST(Behaviour, AgreesWithDifferencesOfDifferences) {
  const Sources sources = {1, 2, 3, 4, 5, 6, 10};
  for (const std::size_t frames : {4u, 5u, 13u, 64u}) {
    const std::size_t joints = sources.size();
    const Figure body = FigureOf(sources, Random(frames * 2 * joints, 7));
    std::vector<double> rows(body.values.begin(), body.values.end());
    const Behaviour got = SumBehaviour(body, static_cast<std::int64_t>(frames), 15, sources).Mean();
    for (std::size_t order = 1, left = frames; order <= 3; ++order) {
      --left;
      for (std::size_t i = 0; i < left * 2 * joints; ++i) rows[i] = rows[i + 2 * joints] - rows[i];
      double sum = 0, wrists = 0;
      for (std::size_t t = 0; t < left; ++t) {
        for (std::size_t j = 0; j < joints; ++j) {
          const double x = rows[(2 * t) * joints + j], y = rows[(2 * t + 1) * joints + j];
          sum += std::sqrt(x * x + y * y);
          if (sources[j] == 3 || sources[j] == 6) wrists += std::sqrt(x * x + y * y);
        }
      }
      const double scale = std::pow(15.0, static_cast<double>(order));
      EXPECT_NEAR(*got[order - 1], scale * sum / static_cast<double>(left * joints),
                  1e-9 * scale * sum);
      EXPECT_NEAR(*got[order + 2], scale * wrists / static_cast<double>(left * 2),
                  1e-9 * scale * wrists);
    }
  }
}

TEST(Behaviour, SumsOfSequencesAddUp) {
  const Figure body = FigureOf({3}, Random(20, 8));
  BehaviourSums twice = SumBehaviour(body, 10, 15, Sources{3});
  const Behaviour once = twice.Mean();
  twice.Add(SumBehaviour(body, 10, 15, Sources{3}));
  for (std::size_t i = 0; i < kBehaviours; ++i) EXPECT_DOUBLE_EQ(*twice.Mean()[i], *once[i]);
}

TEST(WristSpeed, MeanOfBoth) {
  const Figure body = FigureOf({3, 6}, {0, 0, 0, 0, /**/ 3, 0, 4, 1});
  EXPECT_EQ(WristSpeed(body, 2, 10), std::vector<double>{30});
  EXPECT_TRUE(WristSpeed(body, 1, 10).empty());
  EXPECT_TRUE(WristSpeed(FigureOf({1}, {0, 0, 1, 1}), 2, 10).empty());
}

TEST(StyleDistance, SharesAddUpToHundred) {
  const StyleDistance d = DistanceToTarget(10, 22, 20);
  EXPECT_EQ(d.source, Measure(10.0));
  EXPECT_EQ(d.prediction, Measure(2.0));
  EXPECT_NEAR(*d.source_percent, 100 * 10.0 / 12, 1e-12);
  EXPECT_NEAR(*d.source_percent + *d.prediction_percent, 100, 1e-12);
}

TEST(StyleDistance, UndefinedWhereAllAreOne) {
  const StyleDistance d = DistanceToTarget(20, 20, 20);
  EXPECT_EQ(d.source, Measure(0.0));
  EXPECT_FALSE(d.source_percent || d.prediction_percent);
  const StyleDistance gone = DistanceToTarget(std::nullopt, 20, 30);
  EXPECT_FALSE(gone.source || gone.source_percent || gone.prediction_percent);
  EXPECT_EQ(gone.prediction, Measure(10.0));
}

TEST(Content, ByHand) {
  EXPECT_NEAR(*SumContent(Values{1, 0}, Values{1, 1}).Percent(), 100 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(*SumContent(Values{1, 2}, Values{-2, -4}).Percent(), -100, 1e-12);
  EXPECT_FALSE(SumContent(Values{0, 0}, Values{1, 2}).Percent());
  EXPECT_FALSE(SumContent(Values{}, Values{}).Percent());
}

TEST(Content, SumsAreThoseOfTheWhole) {
  const Values a = Random(37, 1), b = Random(37, 2);
  const std::span<const float> x(a), y(b);
  ContentSums parts = SumContent(x.first(11), y.first(11));
  parts.Add(SumContent(x.subspan(11), y.subspan(11)));
  EXPECT_NEAR(*parts.Percent(), *SumContent(x, y).Percent(), 1e-10);
}

TEST(Minkowski, ByHand) {
  // Two points in one frame: differences (3, 4) and (0, 1); x of both, then y.
  const Values a = {3, 0, 4, 1}, b = {0, 0, 0, 0};
  EXPECT_DOUBLE_EQ(*SumDistances(a, b, 2, 2).PerPoint(), 3);
  EXPECT_DOUBLE_EQ(*SumDistances(a, b, 2, 2).PerFrame(), std::sqrt(26.0));
  EXPECT_DOUBLE_EQ(*SumDistances(a, b, 2, 1).PerPoint(), 4);
  EXPECT_DOUBLE_EQ(*SumDistances(a, b, 2, 1).PerFrame(), 8);
}

TEST(Minkowski, OfAnyOrder) {
  for (const double order : {1.0, 1.5, 2.0, 3.0, 7.0, 100.0}) {
    const Values a = Random(6, 3), b = Random(6, 4);
    long double sum = 0;
    for (std::size_t i = 0; i < 6; ++i)
      sum += std::pow(std::abs(static_cast<long double>(a[i]) - b[i]),
                      static_cast<long double>(order));
    const auto want = static_cast<double>(std::pow(sum, 1 / static_cast<long double>(order)));
    EXPECT_NEAR(*SumDistances(a, b, 3, order).PerFrame(), want, 1e-9 * want) << order;
  }
}

TEST(Minkowski, NeitherOverflowsNorVanishes) {
  EXPECT_NEAR(*SumDistances(Values{3e38f, 0}, Values{0, 0}, 1, 100).PerPoint() / 3e38, 1, 1e-6);
  EXPECT_NEAR(*SumDistances(Values{1e-30f, 0}, Values{0, 0}, 1, 100).PerPoint() / 1e-30, 1, 1e-6);
}

TEST(Minkowski, UndefinedWithoutFramesOrPoints) {
  EXPECT_FALSE(SumDistances(Values{}, Values{}, 2, 2).PerPoint());
  EXPECT_FALSE(SumDistances(Values{}, Values{}, 2, 2).PerFrame());
  EXPECT_FALSE(SumDistances(Values{1}, Values{1}, 0, 2).PerFrame());
  EXPECT_EQ(SumDistances(Values{1, 2}, Values{1, 2}, 1, 2).PerPoint(), Measure(0.0));
}

TEST(Points, SharedWithoutNeck) {
  const Figure a = FigureOf({0, 1, 3, 6}, {}), b = FigureOf({6, 0, 3}, {});
  EXPECT_EQ(SharedSources(std::vector{&a, &b}, Part::kBody), (Sources{3, 6}));
  EXPECT_EQ(SharedSources(std::vector<const Figure*>{nullptr, &b}, Part::kBody), (Sources{6, 3}));
  EXPECT_EQ(SharedSources(std::vector{&a}, Part::kFace), (Sources{0, 1, 3, 6}));
  EXPECT_TRUE(SharedSources(std::vector<const Figure*>{nullptr}, Part::kFace).empty());
}

TEST(Points, CoordinatesInTheOrderAskedFor) {
  Motion motion;
  motion.frames = 2;
  motion.body = FigureOf({0, 1, 3}, {9, 1, 2, 9, 3, 4, /**/ 9, 5, 6, 9, 7, 8});
  motion.face = FigureOf({0}, {10, 20, 30, 40});
  EXPECT_EQ(Coordinates(motion, 2, Sources{3, 1}, Sources{0}),
            (Values{2, 1, 10, 4, 3, 20, 6, 5, 30, 8, 7, 40}));
  EXPECT_TRUE(Coordinates(motion, 0, Sources{3}, {}).empty());
}

TEST(Transfer, ByHand) {
  TransferStrength t = CountTransferred(Values{0.4f, 0.5f, 0.51f, 1});
  EXPECT_EQ(t.right, 2);
  EXPECT_EQ(t.Percent(), Measure(50.0));
  t.Add(CountTransferred(Values{1, 1}));
  EXPECT_NEAR(*t.Percent(), 100 * 4 / 6.0, 1e-12);
  EXPECT_FALSE(CountTransferred(Values{}).Percent());
}

}  // namespace
}  // namespace gestus::metrics
