// RMSE, correlation and activity: by hand, and against the formulas written out.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "models/metrics/activity.h"
#include "models/metrics/error.h"

namespace gestus::metrics {
namespace {

using Values = std::vector<float>;

Values Random(std::size_t n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal(0.5f, 1.0f);
  Values values(n);
  for (float& value : values) value = normal(generator);
  return values;
}

constexpr std::size_t kSizes[] = {2, 3, 7, 31, 64, 997};

TEST(Rmse, ByHand) {
  EXPECT_DOUBLE_EQ(*Rmse(Values{1, 2, 3}, Values{1, 4, 0}), std::sqrt(13.0 / 3));
  EXPECT_EQ(Rmse(Values{2, 2}, Values{2, 2}), Measure(0.0));
  EXPECT_EQ(Rmse(Values{5}, Values{2}), Measure(3.0));
}

TEST(Rmse, UndefinedWithoutValues) { EXPECT_EQ(Rmse(Values{}, Values{1}), std::nullopt); }

TEST(Rmse, OfTheShorter) { EXPECT_EQ(Rmse(Values{1, 2, 100}, Values{1, 2}), Measure(0.0)); }

TEST(Rmse, HugeValues) { EXPECT_NEAR(*Rmse(Values{3e38f}, Values{-3e38f}) / 6e38, 1, 1e-6); }

TEST(Pearson, ByHand) {
  EXPECT_NEAR(*Pearson(Values{1, 2, 3}, Values{10, 20, 30}), 1, 1e-15);
  EXPECT_NEAR(*Pearson(Values{1, 2, 3}, Values{5, 3, 1}), -1, 1e-15);
  // Deviations (-1, 0, 1) and (-1, 1, 0).
  EXPECT_NEAR(*Pearson(Values{1, 2, 3}, Values{0, 2, 1}), 0.5, 1e-15);
}

// The covariance over the deviations, by another route: means of products.
TEST(Pearson, AgreesWithTheOtherFormula) {
  for (const std::size_t n : kSizes) {
    const Values x = Random(n, 1), y = Random(n, 2);
    long double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const long double a = x[i], b = y[i];
      sx += a, sy += b, sxx += a * a, syy += b * b, sxy += a * b;
    }
    const auto m = static_cast<long double>(n);
    const long double want =
        (m * sxy - sx * sy) / std::sqrt(m * sxx - sx * sx) / std::sqrt(m * syy - sy * sy);
    EXPECT_NEAR(*Pearson(x, y), static_cast<double>(want), 1e-9) << n;
  }
}

TEST(Pearson, UndefinedForConstantsAndSingleValues) {
  // 0.1f has no exact mean of 3: rounding must not make a correlation of it.
  EXPECT_EQ(Pearson(Values{0.1f, 0.1f, 0.1f}, Values{1, 2, 3}), std::nullopt);
  EXPECT_EQ(Pearson(Values{1, 2, 3}, Values{7, 7, 7}), std::nullopt);
  EXPECT_EQ(Pearson(Values{1}, Values{2}), std::nullopt);
  EXPECT_EQ(Pearson(Values{}, Values{}), std::nullopt);
}

TEST(Pearson, NeverBeyondOne) {
  const Values x = Random(997, 3);
  EXPECT_LE(*Pearson(x, x), 1.0);
  EXPECT_NEAR(*Pearson(x, x), 1.0, 1e-12);
}

TEST(Activity, ByHand) {
  // Active predictions: 0.6 and 2.0; active truth: 1.0 and 2.0.  0.5 itself is not active.
  const Activity a = ActivityOf(Values{0.6f, 0.5f, 2, 0}, Values{1, 0.2f, 2, 0.5f});
  EXPECT_NEAR(*a.hit_intensity, 100 * 2.6 / 3.0, 1e-5);
  EXPECT_EQ(a.hit_count, Measure(100.0));
  EXPECT_EQ(a.non_hit, Measure(100.0));
  EXPECT_EQ(a.accuracy_intensity, Measure(75.0));  // 0.6 is not 1.0
  EXPECT_EQ(a.accuracy_count, Measure(100.0));
}

// Table 5.8 has AHR 101.1 with NAHR 100.0: possible by intensity, not by count.
TEST(Activity, IntensityMayPassHundredWithoutAnyMoreFrames) {
  const Activity a = ActivityOf(Values{1.1f, 0}, Values{1, 0});
  EXPECT_NEAR(*a.hit_intensity, 110, 1e-5);
  EXPECT_EQ(a.hit_count, Measure(100.0));
  EXPECT_EQ(a.non_hit, Measure(100.0));
}

TEST(Activity, UndefinedRatios) {
  const Activity idle = ActivityOf(Values{1, 0}, Values{0, 0});
  EXPECT_EQ(idle.hit_intensity, std::nullopt);
  EXPECT_EQ(idle.hit_count, std::nullopt);
  EXPECT_EQ(idle.non_hit, Measure(50.0));
  const Activity busy = ActivityOf(Values{1, 0}, Values{1, 1});
  EXPECT_EQ(busy.non_hit, std::nullopt);
  EXPECT_EQ(busy.hit_count, Measure(50.0));
  const Activity none = ActivityOf(Values{}, Values{});
  EXPECT_EQ(none.accuracy_count, std::nullopt);
  EXPECT_EQ(none.accuracy_intensity, std::nullopt);
}

TEST(Activity, AgreesWithCounting) {
  for (const std::size_t n : kSizes) {
    const Values p = Random(n, 4), t = Random(n, 5);
    double on_p = 0, on_t = 0, sum_p = 0, sum_t = 0, same = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (p[i] > 0.5f) ++on_p, sum_p += p[i];
      if (t[i] > 0.5f) ++on_t, sum_t += t[i];
      same += (p[i] > 0.5f) == (t[i] > 0.5f) ? 1 : 0;
    }
    const auto all = static_cast<double>(n);
    const Activity a = ActivityOf(p, t);
    if (on_t > 0) {
      EXPECT_DOUBLE_EQ(*a.hit_intensity, 100 * sum_p / sum_t);
      EXPECT_DOUBLE_EQ(*a.hit_count, 100 * on_p / on_t);
    }
    if (on_t < all) {
      EXPECT_DOUBLE_EQ(*a.non_hit, 100 * (all - on_p) / (all - on_t));
    }
    EXPECT_DOUBLE_EQ(*a.accuracy_count, 100 * same / all);
  }
}

}  // namespace
}  // namespace gestus::metrics
