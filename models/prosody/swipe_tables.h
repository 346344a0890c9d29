// What SWIPE' knows before it hears anything: candidates, bands, windows and the kernel of each
// candidate.  A private header.  Constants and their digits are those of the programs in use.
#ifndef GESTUS_MODELS_PROSODY_SWIPE_TABLES_H_
#define GESTUS_MODELS_PROSODY_SWIPE_TABLES_H_

#include <cstddef>
#include <vector>

#include "models/prosody/swipe.h"

namespace gestus::prosody {

inline constexpr double kCandidateOctaves = 0.0104167;  // 1/96 octave between candidates
inline constexpr double kBandErbs = 0.1;                // between bands
inline constexpr double kFineOctaves = 0.0013028;       // between the values that f0 may take

/// The candidates [first, first + weight.size()) that a window of `size` samples serves.
struct SwipeWindow {
  std::size_t size = 0, first = 0;
  std::vector<double> weight;
};

struct SwipeTables {
  double log2_min = 0;
  std::vector<double> candidates;    ///< Hz, ascending
  std::vector<double> bands;         ///< Hz, evenly spaced on the ERB scale
  std::vector<double> kernels;       ///< (candidates, bands), the positive part of a row of norm 1
  std::vector<SwipeWindow> windows;  ///< powers of two, each half the one before
};

SwipeTables MakeSwipeTables(const SwipeOptions& options);

/// Where the parabola through the strengths below, at and above candidate `best` is highest, in Hz.
double FinePitch(const SwipeTables& tables, std::size_t best, const double strengths[3]);

}  // namespace gestus::prosody

#endif  // GESTUS_MODELS_PROSODY_SWIPE_TABLES_H_
