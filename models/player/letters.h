// Letters as strokes of a pen, for pictures without a font.  A private header of models/player.
#ifndef GESTUS_MODELS_PLAYER_LETTERS_H_
#define GESTUS_MODELS_PLAYER_LETTERS_H_

#include <vector>

#include "models/player/drawing.h"

namespace gestus::player {

/// Strokes of a letter in a box from 0 to 1, y down; none for what is not known.
std::vector<std::vector<Vec2>> StrokesOf(char letter);

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_LETTERS_H_
