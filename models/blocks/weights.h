// Weights that several networks have in common, with PyTorch's names and layouts.
#ifndef GESTUS_MODELS_BLOCKS_WEIGHTS_H_
#define GESTUS_MODELS_BLOCKS_WEIGHTS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/binder.h"
#include "engine/graph.h"

namespace gestus::models {

/// `name`.weight (out, in) and `name`.bias (out).
void BindLinear(Binder& binder, const std::string& name, std::int64_t out, std::int64_t in,
                LinearWeights* w);
/// `name`.weight and `name`.bias (d).
void BindNorm(Binder& binder, const std::string& name, std::int64_t d, float eps, NormWeights* w);
/// Layers of torch.nn.LSTM: weight_ih_l0 (4H, in), weight_hh_l0 (4H, H), bias_ih_l0, bias_hh_l0,
/// ...
void BindLstmStack(Binder& binder, const std::string& name, std::int64_t layers, std::int64_t in,
                   std::int64_t hidden, std::vector<LstmWeights>* w);

/// One layer of torch.nn.LSTM(bidirectional=True): the names above, and the same with "_reverse".
struct BiLstmWeights {
  LstmWeights forward, backward;
};
void BindLstm(Binder& binder, const std::string& name, std::int64_t in, std::int64_t hidden,
              LstmWeights* w);
void BindBiLstm(Binder& binder, const std::string& name, std::int64_t in, std::int64_t hidden,
                BiLstmWeights* w);

/// Outputs [begin, begin + count) of a linear layer.
LinearWeights RowsOf(const LinearWeights& w, std::int64_t begin, std::int64_t count);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_BLOCKS_WEIGHTS_H_
