// Pitch of words: rows of f0 to the `f0` input of Model 1 and Model 2, (words, values), with the
// unvoiced parts of each word filled in (thesis 4.1.6, 5.3 and 5.6.2).
#ifndef GESTUS_MODELS_PROSODY_CONTOUR_H_
#define GESTUS_MODELS_PROSODY_CONTOUR_H_

#include <cstddef>
#include <string>
#include <vector>

#include "engine/status.h"

namespace gestus::prosody {

/// Seconds [start, end) since the start of the recording.
struct WordSpan {
  double start = 0, end = 0;
};

/// Before the first and behind the last voiced value of a word.
enum class ContourEnds {
  kNearest,  ///< that value
  kLinear,   ///< the line through the two voiced values nearest to the end, within the range
};

struct ContourOptions {
  double hop_seconds = 0.010;  ///< of the f0 rows
  std::size_t values = 100;    ///< of a word: longer ones are cut, shorter end in zeros
  ContourEnds ends = ContourEnds::kNearest;
  double min_hz = 50, max_hz = 550;  ///< what kLinear stays within
};

struct WordContours {
  std::vector<float> hz;           ///< (words, values); 0 behind the word's end
  std::vector<std::size_t> count;  ///< values of each word, before the zeros
  std::vector<std::string> notes;  ///< what a user may want to know, one line each
};

/// `f0` holds `rows` values in Hz, `stride` apart; what is not above 0, or not finite, is unvoiced.
/// Row j belongs to a word when start <= j hop < end.  Within a word, values between voiced ones
/// lie on the line between them; a word without a voiced value is all 0.  Words may overlap, be
/// empty, in any order, or outside the recording.  An error names the first whose times are not
/// finite, negative or reversed.
Result<WordContours> ContoursOfWords(const float* f0, std::size_t rows, std::size_t stride,
                                     const std::vector<WordSpan>& words,
                                     const ContourOptions& options = {});

}  // namespace gestus::prosody

#endif  // GESTUS_MODELS_PROSODY_CONTOUR_H_
