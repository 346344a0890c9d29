// The networks of ZS-MSTM as graphs.  S = context segments, T = frames of a segment.
#ifndef GESTUS_MODELS_ZS_MSTM_NETWORKS_H_
#define GESTUS_MODELS_ZS_MSTM_NETWORKS_H_

#include "models/zs_mstm/config.h"

namespace gestus::models {

/// E_content: speech (S * T, mel), text (S * T, d_text), both normalised -> h_content
/// (rows, speech + text).  Thesis 6.5.1, eq. 6.1.
Value ContentEncoder(Graph& g, const ZsMstmConfig& c, const ZsMstmWeights& w, Value speech,
                     Value text);

/// What E_style sees of one segment, normalised: speech (T, mel), text (T, d_text), pose (T,
/// d_pose) and, in 2.0, face (T, d_face) and tags (1, d_tags).
struct StyleInputs {
  Value speech, text, pose, face, tags;
};

/// E_style: one segment -> h_style (1, StyleWidth()).  Thesis 6.5.2, eq. 6.2; 7.3.2, eq. 7.1.
Value StyleEncoder(Graph& g, const ZsMstmConfig& c, const ZsMstmWeights& w, const StyleInputs& x);

/// G, one of its decoders: h_content and h_style -> normalised poses or faces (S * T, columns).
/// Thesis 6.5.3, eq. 6.3.
Value Generator(Graph& g, const ZsMstmConfig& c, const GeneratorWeights& w, std::int64_t columns,
                Value h_content, Value h_style);

/// The two graphs that are run: inputs "speech", "text", "pose" (and "face", "tags") -> output
/// "style" ...
Graph StyleGraph(const ZsMstmConfig& c, const ZsMstmWeights& w);
/// ... and inputs "speech", "text", "style" -> outputs "pose" (and "face"), in their own units.
Graph GeneratorGraph(const ZsMstmConfig& c, const ZsMstmWeights& w);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_ZS_MSTM_NETWORKS_H_
