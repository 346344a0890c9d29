// A bar on the standard error output while many segments run; nothing where that is no terminal.
#ifndef GESTUS_MODELS_CLI_PROGRESS_H_
#define GESTUS_MODELS_CLI_PROGRESS_H_

#include <chrono>
#include <cstddef>

#include "models/network.h"

namespace gestus::cli {

class Progress {
 public:
  /// `report` is the running network's: it says how much motion the segments make.
  explicit Progress(const models::RunReport* report);
  /// Removes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Show(std::size_t done, std::size_t total);

 private:
  using Clock = std::chrono::steady_clock;

  const models::RunReport* report_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point start_, last_;
};

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_PROGRESS_H_
