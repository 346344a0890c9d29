// Channels from the weights file, and values from tokens.
#include "models/channels.h"

#include <algorithm>
#include <cmath>

#include "models/run_support.h"
#include "weights_generated.h"

namespace gestus::models {

std::int32_t Channel::TokenOf(float value) const {
  if (std::isnan(value)) return kPadToken;
  const double level = std::round((double{value} - double{minimum}) / double{step});
  const double top = static_cast<double>(levels - 1);
  return kFirstLevel + static_cast<std::int32_t>(std::clamp(level, 0.0, top));
}

void ReadChannel(ConfigReader& read, const fb::Channel& f, std::vector<Channel>* channels) {
  constexpr std::size_t kMaxChannels = 256;
  Channel c;
  c.name = f.name()->str();
  if (f.unit() != nullptr) c.unit = f.unit()->str();
  c.minimum = f.minimum();
  c.step = f.step();
  c.levels = read.Size("channels: levels", f.levels(), 1, 1 << 20);
  c.stack = read.Size("channels: stack", f.stack(), 0, kMaxChannels - 1);
  const double top = double{c.minimum} + double{c.step} * static_cast<double>(c.levels);
  if (!(c.step > 0) || !std::isfinite(c.minimum) || !(std::fabs(top) < 1e30))
    read.Fail("channels: step", std::to_string(c.step), "a positive step between finite values");
  if (channels->size() >= kMaxChannels)
    read.Fail("channels", "more than " + std::to_string(kMaxChannels), "a few");
  channels->push_back(std::move(c));
}

std::vector<ArraySpec> FaceSpecs(const std::vector<Channel>& channels, const std::string& items,
                                 std::int64_t steps) {
  const auto n = static_cast<std::int64_t>(channels.size());
  std::string names;
  for (const Channel& c : channels) names += (names.empty() ? "" : " ") + c.name;
  constexpr std::int64_t kAny = ArraySpec::kAny;
  ArraySpec tokens = Spec("tokens", {kAny, steps, n}, {items, "steps", "channels"},
                          "0 pads, 1 starts, 2 ends, 3 + k is level k", "the chosen levels");
  ArraySpec lengths = Spec("lengths", {kAny, n}, {items, "channels"}, "steps",
                           "steps before the first that pads or ends");
  tokens.dtype = lengths.dtype = DType::kI32;
  return {Spec("face", {kAny, steps, n}, {items, "steps", "channels"},
               "OpenFace: action units 0 to 5, angles in rad", "values of " + names),
          tokens, lengths};
}

void AddFaces(const std::vector<Channel>& channels, Array tokens, Arrays* outputs) {
  const std::size_t n = channels.size();
  const auto items = static_cast<std::size_t>(tokens.shape[0]);
  const auto steps = static_cast<std::size_t>(tokens.shape[1]);
  Array face = MakeArray(tokens.shape);
  Array lengths = MakeArray({tokens.shape[0], tokens.shape[2]}, DType::kI32);
  for (std::size_t item = 0; item < items; ++item) {
    for (std::size_t c = 0; c < n; ++c) {
      bool ended = false;
      for (std::size_t step = 0; step < steps; ++step) {
        const std::size_t at = (item * steps + step) * n + c;
        const std::int32_t token = tokens.i32[at];
        face.f32[at] = channels[c].ValueOf(token);
        ended = ended || token == kPadToken || token == kEndToken;
        lengths.i32[item * n + c] += !ended;
      }
    }
  }
  (*outputs)["tokens"] = std::move(tokens);
  (*outputs)["face"] = std::move(face);
  (*outputs)["lengths"] = std::move(lengths);
}

}  // namespace gestus::models
