// Face and head as sequences of tokens: action units and angles on a grid of values (thesis 5.5.3,
// 5.6.2; released code of Model 2).  Token 0 pads, 1 starts, 2 ends a sequence, 3 + k is level k.
#ifndef GESTUS_MODELS_CHANNELS_H_
#define GESTUS_MODELS_CHANNELS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/config.h"
#include "models/network.h"

namespace gestus::fb {
struct Channel;
}  // namespace gestus::fb

namespace gestus::models {

inline constexpr std::int32_t kPadToken = 0, kStartToken = 1, kEndToken = 2, kFirstLevel = 3;

struct Channel {
  std::string name, unit;
  float minimum = 0, step = 0;  ///< value of level 0, distance of levels
  std::int64_t levels = 0;
  std::int64_t stack = 0;  ///< of the decoder that serves it (Model 2)

  std::int64_t Tokens() const { return kFirstLevel + levels; }
  /// The token of the level nearest to `value`: the lowest or the highest for what lies beyond
  /// them, kPadToken for what is not a number.
  std::int32_t TokenOf(float value) const;
  /// 0 for what is no level.
  float ValueOf(std::int32_t token) const {
    return token < kFirstLevel ? 0.0f : minimum + step * static_cast<float>(token - kFirstLevel);
  }
};

/// Adds one channel of a configuration, checked.
void ReadChannel(ConfigReader& read, const fb::Channel& channel, std::vector<Channel>* channels);

/// The outputs `tokens` (items, steps, channels), `face` of the same shape and `lengths` (items,
/// channels), and how they are described.
std::vector<ArraySpec> FaceSpecs(const std::vector<Channel>& channels, const std::string& items,
                                 std::int64_t steps);
/// Fills `face` and `lengths` from `tokens`: a length counts the tokens before the first that pads
/// or ends.
void AddFaces(const std::vector<Channel>& channels, Array tokens, Arrays* outputs);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_CHANNELS_H_
