// Motion into the files of other programs: --export FORMAT=PATH of a run, and `infer-cli export`
// for what an earlier run wrote.
#ifndef GESTUS_MODELS_CLI_EXPORT_H_
#define GESTUS_MODELS_CLI_EXPORT_H_

#include <string>
#include <vector>

#include "engine/status.h"
#include "models/cli/args.h"
#include "models/outputs/formats.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::cli {

struct Exports {
  struct File {
    outputs::Format format = outputs::Format::kCsv;
    std::string path;
  };
  std::vector<File> files;
  outputs::FormatOptions options;

  /// "bvh: wave.bvh", a line each.
  std::vector<std::string> Lines() const;
};

/// What the command line asks for.  Errors: a format that is unknown; a path that two of all
/// outputs, or an input and an output other than --output, would have.
Result<Exports> ParseExports(const Arguments& arguments);

/// An error where the network makes no motion or what it makes does not suit a format: told before
/// anything is computed.
Status CheckExports(const fb::Network& record, const Exports& exports);

/// Writes every file, when all formats suit; the first that cannot be written ends it.
Status WriteExports(const outputs::Motion& motion, const Exports& exports);

Status RunExport(const Arguments& arguments);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EXPORT_H_
