// Greta's text files of MPEG-4 animation parameters.  A private header of their writers.
#ifndef GESTUS_MODELS_OUTPUTS_GRETA_FILE_H_
#define GESTUS_MODELS_OUTPUTS_GRETA_FILE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "models/motion/clip.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {

inline constexpr double kGretaRate = 25;  ///< frames per second; Greta knows no other

/// The curves of `motion` at Greta's rate, between frames by straight lines.
Result<Motion> CurvesAtGretasRate(const Motion& motion);

/// Of each frame one line says which parameters it sets and one their values.
class GretaFile {
 public:
  /// `used[n]` tells whether parameter n, from 1, is set.
  static Result<GretaFile> Create(const std::string& path, const std::string& name,
                                  std::int64_t frames, const std::vector<bool>& used);
  /// `values[n]` of parameter n; those that are not used are left alone.
  Status Add(std::int64_t frame, const std::vector<double>& values);
  Status Commit() { return file_.Commit(); }

 private:
  GretaFile(TextFile&& file, const std::vector<bool>& used) : file_(std::move(file)), used_(used) {}

  TextFile file_;
  std::vector<bool> used_;
};

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_GRETA_FILE_H_
