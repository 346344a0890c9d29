// --html, --svg and --mp4: what a run made, to look at.
#ifndef GESTUS_MODELS_CLI_VIEWS_H_
#define GESTUS_MODELS_CLI_VIEWS_H_

#include <optional>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/cli/args.h"
#include "models/cli/inputs.h"
#include "models/cli/setup.h"
#include "models/io/file.h"
#include "models/network.h"
#include "models/outputs/motion.h"

namespace gestus::cli {

class Views {
 public:
  /// Before the run, so that a forbidden path and a motion that does not fit are told at once.
  static Result<Views> Open(const Arguments& arguments, const Setup& setup);

  bool Any() const { return html_ || svg_ || mp4_; }
  /// Writes them; `written` gets a line for each, `notes` what a user should know.
  Status Write(const Arguments& arguments, const Inputs& inputs, const Setup& setup,
               const outputs::Motion& motion, std::vector<std::string>* written,
               std::vector<std::string>* notes);

 private:
  std::optional<AtomicFile> html_, svg_, mp4_;
  std::optional<outputs::Motion> source_, target_;
};

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_VIEWS_H_
