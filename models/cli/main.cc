// infer-cli: runs the networks of gestus on files.
//
// The path of a run: ParseArguments (args.cc) -> RunInfer (infer.cc) -> OpenNetwork (setup.cc) ->
// Network::Run (models/) -> Session::Run (engine/) -> a kernel (kernels/).
#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "models/cli/args.h"
#include "models/cli/check.h"
#include "models/cli/eval.h"
#include "models/cli/export.h"
#include "models/cli/features.h"
#include "models/cli/infer.h"
#include "models/cli/info.h"
#include "models/cli/machine.h"
#include "models/cli/setup.h"
#include "models/cli/style.h"
#include "models/cli/style_commands.h"
#include "models/io/text.h"

namespace {

using namespace gestus::cli;  // NOLINT: this is the program of that library
using gestus::Code;
using gestus::Result;
using gestus::Status;

// A full disk, a size limit and a reader that went away are reported as errors of the call that
// met them.  A standard stream that was closed gets a place holder: otherwise the next file opened
// would be taken for it.
void PrepareProcess() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (int fd = 0; fd <= 2; ++fd) {
    if (::fcntl(fd, F_GETFD) == -1) (void)::open("/dev/null", O_RDONLY);
  }
}

Status Run(int argc, const char* const* argv) {
  const Result<Arguments> arguments = ParseArguments(argc, argv);
  if (!arguments.ok()) return arguments.status();
  switch (arguments->command) {
    case Command::kInfer:
      return RunInfer(*arguments);
    case Command::kInfo:
      return RunInfo(*arguments);
    case Command::kStyle:
      return RunStyle(*arguments);
    case Command::kStyleInfo:
      return RunStyleInfo(*arguments);
    case Command::kStyleBlend:
      return RunStyleBlend(*arguments);
    case Command::kStyleDistance:
      return RunStyleDistance(*arguments);
    case Command::kStyleGallery:
      return RunStyleGallery(*arguments);
    case Command::kFeatures:
      return RunFeatures(*arguments);
    case Command::kExport:
      return RunExport(*arguments);
    case Command::kEval:
      return RunEval(*arguments);
    case Command::kCheck:
      return RunCheck(*arguments);
    case Command::kVersion:
      return Print(arguments->json ? VersionJson() : VersionText());
    case Command::kHelp:
      return Print(arguments->help);
  }
  return Status();
}

}  // namespace

int main(int argc, char** argv) {
  PrepareProcess();
  Status status;
  try {
    status = Run(argc, argv);
  } catch (const std::bad_alloc&) {
    status = Status(Code::kResourceExhausted, "memory: not enough, expected a smaller input");
  } catch (const std::exception& error) {
    status = Status(Code::kInvalidArgument, error.what());
  }
  if (status.ok()) return 0;
  constexpr std::size_t kMaxLine = 299;  // and a newline
  std::fprintf(stderr, "%s\n", gestus::OneLine("infer-cli: " + status.message(), kMaxLine).c_str());
  return 2;
}
