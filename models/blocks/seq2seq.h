// The LSTM encoder and decoder of chapter 5, as Keras computes them: LeakyReLU on the output of
// each layer, the recurrent state untouched.
#ifndef GESTUS_MODELS_BLOCKS_SEQ2SEQ_H_
#define GESTUS_MODELS_BLOCKS_SEQ2SEQ_H_

#include <cstdint>
#include <string>

#include "models/blocks/weights.h"

namespace gestus::models {

/// What an encoder hands over: its last step, or every step.
enum class AeCode { kVector, kSequence };

/// Two bidirectional layers, of h1 and h2 units a direction.
struct EncoderWeights {
  BiLstmWeights lstm1, lstm2;
};
/// Two layers, of h1 and h2 units.
struct DecoderWeights {
  LstmWeights lstm1, lstm2;
};

void BindEncoder(Binder& binder, const std::string& name, std::int64_t in, std::int64_t h1,
                 std::int64_t h2, EncoderWeights* w);
void BindDecoder(Binder& binder, const std::string& name, std::int64_t in, std::int64_t h1,
                 std::int64_t h2, DecoderWeights* w);

/// x (T, in) -> (1, 2 * h2) or (T, 2 * h2).  The last step is Keras': the forward direction's after
/// the last row, the backward direction's after the first.
Value Encode(Graph& g, const EncoderWeights& w, float alpha, AeCode code, Value x);

/// h (1, in), repeated, or (length, in) -> (length, h2).
Value Decode(Graph& g, const DecoderWeights& w, float alpha, std::int64_t length, Value h);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_BLOCKS_SEQ2SEQ_H_
