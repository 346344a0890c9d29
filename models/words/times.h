// Times as transcripts write them.  A private header of models/words.
#ifndef GESTUS_MODELS_WORDS_TIMES_H_
#define GESTUS_MODELS_WORDS_TIMES_H_

#include <limits>
#include <string_view>

namespace gestus::words {

/// A time that the file does not give.
inline constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

/// Whether all of `text`, blanks around it aside, is a time, which goes to `seconds`: "1.25",
/// "1,25", "1.25s", "1250ms", "00:00:01,250", "00:01.25".  Never depends on the locale; never NaN
/// or infinite.
bool ParseTime(std::string_view text, double* seconds);

/// Whether `text` stands where a time is not known: empty, "nan", "none", "null", "na" or "-".
bool IsNoTime(std::string_view text);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_TIMES_H_
