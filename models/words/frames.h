// Words on the frames of motion, as the PATS corpus places them (Ahuja et al. 2020, data/text.py):
// without gaps, from the first frame of an interval to its last.
#ifndef GESTUS_MODELS_WORDS_FRAMES_H_
#define GESTUS_MODELS_WORDS_FRAMES_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/words/transcript.h"

namespace gestus::words {

struct FrameOptions {
  double start = 0;        ///< seconds; where the interval begins
  std::size_t frames = 0;  ///< its length
  double rate = 15;        ///< frames a second
  /// Which words belong to the interval.  false: those that share time with it.  true: those that
  /// end in (start, end], the rule of PATS, where a word belongs to one interval only; the last
  /// word of a recording may then be lost to a frame that is not complete.
  bool by_end = false;
};

/// What a frame says; both -1 where there is no word at all.
struct FramePiece {
  std::int32_t word = -1;   ///< index into the words
  std::int32_t piece = -1;  ///< index into the pieces of the word
};

/// Frames [begin, end) of a word; none when the next one begins on the same frame.
struct WordFrames {
  std::size_t word;
  std::size_t begin, end;
};

struct FramePlan {
  std::vector<FramePiece> frames;  ///< one for each frame
  std::vector<WordFrames> words;   ///< those within the interval, in order
  std::vector<std::string> notes;  ///< what was left out, one plain line each
};

/// Places `words`, of which word i has `pieces[i]` pieces.  The first word begins at frame 0, each
/// other at int((its start - start) * rate), and ends where the next begins, the last at the end.
/// Of a word's d frames each of its n pieces gets int(d / n), and the last the remainder as well.
/// Words without pieces are left out.
Result<FramePlan> PlaceOnFrames(const std::vector<Word>& words,
                                const std::vector<std::size_t>& pieces,
                                const FrameOptions& options);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_FRAMES_H_
