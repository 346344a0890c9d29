// A style, h_style of ZS-MSTM (thesis eq. 6.2 and 7.1), as a thing of its own: its values, the
// parts they fall into, whose weights they belong to and what it was made of.
#ifndef GESTUS_MODELS_STYLES_STYLE_H_
#define GESTUS_MODELS_STYLES_STYLE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/network.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::styles {

/// A stretch of a style's values.
struct Part {
  std::string name;  ///< "speech and text", "pose", "face", "dialog acts"
  std::int64_t begin = 0, width = 0;
};

/// A clip that a style was taken from.
struct Source {
  std::string name;
  double share = 1;           ///< of the style; all of them add up to 1
  std::int64_t segments = 0;  ///< of the clip
};

struct Style {
  std::vector<float> values;
  std::uint64_t weights_checksum = 0;
  std::string network;          ///< in the weights file; empty: not known
  std::vector<Part> parts;      ///< empty: not known
  std::vector<Source> made_of;  ///< empty: not known
};

/// The parts of the styles of `network`: [sa([X_text, E_speech]), E_pose] and in 2.0
/// [.., E_face, X_tags].  Speech and text are one part, for sa mixes them.  Errors: a network
/// without styles.
Result<std::vector<Part>> PartsOf(const fb::Network& network);

/// The arrays of a .style file: `style`, `weights_checksum` (its lower and upper 32 bits), and
/// where they are known `network`, `parts` (four widths), `made_of`, `made_of_share` and
/// `made_of_segments`.  Text is UTF-8, a byte for each int32; names end with 0.
models::Arrays ArraysOf(const Style& style);
/// What ArraysOf makes; `style` and `weights_checksum` are required.
std::vector<models::ArraySpec> StyleSpecs();
/// The style in arrays that have been read by StyleSpecs; errors name the array.
Result<Style> StyleOf(const models::Arrays& arrays);

/// "24e6e1830e635f1c", as `infer-cli info` shows it.
std::string ChecksumText(std::uint64_t checksum);

struct Named {
  std::string name;
  Style style;
};
/// All styles have as many values by the same weights and network, or an error that names two.
Status CheckAlike(const std::vector<Named>& styles);

}  // namespace gestus::styles

#endif  // GESTUS_MODELS_STYLES_STYLE_H_
