// What every reader of text files starts from: a bounded file in memory, numbers that no locale
// touches, and JSON that is checked field by field.
#ifndef GESTUS_MODELS_IO_READING_H_
#define GESTUS_MODELS_IO_READING_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/status.h"

namespace gestus {

/// The content of a regular file of at most `max_bytes`.  Errors begin with the path.
Result<std::string> ReadFile(const std::string& path, std::uint64_t max_bytes);

/// Whether all of `text`, blanks around it aside, is one finite decimal number ("-1.5e3"; no hex,
/// no "nan", no comma), which goes to `value`.
bool ParseNumber(std::string_view text, double* value);

/// `text` without blanks (space, tab, CR, LF) at its ends.
std::string_view Trim(std::string_view text);

}  // namespace gestus

#endif  // GESTUS_MODELS_IO_READING_H_
