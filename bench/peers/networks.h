// The networks of bench/peers as graphs: those of gestus, and the parts of them that the comparison
// runs on their own.
#ifndef GESTUS_BENCH_PEERS_NETWORKS_H_
#define GESTUS_BENCH_PEERS_NETWORKS_H_

#include <cstdint>
#include <functional>
#include <string>

#include "engine/graph.h"
#include "engine/status.h"
#include "engine/weights_file.h"
#include "models/model2/model2.h"

namespace gestus::bench {

/// How many values the input of that name has.
using InputSize = std::function<std::int64_t(const std::string& name)>;

/// Declares the only network of `file`, with inputs as long as `size` says.  What is declared
/// follows from the type of its configuration:
///
///   Ast          speech (frames, mel bins) -> embedding
///   Bert         ids (T,) with [CLS] and [SEP] in place -> hidden
///   Classifier   its LSTMs alone: x (T, d_in) -> rows
///   Model1       its E_text alone: text (T, d_text) -> h_text
///   ZsMstm1      dense, decoder and head of its generator, all frames at once:
///                content (T, d_content), style (1, d_style) -> pose
///   Model2       f0 tokens of one word, text (W, d_text), tokens (channels, T) -> logits of each
///                channel for every position, with the tokens before it given (teacher forcing)
///
/// Tensors that this does not need may be absent from `file`.
Result<Graph> DeclareNetwork(const WeightsFile& file, const InputSize& size);

/// The case of Model 2.
Graph Model2Pass(const models::Model2Config& c, const models::Model2Weights& w,
                 const InputSize& size);

}  // namespace gestus::bench

#endif  // GESTUS_BENCH_PEERS_NETWORKS_H_
