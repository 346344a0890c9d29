// Predicted and true values side by side, column by column.
#ifndef GESTUS_MODELS_CLI_EVAL_COLUMNS_H_
#define GESTUS_MODELS_CLI_EVAL_COLUMNS_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/cli/eval_sequences.h"

namespace gestus::cli {

struct Column {
  std::string group, name, unit;
  std::vector<float> predicted, truth;  ///< as many
};

constexpr const char* kActionUnits = "action units";
constexpr const char* kHead = "head";
constexpr const char* kOtherCurves = "curves";

/// Whether the column is a curve, which the median filter is meant for, and not a coordinate.
bool IsCurve(const Column& column);

/// The channels in `names` of both sequences.  Sequences of words or windows are compared one by
/// one, each with its counterpart, when there are as many; else by the time at which they stand.
/// Where one side is longer the rest of it is left out and noted.  Errors begin with a path: not as
/// many sequences and no times.
Result<std::vector<Column>> CurveColumns(const Sequence& prediction, const Sequence& truth,
                                         const std::vector<std::string>& names,
                                         std::vector<std::string>* notes);

/// x and y of these points, of the frames that both have.
std::vector<Column> PointColumns(const Sequence& prediction, const Sequence& truth,
                                 std::span<const std::int64_t> joints,
                                 std::span<const std::int64_t> landmarks);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EVAL_COLUMNS_H_
