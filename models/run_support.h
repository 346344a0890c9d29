// What every Network::Run does besides running: timing, taps, profiles, checks of arrays.
#ifndef GESTUS_MODELS_RUN_SUPPORT_H_
#define GESTUS_MODELS_RUN_SUPPORT_H_

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "engine/session.h"
#include "models/network.h"

namespace gestus::models {

/// Checks every array of `inputs` that `signature` names: shape, dtype, finite; says when a
/// required one is missing.
Status CheckInputs(const Signature& signature, const Arrays& inputs);

/// Repeats, threads and sampling in range.
Status CheckOptions(const RunOptions& options);

/// Array `name` has as many rows as array `other`; both are given.  `rows` says what the first
/// dimension counts: "frames", "words".
Status CheckSameRows(const Arrays& inputs, const std::string& name, const std::string& other,
                     const std::string& rows);

/// What a session of such a run is created with.
SessionOptions SessionOptionsOf(const RunOptions& options);

/// The error of running a network that was made with NetworkOptions::plan = false.
Status NotPlanned();

/// All values finite, or an error that names the array and the first place that is not.
Status CheckFinite(const std::string& name, const Array& array, Code code);

/// An array of that shape, zeroed.
Array MakeArray(std::vector<std::int64_t> shape, DType dtype = DType::kF32);

/// One array of a signature: `axes` name the dimensions of `shape`.
ArraySpec Spec(const std::string& name, std::vector<std::int64_t> shape,
               std::vector<std::string> axes, const std::string& unit, const std::string& meaning);

/// Rows of a session's value, without gaps between them, from and to memory.
void CopyIn(const ValueView& to, const float* from);
void CopyOut(float* to, const ValueView& from);
void CopyOut(std::int32_t* to, const ValueView& from);

/// Adds a note to the report; nothing where there is no report or the note is empty.
void AddNote(RunReport* report, const std::string& note);

/// Calls `run` as often as the options say and notes each time in the report.
void TimedRun(const RunOptions& options, RunReport* report, const std::function<void()>& run);

/// Counts segments for RunOptions::progress.
struct Progress {
  std::size_t done = 0, total = 0;
  void Step(const RunOptions& options) {
    ++done;
    if (options.progress) options.progress(done, total);
  }
};

/// Copies the session's outputs "tap/..." to `outputs`.
void CopyTaps(const Session& session, Arrays* outputs);

/// Adds the sessions' profiles to the report.
void AddProfiles(std::initializer_list<const Session*> sessions, RunReport* report);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_RUN_SUPPORT_H_
