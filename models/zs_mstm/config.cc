// Reads and checks ZS-MSTM's configuration, and binds its tensors.
#include "models/zs_mstm/config.h"

#include <tuple>

#include "models/blocks/weights.h"
#include "models/config.h"
#include "models/self_test.h"
#include "weights_generated.h"

namespace gestus::models {

Result<ZsMstmConfig> ReadZsMstmConfig(const fb::Network& network) {
  const std::string where = "network " + network.name()->str();
  const fb::ZsMstm2Config* second = network.config_as_ZsMstm2Config();
  const fb::ZsMstm1Config& f =
      second != nullptr ? *second->core() : *network.config_as_ZsMstm1Config();
  ConfigReader read(where);
  ZsMstmConfig c;
  if (second != nullptr) {
    c.d_face = read.Size("d_face", second->d_face(), 1, 1 << 10);
    c.d_tags = read.Size("d_tags", second->d_tags(), 1, 1 << 10);
    c.dense_shared = second->dense_shared();
  }
  c.frames = read.Size("frames", f.frames(), 1, 1 << 12);
  c.d_text = read.Size("d_text", f.d_text(), 1, 1 << 14);
  c.d_pose = read.Size("d_pose", f.d_pose(), 1, 1 << 10);
  c.d_model = read.Size("d_model", f.d_model(), 1, 1 << 14);
  c.ast_shared = f.ast_shared();
  c.lstm_layers = read.Size("lstm_layers", f.lstm_layers(), 1, 32);
  c.lstm_hidden = read.Size("lstm_hidden", f.lstm_hidden(), 1, 1 << 13);
  c.decoder_layers = read.Size("decoder_layers", f.decoder_layers(), 1, 64);
  c.decoder_ff = read.Size("decoder_ff", f.decoder_ff(), 1, 1 << 16);
  c.decoder_heads =
      static_cast<int>(read.Divisor("decoder_heads", f.decoder_heads(), c.d_model, "d_model"));
  c.decoder_ln_eps = read.Epsilon("decoder_ln_eps", f.decoder_ln_eps());
  c.granularity = read.Enum<Granularity>("granularity", f.granularity(), fb::Granularity::MAX);
  c.context_segments = read.Size("context_segments", f.context_segments(), 1,
                                 c.granularity == Granularity::kFrame ? 1 : 64);
  c.style_pool = read.Enum<StylePool>("style_pool", f.style_pool(), fb::StylePool::MAX);
  c.decoder_mode = read.Enum<DecoderMode>("decoder_mode", f.decoder_mode(), fb::DecoderMode::MAX);
  c.positions =
      read.Enum<PositionalEncoding>("positions", f.positions(), fb::PositionalEncoding::MAX);
  read.Enum<int>("pose_source", f.pose_source(), fb::PoseSource::MAX);
  c.frame_rate = read.Rate("frame_rate", f.frame_rate());
  if (!c.ast_shared && f.ast_style() == nullptr)
    read.Fail("ast_style", "absent", "a configuration unless ast_shared");
  GESTUS_RETURN_IF_ERROR(read.status());

  const Result<AstConfig> content = ReadAstConfig(*f.ast_content(), where + ": ast_content");
  if (!content.ok()) return content.status();
  const Result<AstConfig> style =
      c.ast_shared ? content : ReadAstConfig(*f.ast_style(), where + ": ast_style");
  if (!style.ok()) return style.status();
  c.ast_content = *content;
  c.ast_style = *style;
  for (const AstConfig* ast : {&c.ast_content, &c.ast_style}) {
    if (ast->frames != c.frames)
      read.Fail("ast frames", std::to_string(ast->frames),
                "those of a segment, " + std::to_string(c.frames));
  }
  if (c.ast_content.mel_bins != c.ast_style.mel_bins)
    read.Fail("ast_style mel_bins", std::to_string(c.ast_style.mel_bins), "those of ast_content");
  c.attention_heads = static_cast<int>(
      read.Divisor("attention_heads", f.attention_heads(), c.ContentWidth(), "speech + text"));
  read.Divisor("attention_heads", f.attention_heads(), c.StyleAttentionWidth(), "text + speech");
  GESTUS_RETURN_IF_ERROR(read.status());

  struct Stream {
    const char* name;
    Normalisation* to;
    std::int64_t columns;
  };
  for (const Stream& s :
       {Stream{"speech", &c.speech, c.ast_content.mel_bins}, Stream{"text", &c.text, c.d_text},
        Stream{"pose", &c.pose, c.d_pose}, Stream{"face", &c.face, c.d_face}}) {
    Result<Normalisation> n = ReadNormalisation(network, s.name, s.columns);
    if (!n.ok()) return n.status();
    *s.to = *std::move(n);
  }
  return c;
}

namespace {

void BindDense(Binder& binder, const ZsMstmConfig& c, LinearWeights* w) {
  BindLinear(binder, "dense", c.d_model, c.ContentWidth() + c.StyleWidth(), w);
}

/// A decoder that puts out `columns` values a frame.
void BindGenerator(Binder& binder, const ZsMstmConfig& c, std::int64_t columns,
                   const char* embedding, bool own_dense, GeneratorWeights* w) {
  if (own_dense) BindDense(binder, c, &w->dense);
  if (c.decoder_mode == DecoderMode::kAutoregressive)
    BindLinear(binder, embedding, c.d_model, c.Row(columns), &w->embedding);
  w->decoder.resize(static_cast<std::size_t>(c.decoder_layers));
  for (std::size_t i = 0; i < w->decoder.size(); ++i) {
    BindDecoderLayer(binder, "decoder.layers." + std::to_string(i), c.d_model, c.decoder_ff,
                     c.decoder_ln_eps, &w->decoder[i]);
  }
  BindLinear(binder, "head", c.Row(columns), c.d_model, &w->head);
}

}  // namespace

void BindZsMstm(Binder& binder, const ZsMstmConfig& c, ZsMstmWeights* w) {
  {
    const Binder::Scope scope(binder, "ast_content.");
    BindAst(binder, c.ast_content, &w->ast_content);
  }
  if (c.ast_shared) {
    w->ast_style = w->ast_content;
  } else {
    const Binder::Scope scope(binder, "ast_style.");
    BindAst(binder, c.ast_style, &w->ast_style);
  }
  BindMultihead(binder, "content_attention", c.ContentWidth(), &w->content_attention);
  BindMultihead(binder, "style_attention", c.StyleAttentionWidth(), &w->style_attention);
  BindLstmStack(binder, "pose_lstm", c.lstm_layers, c.d_pose, c.lstm_hidden, &w->pose_lstm);
  if (!c.HasFace()) return BindGenerator(binder, c, c.d_pose, "pose_embedding", true, &w->pose);

  BindLstmStack(binder, "face_lstm", c.lstm_layers, c.d_face, c.lstm_hidden, &w->face_lstm);
  if (c.dense_shared) BindDense(binder, c, &w->pose.dense);
  w->face.dense = w->pose.dense;
  for (auto [name, columns, generator] : {std::tuple("pose_generator.", c.d_pose, &w->pose),
                                          std::tuple("face_generator.", c.d_face, &w->face)}) {
    const Binder::Scope scope(binder, name);
    BindGenerator(binder, c, columns, "embedding", !c.dense_shared, generator);
  }
}

Status LoadZsMstm(const WeightsFile& file, const fb::Network& network, ZsMstmConfig* c,
                  ZsMstmWeights* w) {
  Result<ZsMstmConfig> config = ReadZsMstmConfig(network);
  if (!config.ok()) return config.status().In(file.path());
  *c = *std::move(config);
  Binder binder(file, network.prefix()->str());
  BindZsMstm(binder, *c, w);
  UseSelfTest(binder, network);
  return binder.Finish();
}

}  // namespace gestus::models
