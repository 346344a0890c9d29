// What follows the readers of motion in a run, and what it may rely on.
#ifndef GESTUS_TESTS_FUZZ_MOTION_CHECKS_H_
#define GESTUS_TESTS_FUZZ_MOTION_CHECKS_H_

#include <cmath>

#include "models/motion/clean.h"
#include "models/motion/resample.h"
#include "tests/fuzz/fuzz.h"

namespace gestus::fuzz {

inline void RequireFinite(const motion::Track& track) {
  Require(std::ssize(track.values) == track.frames * track.columns(), "values of every frame");
  Require(std::ssize(track.confidence) == track.frames * track.point_count(),
          "a confidence for every point");
  for (const float v : track.values) Require(std::abs(v) <= 1e6f, "values within a million");
  for (const float c : track.confidence) Require(c >= 0 && c <= 1, "confidence from 0 to 1");
}

inline void Prepare(motion::Track* track, motion::CleanOrder order) {
  RequireFinite(*track);
  Require(motion::Clean(track, {.order = order}).ok(), "what was read can be cleaned");
  RequireFinite(*track);
  const auto resampled = motion::Resample(*track, 15);
  Require(resampled.ok(), "what was read can be resampled");
  RequireFinite(*resampled);
}

}  // namespace gestus::fuzz

#endif  // GESTUS_TESTS_FUZZ_MOTION_CHECKS_H_
