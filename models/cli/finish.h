// Finishing what a run put out, where the command line asks for it.
#ifndef GESTUS_MODELS_CLI_FINISH_H_
#define GESTUS_MODELS_CLI_FINISH_H_

#include <optional>

#include "engine/status.h"
#include "models/cli/args.h"
#include "models/cli/setup.h"
#include "models/network.h"
#include "models/outputs/finish.h"

namespace gestus::cli {

/// Makes the arrays of motion in `arrays` the finished ones and adds `frame_rate`; frames and notes
/// go to `report`.  Without a finishing option nothing is touched and the result is empty.
Result<std::optional<outputs::Finished>> FinishOutputs(const Arguments& arguments,
                                                       const Setup& setup, models::Arrays* arrays,
                                                       models::RunReport* report);

/// The array that finished motion has beside it, one value.
constexpr const char* kFrameRate = "frame_rate";

/// Makes the arrays of an output file what outputs::MotionOf() takes, where the motion in it was
/// finished: curves become one sequence again.  `rate` gets its frames per second, 0 where it was
/// not finished.  The error names the array.
Status TakeFinished(models::Arrays* arrays, double* rate);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_FINISH_H_
