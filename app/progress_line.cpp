#include "app/progress_line.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

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
  const auto width = static_cast<std::size_t>(harness::Style::of_file(STDERR_FILENO).width - 1);
  fmt::print(stderr, "\r\x1b[K{}", text.substr(0, width));
  std::fflush(stderr);
  shown_ = true;
}

void ProgressLine::clear() {
  if (!shown_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace plumb::app
