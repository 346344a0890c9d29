#include "models/prosody/swipe_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gestus::prosody {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Glasberg and Moore's scale as SWIPE' uses it.
double HzToErb(double hz) { return 21.4 * std::log10(1 + hz / 229); }
double ErbToHz(double erb) { return (std::pow(10, erb / 21.4) - 1) * 229; }

std::size_t StepsBetween(double low, double high, double step) {
  return static_cast<std::size_t>(std::ceil((high - low) / step));
}

// 1 at 1 and at the primes up to `last`.
std::vector<double> PrimesAndOne(std::size_t last) {
  std::vector<double> is_prime(last + 1, 1.0);
  is_prime[0] = 0.0;
  for (std::size_t n = 2; n * n <= last; ++n)
    for (std::size_t multiple = n * n; multiple <= last; multiple += n) is_prime[multiple] = 0.0;
  return is_prime;
}

// At q times a candidate's frequency: a cosine, whole within a quarter of a prime harmonic and
// half from there to three quarters, so that between two neighbouring ones it is whole again.
double KernelAt(double q, const std::vector<double>& is_prime) {
  double share = 0;
  const auto below = static_cast<std::size_t>(q);
  for (std::size_t n = below; n <= below + 1 && n < is_prime.size(); ++n) {
    const double distance = std::fabs(q - static_cast<double>(n));
    if (distance < 0.75) share += is_prime[n] * (distance < 0.25 ? 1.0 : 0.5);
  }
  return share * std::cos(kTurn * q);
}

void AddKernels(SwipeTables* tables) {
  const std::vector<double>& bands = tables->bands;
  const double harmonics = bands.back() / tables->candidates.front() - 0.75;
  const std::vector<double> is_prime = PrimesAndOne(static_cast<std::size_t>(harmonics));
  tables->kernels.resize(tables->candidates.size() * bands.size());
  double* row = tables->kernels.data();
  for (const double candidate : tables->candidates) {
    double positive = 0;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      row[b] = KernelAt(bands[b] / candidate, is_prime) * std::sqrt(1 / bands[b]);
      if (row[b] > 0) positive += row[b] * row[b];
    }
    for (std::size_t b = 0; b < bands.size(); ++b) row[b] /= std::sqrt(positive);
    row += bands.size();
  }
}

// A window serves best the candidates of which it holds eight periods, and less those up to an
// octave away.
void AddWindows(const SwipeOptions& o, SwipeTables* tables) {
  const double low = std::log2(8 * o.sample_rate / o.min_hz);
  const double high = std::log2(8 * o.sample_rate / o.max_hz);
  const int count = static_cast<int>(std::round(low - high)) + 1;
  const double log2_size = std::round(low);
  for (int k = 0; k < count; ++k) {
    SwipeWindow window;
    window.size = std::size_t{1} << (static_cast<int>(log2_size) - k);
    for (std::size_t c = 0; c < tables->candidates.size(); ++c) {
      // How many octaves the candidate lies above the one that this window serves best.
      const double octaves = tables->log2_min + static_cast<double>(c) * kCandidateOctaves -
                             std::log2(8 * o.sample_rate) + log2_size - k;
      if ((octaves <= -1 && k > 0) || (octaves >= 1 && k < count - 1)) continue;
      const bool beyond = (octaves < 0 && k == 0) || (octaves > 0 && k == count - 1);
      const bool whole = beyond && o.mode == SwipeMode::kTextbook;
      if (window.weight.empty()) window.first = c;
      window.weight.push_back(whole ? 1.0 : 1 - std::fabs(octaves));
    }
    tables->windows.push_back(std::move(window));
  }
}

}  // namespace

SwipeTables MakeSwipeTables(const SwipeOptions& o) {
  SwipeTables tables;
  tables.log2_min = std::log2(o.min_hz);
  const std::size_t candidates =
      StepsBetween(tables.log2_min, std::log2(o.max_hz), kCandidateOctaves);
  for (std::size_t c = 0; c < candidates; ++c)
    tables.candidates.push_back(
        std::exp2(tables.log2_min + static_cast<double>(c) * kCandidateOctaves));
  const double lowest = HzToErb(o.min_hz / 4);
  const std::size_t bands = StepsBetween(lowest, HzToErb(o.sample_rate / 2), kBandErbs);
  for (std::size_t b = 0; b < bands; ++b)
    tables.bands.push_back(ErbToHz(lowest + static_cast<double>(b) * kBandErbs));
  AddWindows(o, &tables);
  AddKernels(&tables);
  return tables;
}

double FinePitch(const SwipeTables& tables, std::size_t best, const double strengths[3]) {
  // The parabola lies over the periods, relative to the best one's: x = 2 pi (T / T_best - 1).
  const double below = kTurn * (std::exp2(kCandidateOctaves) - 1);
  const double above = kTurn * (std::exp2(-kCandidateOctaves) - 1);
  const double rise = (strengths[0] - strengths[1]) / below;
  const double fall = (strengths[2] - strengths[1]) / above;
  const double square = (rise - fall) / (below - above);
  const double linear = rise - square * below;
  const int steps = static_cast<int>(std::round(2 * kCandidateOctaves / kFineOctaves + 1));
  int highest = 0;
  double height = -HUGE_VAL;
  for (int i = 0; i < steps; ++i) {
    const double x = kTurn * (std::exp2(kCandidateOctaves - i * kFineOctaves) - 1);
    const double y = (square * x + linear) * x;
    if (y > height) {
      height = y;
      highest = i;
    }
  }
  return std::exp2(tables.log2_min + static_cast<double>(best - 1) * kCandidateOctaves +
                   highest * kFineOctaves);
}

}  // namespace gestus::prosody
