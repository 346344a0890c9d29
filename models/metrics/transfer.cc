#include "models/metrics/transfer.h"

namespace gestus::metrics {

TransferStrength CountTransferred(std::span<const float> strengths) {
  TransferStrength transfer;
  for (const float strength : strengths) transfer.right += strength > kTargetStyle;
  transfer.total = static_cast<std::int64_t>(strengths.size());
  return transfer;
}

}  // namespace gestus::metrics
