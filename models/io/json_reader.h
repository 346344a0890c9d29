// JSON in memory, for readers of files that others wrote.  A private header: programs that embed
// gestus never see the library behind it.
#ifndef GESTUS_MODELS_IO_JSON_READER_H_
#define GESTUS_MODELS_IO_JSON_READER_H_

#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/status.h"

namespace gestus {

using Json = nlohmann::json;

/// Parses one JSON document, a byte order mark before it allowed.  The error says at which byte it
/// went wrong; the caller puts the path before it.
Result<Json> ParseJson(std::string_view text);

/// The member `name` of `object`; null when it is no object or has none.
const Json* Member(const Json& object, const char* name);

}  // namespace gestus

#endif  // GESTUS_MODELS_IO_JSON_READER_H_
