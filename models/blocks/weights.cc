// Binding of the weights that several networks have in common.
#include "models/blocks/weights.h"

namespace gestus::models {

void BindLinear(Binder& binder, const std::string& name, std::int64_t out, std::int64_t in,
                LinearWeights* w) {
  binder.Bind({{name + ".weight", &w->weight, {out, in}, Binder::kProduct},
               {name + ".bias", &w->bias, {out}}});
}

void BindNorm(Binder& binder, const std::string& name, std::int64_t d, float eps, NormWeights* w) {
  binder.Bind({{name + ".weight", &w->gamma, {d}}, {name + ".bias", &w->beta, {d}}});
  w->eps = eps;
}

namespace {

/// `suffix` is what PyTorch puts behind the names: "_l1", "_l0_reverse".
void BindLstmLayer(Binder& binder, const std::string& name, const std::string& suffix,
                   std::int64_t in, std::int64_t hidden, LstmWeights* w) {
  binder.Bind({
      {name + ".weight_ih" + suffix, &w->w_ih, {4 * hidden, in}, Binder::kProduct},
      {name + ".weight_hh" + suffix, &w->w_hh, {4 * hidden, hidden}, Binder::kProduct},
      {name + ".bias_ih" + suffix, &w->b_ih, {4 * hidden}},
      {name + ".bias_hh" + suffix, &w->b_hh, {4 * hidden}},
  });
}

}  // namespace

void BindLstm(Binder& binder, const std::string& name, std::int64_t in, std::int64_t hidden,
              LstmWeights* w) {
  BindLstmLayer(binder, name, "_l0", in, hidden, w);
}

void BindBiLstm(Binder& binder, const std::string& name, std::int64_t in, std::int64_t hidden,
                BiLstmWeights* w) {
  BindLstmLayer(binder, name, "_l0", in, hidden, &w->forward);
  BindLstmLayer(binder, name, "_l0_reverse", in, hidden, &w->backward);
}

void BindLstmStack(Binder& binder, const std::string& name, std::int64_t layers, std::int64_t in,
                   std::int64_t hidden, std::vector<LstmWeights>* w) {
  w->resize(static_cast<std::size_t>(layers));
  for (std::size_t l = 0; l < w->size(); ++l)
    BindLstmLayer(binder, name, "_l" + std::to_string(l), l == 0 ? in : hidden, hidden, &(*w)[l]);
}

LinearWeights RowsOf(const LinearWeights& w, std::int64_t begin, std::int64_t count) {
  LinearWeights part = w;
  part.weight = w.weight.Rows(begin, count);
  if (w.bias.data != nullptr) {
    part.bias.shape = {count};
    part.bias.data = w.bias.f32() + begin;
  }
  return part;
}

}  // namespace gestus::models
