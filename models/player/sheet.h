// A contact sheet: figures over time above the sound and the words, as one SVG picture.
#ifndef GESTUS_MODELS_PLAYER_SHEET_H_
#define GESTUS_MODELS_PLAYER_SHEET_H_

#include <string>

#include "engine/status.h"
#include "models/player/show.h"

namespace gestus::player {

struct SheetOptions {
  double step = 0.4;      ///< seconds between figures
  double stave = 5.2;     ///< seconds of a row, at most
  int max_figures = 400;  ///< of a whole sheet; a longer motion has larger steps
};

/// The picture.  Its ground is transparent and its colours are of middle brightness, so that it
/// reads on light pages and on dark ones.  Errors: those of CheckShow().
Result<std::string> MakeSheet(const Show& show, const SheetOptions& options = {});

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_SHEET_H_
