#include "app/progress_line.h"

#include <algorithm>

#include <fmt/format.h>
#include <unistd.h>

#include "app/output.h"
#include "engine/core/text.h"
#include "harness/style.h"

namespace plumb::app {

ProgressLine::ProgressLine() : on_(isatty(STDERR_FILENO) != 0) {}

void ProgressLine::show(const harness::Progress& progress) {
  std::string text = fmt::format("{}/{} {}", progress.done, progress.total, progress.what);
  const double passed = std::chrono::duration<double>(Clock::now() - start_).count();
  if (progress.done > 2) {
    const double left =
        passed / static_cast<double>(progress.done) * static_cast<double>(progress.total - progress.done);
    text += fmt::format(", about {:.0f} s left", left);
  }
  say(text);
}

void ProgressLine::say(const std::string& text) {
  if (!on_) return;
  // Shorter than a line, with room for the three dots that mark a truncated text.
  const auto width = static_cast<std::size_t>(std::max(harness::Style::of_file(STDERR_FILENO).width - 4, 1));
  write_error("\r\x1b[K" + printable(text, width));
  shown_ = true;
}

void ProgressLine::clear() {
  if (!shown_) return;
  write_error("\r\x1b[K");
  shown_ = false;
}

}  // namespace plumb::app
