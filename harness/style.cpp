#include "harness/style.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace plumb::harness {

std::string Style::paint(std::string_view text, Ink ink) const {
  static constexpr std::string_view kCodes[] = {"0", "1", "2", "32", "33", "31"};
  if (!colour || ink == Ink::Plain) return std::string(text);
  return fmt::format("\x1b[{}m{}\x1b[0m", kCodes[static_cast<int>(ink)], text);
}

Style Style::of_file(int descriptor) {
  Style style;
  if (isatty(descriptor) == 0) return style;
  winsize size{};
  if (ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    style.width = std::clamp<int>(size.ws_col, 40, 110);
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  style.colour =
      (no_colour == nullptr || *no_colour == '\0') && terminal != nullptr && std::string(terminal) != "dumb";
  return style;
}

std::string wrap(std::string_view text, int width, int indent) {
  std::string out;
  int column = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    const int needed = static_cast<int>(word.size());
    if (column > 0 && column + 1 + needed > width) {
      out += "\n" + std::string(static_cast<std::size_t>(indent), ' ');
      column = indent;
    } else if (column > 0) {
      out += ' ';
      ++column;
    }
    out += word;
    column += needed;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string pad_left(std::string_view text, int width) { return fmt::format("{:>{}}", text, width); }

std::string pad_right(std::string_view text, int width) { return fmt::format("{:<{}}", text, width); }

std::string figure(double value) {
  if (value == 0) return "0";
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : "inf";
  const double size = std::abs(value);
  if (size >= 100 && size < 1e5) return fmt::format("{:.0f}", value);
  if (size >= 0.01 && size < 100) return fmt::format("{:.2g}", value);
  return fmt::format("{:.1e}", value);
}

std::string duration_text(double nanoseconds) {
  if (nanoseconds < 1e3) return fmt::format("{:.0f} ns", nanoseconds);
  if (nanoseconds < 1e6) return fmt::format("{:.3g} us", nanoseconds / 1e3);
  if (nanoseconds < 1e9) return fmt::format("{:.3g} ms", nanoseconds / 1e6);
  return fmt::format("{:.3g} s", nanoseconds / 1e9);
}

std::string dt_text(double dt) {
  const double rate = 1 / dt;
  if (rate >= 1 && std::abs(rate - std::round(rate)) < 1e-9 * rate) return fmt::format("1/{:.0f}", rate);
  return fmt::format("{}", dt);
}

}  // namespace plumb::harness
