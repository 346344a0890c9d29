// The networks of ZS-MSTM 1.0 as graphs.  S = context segments, T = frames of a segment.
#ifndef GESTUS_MODELS_ZS_MSTM1_NETWORKS_H_
#define GESTUS_MODELS_ZS_MSTM1_NETWORKS_H_

#include "models/zs_mstm1/config.h"

namespace gestus::models {

/// E_content: speech (S * T, mel), text (S * T, d_text), both normalised -> h_content
/// (rows, speech + text).  Thesis 6.5.1, eq. 6.1.
Value ContentEncoder(Graph& g, const ZsMstm1Config& c, const ZsMstm1Weights& w, Value speech,
                     Value text);

/// E_style: one segment of speech, text and pose -> h_style (1, text + speech + lstm_hidden).
/// Thesis 6.5.2, eq. 6.2.
Value StyleEncoder(Graph& g, const ZsMstm1Config& c, const ZsMstm1Weights& w, Value speech,
                   Value text, Value pose);

/// G: h_content and h_style -> normalised poses (S * T, d_pose).  Thesis 6.5.3, eq. 6.3.
Value Generator(Graph& g, const ZsMstm1Config& c, const ZsMstm1Weights& w, Value h_content,
                Value h_style);

/// The two graphs that are run: inputs "speech", "text", "pose" -> output "style" ...
Graph StyleGraph(const ZsMstm1Config& c, const ZsMstm1Weights& w);
/// ... and inputs "speech", "text", "style" -> output "pose", in the pose's own units.
Graph GeneratorGraph(const ZsMstm1Config& c, const ZsMstm1Weights& w);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_ZS_MSTM1_NETWORKS_H_
