// Numbers of PATS' joints that exporters tell apart.
#ifndef GESTUS_MODELS_OUTPUTS_JOINTS_H_
#define GESTUS_MODELS_OUTPUTS_JOINTS_H_

#include <cstdint>

namespace gestus::outputs {

constexpr std::int64_t kRElbow = 2, kRWrist = 3, kLElbow = 5, kLWrist = 6, kNose = 7;

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_JOINTS_H_
