// Statistics from the weights file, applied as a scale and a shift by column.
#include "models/normalisation.h"

#include <cmath>

#include "weights_generated.h"

namespace gestus::models {
namespace {

// More than any network takes.  One value of a small file would otherwise be widened to gigabytes
// for who asks before the network's configuration was checked.
constexpr std::int64_t kMaxColumns = 1 << 16;

}  // namespace

Value Normalisation::Apply(Graph& g, Value x) const {
  if (mean.empty()) return x;
  std::vector<float> scale, shift;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    scale.push_back(1.0f / (divisor * deviation[i]));
    shift.push_back(-mean[i] * scale.back());
  }
  return g.Affine(x, scale, shift);
}

Value Normalisation::Undo(Graph& g, Value x) const {
  if (mean.empty()) return x;
  std::vector<float> scale;
  for (float d : deviation) scale.push_back(divisor * d);
  return g.Affine(x, scale, mean);
}

Result<Normalisation> ReadNormalisation(const fb::Network& network, const std::string& stream,
                                        std::int64_t columns) {
  Normalisation result;
  if (network.normalisations() == nullptr) return result;
  for (const fb::Normalisation* n : *network.normalisations()) {
    if (n->stream()->string_view() != stream) continue;
    const auto error = [&](const std::string& what) {
      return Status(Code::kBadWeights, "network " + network.name()->str() + ": normalisation of " +
                                           stream + ": " + what);
    };
    if (columns < 1 || columns > kMaxColumns)
      return error(std::to_string(columns) + " columns, expected 1 to " +
                   std::to_string(kMaxColumns));
    const std::size_t size = n->mean()->size();
    if (n->deviation()->size() != size || (size != 1 && size != static_cast<std::size_t>(columns)))
      return error(std::to_string(size) + " means and " + std::to_string(n->deviation()->size()) +
                   " deviations, expected 1 or " + std::to_string(columns) + " of both");
    result.divisor = n->divisor();
    if (!(result.divisor > 0) || !std::isfinite(result.divisor))
      return error("divisor must be positive");
    for (std::int64_t i = 0; i < columns; ++i) {
      const auto at = static_cast<flatbuffers::uoffset_t>(size == 1 ? 0 : i);
      result.mean.push_back(n->mean()->Get(at));
      result.deviation.push_back(n->deviation()->Get(at));
      const float scale = 1.0f / (result.divisor * result.deviation.back());
      if (!(result.deviation.back() > 0) || !std::isfinite(result.deviation.back()) ||
          !std::isfinite(result.mean.back()) || !std::isfinite(scale))
        return error("deviations must be positive and all values finite");
    }
    return result;
  }
  return result;
}

}  // namespace gestus::models
