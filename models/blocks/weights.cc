// Binding of the weights that several networks have in common.
#include "models/blocks/weights.h"

namespace gestus::models {

void BindLinear(Binder& binder, const std::string& name, std::int64_t out, std::int64_t in,
                LinearWeights* w) {
  binder.Bind({{name + ".weight", &w->weight, {out, in}}, {name + ".bias", &w->bias, {out}}});
}

void BindNorm(Binder& binder, const std::string& name, std::int64_t d, float eps, NormWeights* w) {
  binder.Bind({{name + ".weight", &w->gamma, {d}}, {name + ".bias", &w->beta, {d}}});
  w->eps = eps;
}

void BindLstmStack(Binder& binder, const std::string& name, std::int64_t layers, std::int64_t in,
                   std::int64_t hidden, std::vector<LstmWeights>* w) {
  w->resize(static_cast<std::size_t>(layers));
  for (std::size_t l = 0; l < w->size(); ++l) {
    LstmWeights& layer = (*w)[l];
    const std::string at = "_l" + std::to_string(l);
    binder.Bind({
        {name + ".weight_ih" + at, &layer.w_ih, {4 * hidden, l == 0 ? in : hidden}},
        {name + ".weight_hh" + at, &layer.w_hh, {4 * hidden, hidden}},
        {name + ".bias_ih" + at, &layer.b_ih, {4 * hidden}},
        {name + ".bias_hh" + at, &layer.b_hh, {4 * hidden}},
    });
  }
}

LinearWeights RowsOf(const LinearWeights& w, std::int64_t begin, std::int64_t count) {
  LinearWeights part = w;
  const std::int64_t in = w.weight.shape.rank() == 2 ? w.weight.shape[1] : 0;
  part.weight.shape = {count, in};
  part.weight.data = w.weight.f32() + begin * in;
  if (w.bias.data != nullptr) {
    part.bias.shape = {count};
    part.bias.data = w.bias.f32() + begin;
  }
  return part;
}

}  // namespace gestus::models
