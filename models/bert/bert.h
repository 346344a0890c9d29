// BERT (Devlin et al. 2019) as X_text's encoder, and DistilBERT (Sanh et al. 2019) with a
// classifier as the source of dialog acts (thesis 4.1.4, 7.3).
#ifndef GESTUS_MODELS_BERT_BERT_H_
#define GESTUS_MODELS_BERT_BERT_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/binder.h"
#include "engine/graph.h"
#include "models/blocks/attention.h"
#include "models/network.h"

namespace gestus::fb {
struct BertConfig;
}

namespace gestus::models {

enum class BertHead { kNone, kClassifier };

struct BertConfig {
  std::int64_t layers = 12, d_model = 768, heads = 12, d_mlp = 3072;
  std::int64_t tokens = 30522;   ///< size of the vocabulary
  std::int64_t positions = 512;  ///< longest sequence
  std::int64_t types = 2;        ///< 0: none, as in DistilBERT
  float ln_eps = 1e-12f;
  BertHead head = BertHead::kNone;
  std::vector<std::string> labels;  ///< of the classes
  std::int32_t cls = 101,
               sep = 102;  ///< tokens around a sequence; the vocabulary's when it is there

  /// Pieces that fit between [CLS] and [SEP].
  std::int64_t MaxPieces() const { return positions - 2; }
};

struct BertWeights {
  struct Layer {
    AttentionWeights attention;
    NormWeights attention_norm, output_norm;
    LinearWeights intermediate, output;  // (d_mlp, D), (D, d_mlp)
  };
  TensorView words, positions, types;  // (tokens, D), (positions, D), (types, D)
  NormWeights norm;
  std::vector<Layer> layers;
  LinearWeights pre_classifier, classifier;  // (D, D), (labels, D)
};

Result<BertConfig> ReadBertConfig(const fb::BertConfig& config, const std::string& where);
/// Binds Hugging Face's names, without "bert.".
void BindBert(Binder& binder, const BertConfig& c, BertWeights* w);
/// ids (T,) int32 with [CLS] and [SEP] -> hidden states of the last layer (T, D).
Value Bert(Graph& g, const BertConfig& c, const BertWeights& w, Value ids);
/// hidden (T, D) -> probabilities of the classes (1, labels).
Value BertClassifier(Graph& g, const BertWeights& w, Value hidden);

/// Input `ids` (sequences, pieces) int32; outputs `hidden`, or `probabilities` and `act`.
Result<std::unique_ptr<Network>> MakeBertNetwork(std::shared_ptr<const WeightsFile> file,
                                                 const std::string& name,
                                                 const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_BERT_BERT_H_
