// AE_speech and AE_face (thesis 5.5.1, 5.5.2): one sequence of f0, of an action unit or of an angle
// squeezed into a code and drawn from it again.
#ifndef GESTUS_MODELS_AUTOENCODER_AUTOENCODER_H_
#define GESTUS_MODELS_AUTOENCODER_AUTOENCODER_H_

#include <cstdint>
#include <memory>
#include <string>

#include "models/blocks/seq2seq.h"
#include "models/network.h"
#include "models/normalisation.h"

namespace gestus::models {

enum class AePart { kWhole, kEncoder, kDecoder };

struct AutoencoderConfig {
  std::int64_t length = 100;  ///< L
  std::int64_t hidden = 100;  ///< N_hid
  float alpha = 0.05f;        ///< of LeakyReLU
  AeCode code = AeCode::kVector;
  AePart part = AePart::kWhole;
  Normalisation values;

  bool Encodes() const { return part != AePart::kDecoder; }
  bool Decodes() const { return part != AePart::kEncoder; }
  std::int64_t CodeRows() const { return code == AeCode::kVector ? 1 : length; }
};

struct AutoencoderWeights {
  EncoderWeights encoder;
  DecoderWeights decoder;
  LinearWeights dense;  // (1, 2 N_hid)
};

/// E, eq. 5.1: x (L, 1) -> h (1, 2 N_hid), or (L, 2 N_hid) with the code a sequence.
Value AutoencoderEncoder(Graph& g, const AutoencoderConfig& c, const AutoencoderWeights& w,
                         Value x);
/// D, eq. 5.2: h -> x^ (L, 1).
Value AutoencoderDecoder(Graph& g, const AutoencoderConfig& c, const AutoencoderWeights& w,
                         Value h);

/// Inputs `values` (sequences, L), or `code` for a decoder alone; outputs `code`, `reconstruction`.
Result<std::unique_ptr<Network>> MakeAutoencoderNetwork(std::shared_ptr<const WeightsFile> file,
                                                        const std::string& name,
                                                        const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_AUTOENCODER_AUTOENCODER_H_
