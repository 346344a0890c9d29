// .style files: .npz archives with the arrays of models/styles/style.h.
#ifndef GESTUS_MODELS_CLI_STYLE_FILE_H_
#define GESTUS_MODELS_CLI_STYLE_FILE_H_

#include <string>

#include "engine/status.h"
#include "models/io/file.h"
#include "models/styles/style.h"

namespace gestus::cli {

/// Whether an .npz is a .style file.
Result<bool> IsStyleFile(const std::string& path);

/// Errors begin with the path.
Result<styles::Style> ReadStyleFile(const std::string& path);

/// Writes and commits `file`, which was created at `path`; errors begin with the path.
Status WriteStyleFile(const styles::Style& style, const std::string& path, AtomicFile* file);

/// The last part of a path, without a slash at its end: "anna" of "clips/anna/".
std::string LastPart(std::string path);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_STYLE_FILE_H_
