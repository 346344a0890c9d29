// AST's configuration and tensors, under the names of the published checkpoints.
#include "models/blocks/weights.h"

#include "models/ast/ast.h"
#include "models/config.h"
#include "weights_generated.h"

namespace gestus::models {

Result<AstConfig> ReadAstConfig(const fb::AstConfig& f, const std::string& where) {
  ConfigReader read(where);
  AstConfig c;
  c.frames = read.Size("frames", f.frames(), 1, 1 << 14);
  c.mel_bins = read.Size("mel_bins", f.mel_bins(), 1, 1 << 10);
  c.patch = read.Size("patch", f.patch(), 1, std::min(c.frames, c.mel_bins));
  c.stride = read.Size("stride", f.stride(), 1, c.patch);
  c.d_model = read.Size("d_model", f.d_model(), 1, 1 << 14);
  c.layers = read.Size("layers", f.layers(), 1, 256);
  c.heads = read.Divisor("heads", f.heads(), c.d_model, "d_model");
  c.d_mlp = read.Size("d_mlp", f.d_mlp(), 1, 1 << 16);
  c.pool = read.Enum<AstPool>("pool", f.pool(), fb::AstPool::MAX);
  c.head = read.Enum<AstHead>("head", f.head(), fb::AstHead::MAX);
  c.d_out = c.head == AstHead::kNone ? c.d_model : read.Size("d_out", f.d_out(), 1, 1 << 16);
  c.ln_eps = read.Epsilon("ln_eps", f.ln_eps());
  c.head_ln_eps = read.Epsilon("head_ln_eps", f.head_ln_eps());
  if (!read.status().ok()) return read.status();
  return c;
}

void BindAst(Binder& binder, const AstConfig& c, AstWeights* w) {
  const std::int64_t d = c.d_model, p = c.patch;
  binder.Bind({
      {"v.cls_token", &w->cls, {1, 1, d}},
      {"v.dist_token", &w->dist, {1, 1, d}},
      {"v.pos_embed", &w->positions, {1, 2 + c.Patches(), d}},
      {"v.patch_embed.proj.weight", &w->patch.weight, {d, 1, p, p}, Binder::kProduct},
      {"v.patch_embed.proj.bias", &w->patch.bias, {d}},
  });
  w->cls.shape = w->dist.shape = {1, d};
  w->positions.shape = {2 + c.Patches(), d};
  w->patch.weight.shape = {d, p * p};
  w->blocks.resize(static_cast<std::size_t>(c.layers));
  for (std::size_t i = 0; i < w->blocks.size(); ++i) {
    AstWeights::Block& b = w->blocks[i];
    const Binder::Scope scope(binder, "v.blocks." + std::to_string(i) + ".");
    BindNorm(binder, "norm1", d, c.ln_eps, &b.norm1);
    BindLinear(binder, "attn.qkv", 3 * d, d, &b.qkv);
    BindLinear(binder, "attn.proj", d, d, &b.proj);
    BindNorm(binder, "norm2", d, c.ln_eps, &b.norm2);
    BindLinear(binder, "mlp.fc1", c.d_mlp, d, &b.fc1);
    BindLinear(binder, "mlp.fc2", d, c.d_mlp, &b.fc2);
  }
  BindNorm(binder, "v.norm", d, c.ln_eps, &w->norm);
  if (c.head == AstHead::kLayerNormLinear)
    BindNorm(binder, "mlp_head.0", d, c.head_ln_eps, &w->head_norm);
  if (c.head != AstHead::kNone) BindLinear(binder, "mlp_head.1", c.d_out, d, &w->head);
}

}  // namespace gestus::models
