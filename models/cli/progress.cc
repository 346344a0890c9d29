// The bar redraws itself ten times a second at most, so that it costs nothing beside a segment.
#include "models/cli/progress.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "models/io/text.h"

namespace gestus::cli {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(500);  // shorter runs show no bar
constexpr auto kInterval = std::chrono::milliseconds(100);

bool IsTerminal() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

}  // namespace

Progress::Progress(const models::RunReport* report)
    : report_(report), terminal_(IsTerminal()), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\x1b[K", stderr);
}

void Progress::Show(std::size_t done, std::size_t total) {
  const auto now = Clock::now();
  if (!terminal_ || done == 0 || now - start_ < kPatience || (shown_ && now - last_ < kInterval)) {
    return;
  }
  last_ = now;
  shown_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double share = static_cast<double>(done) / static_cast<double>(total);
  constexpr std::size_t kWidth = 30;
  const auto full = static_cast<std::size_t>(share * kWidth);
  std::string line = "\r[" + std::string(full, '#') + std::string(kWidth - full, '.') + "] " +
                     Grouped(done) + " of " + Count(total, "segment");
  if (report_->frame_rate > 0 && report_->frames > 0) {
    const double motion = static_cast<double>(report_->frames) / report_->frame_rate * share;
    line += ", " + Significant(motion / elapsed, 3) + " times real time";
  }
  line += ", " + Significant(elapsed / share - elapsed, 2) + " s left\x1b[K";
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace gestus::cli
