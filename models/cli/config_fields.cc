// Configurations as text.  Every field of the schema has its line here, defaults included, so that
// what a file leaves unsaid is shown too.
#include "models/cli/info.h"
#include "models/cli/text.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

class FieldList {
 public:
  explicit FieldList(std::string prefix, Fields* fields)
      : prefix_(std::move(prefix)), fields_(fields) {}

  void Add(const char* name, const std::string& value) {
    fields_->emplace_back(prefix_ + name, value);
  }
  void Add(const char* name, const char* value) { Add(name, std::string(value)); }
  void Add(const char* name, std::uint32_t value) { Add(name, std::to_string(value)); }
  void Add(const char* name, float value) { Add(name, Significant(static_cast<double>(value), 3)); }
  void Add(const char* name, bool value) { Add(name, value ? "true" : "false"); }

 private:
  std::string prefix_;
  Fields* fields_;
};

void AddAst(const std::string& prefix, const fb::AstConfig& c, Fields* fields) {
  FieldList list(prefix, fields);
  list.Add("frames", c.frames());
  list.Add("mel_bins", c.mel_bins());
  list.Add("patch", c.patch());
  list.Add("stride", c.stride());
  list.Add("d_model", c.d_model());
  list.Add("layers", c.layers());
  list.Add("heads", c.heads());
  list.Add("d_mlp", c.d_mlp());
  list.Add("pool", fb::EnumNameAstPool(c.pool()));
  list.Add("head", fb::EnumNameAstHead(c.head()));
  list.Add("d_out", c.d_out());
  list.Add("ln_eps", c.ln_eps());
  list.Add("head_ln_eps", c.head_ln_eps());
}

void AddZsMstm1(const fb::ZsMstm1Config& c, Fields* fields) {
  FieldList list("", fields);
  list.Add("frames", c.frames());
  list.Add("frame_rate", c.frame_rate());
  list.Add("d_text", c.d_text());
  list.Add("d_pose", c.d_pose());
  list.Add("d_model", c.d_model());
  list.Add("attention_heads", c.attention_heads());
  list.Add("lstm_layers", c.lstm_layers());
  list.Add("lstm_hidden", c.lstm_hidden());
  list.Add("decoder_layers", c.decoder_layers());
  list.Add("decoder_heads", c.decoder_heads());
  list.Add("decoder_ff", c.decoder_ff());
  list.Add("decoder_ln_eps", c.decoder_ln_eps());
  list.Add("granularity", fb::EnumNameGranularity(c.granularity()));
  list.Add("context_segments", c.context_segments());
  list.Add("style_pool", fb::EnumNameStylePool(c.style_pool()));
  list.Add("decoder_mode", fb::EnumNameDecoderMode(c.decoder_mode()));
  list.Add("positions", fb::EnumNamePositionalEncoding(c.positions()));
  list.Add("pose_source", fb::EnumNamePoseSource(c.pose_source()));
  list.Add("ast_shared", c.ast_shared());
  AddAst("ast_content.", *c.ast_content(), fields);
  if (c.ast_style() != nullptr && !c.ast_shared()) AddAst("ast_style.", *c.ast_style(), fields);
}

}  // namespace

Fields ConfigFields(const fb::Network& network) {
  Fields fields;
  if (const auto* config = network.config_as_ZsMstm1Config()) AddZsMstm1(*config, &fields);
  if (const auto* config = network.config_as_AstConfig()) AddAst("", *config, &fields);
  return fields;
}

}  // namespace gestus::cli
