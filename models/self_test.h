// The self-test that a weights file carries: a small input and the result its maker expects.
#ifndef GESTUS_MODELS_SELF_TEST_H_
#define GESTUS_MODELS_SELF_TEST_H_

#include "engine/binder.h"
#include "models/network.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::models {

/// Tells the binder that the self-test's tensors are no weights.
void UseSelfTest(Binder& binder, const fb::Network& network);

struct SelfTestReport {
  bool present = false;
  double relative_error = 0;  ///< max |got - want| / max |want|
  double tolerance = 0;
  bool passed() const { return present && relative_error <= tolerance; }
};

/// Runs the self-test of `network`, which was made from `file` under `name`.
Result<SelfTestReport> RunSelfTest(const WeightsFile& file, const std::string& name,
                                   Network& network, const RunOptions& options = {});

}  // namespace gestus::models

#endif  // GESTUS_MODELS_SELF_TEST_H_
