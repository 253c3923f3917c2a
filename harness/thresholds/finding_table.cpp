#include "harness/thresholds/finding_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plumb::harness::thresholds {
namespace {

using Ink = Style::Ink;

constexpr int kEngineWidth = 20, kFoundWidth = 28, kExactWidth = 14, kDifferenceWidth = 13;

std::string exact_text(const Finding& finding) {
  return finding.exact ? value_text(*finding.exact, finding.digits + 2, "") : "none";
}

std::string difference_text(const Finding& finding) {
  const auto difference = finding.relative_difference();
  if (!difference) return "";
  // Smaller differences are below the resolution of the bracket.
  const double least = std::pow(10.0, -finding.digits);
  return std::abs(*difference) < least ? fmt::format("< {:.2g} %", 100 * least)
                                       : fmt::format("{:+.2g} %", 100 * *difference);
}

Ink ink_of(const Finding& finding) {
  switch (finding.outcome) {
    case Finding::Outcome::Refused:
      return Ink::Dim;
    case Finding::Outcome::Never:
      return Ink::Red;
    case Finding::Outcome::Unclear:
      return Ink::Yellow;
    case Finding::Outcome::Found:
    case Finding::Outcome::Always:
      break;
  }
  return Ink::Plain;
}

std::string head(const Finding& finding, const Style& style) {
  std::string out = style.paint(fmt::format("{}: {}", finding.name, finding.title), Ink::Bold) + "\n";
  const std::string unit = finding.unit.empty() ? "" : fmt::format(", in {}", finding.unit);
  out += "  " +
         wrap(fmt::format("{}{}. Exact: {}.", finding.quantity, unit, finding.source), style.width - 2, 2) +
         "\n";
  out += "  " + style.paint(wrap(fmt::format("broken: {}.", finding.judged), style.width - 2, 2), Ink::Dim) +
         "\n";
  return out + style.paint(fmt::format("  {}{}{}{}failure beyond\n", pad_right("engine", kEngineWidth),
                                       pad_right("found", kFoundWidth), pad_right("exact", kExactWidth),
                                       pad_right("off by", kDifferenceWidth)),
                           Ink::Dim);
}

std::string row(const Finding& finding, const Style& style) {
  const std::string engine =
      finding.setting == "default" ? finding.engine : fmt::format("{} {}", finding.engine, finding.setting);
  const int before = 2 + kEngineWidth + kFoundWidth + kExactWidth + kDifferenceWidth;
  const bool refused = finding.outcome == Finding::Outcome::Refused;
  const std::string figures = refused
                                  ? pad_right("cannot run it", kFoundWidth + kExactWidth + kDifferenceWidth)
                                  : pad_right(found_text(finding) + ' ', kFoundWidth) +
                                        pad_right(exact_text(finding), kExactWidth) +
                                        pad_right(difference_text(finding), kDifferenceWidth);
  // Prepends the width of the columns to the reason's first word, so that wrapping accounts for them.
  const std::string reason = wrap(std::string(static_cast<std::size_t>(before), '-') + finding.reason,
                                  std::max(before + 20, style.width), before)
                                 .substr(static_cast<std::size_t>(before));
  return style.paint(fmt::format("  {}{}{}", pad_right(engine, kEngineWidth), figures, reason),
                     ink_of(finding)) +
         "\n";
}

}  // namespace

std::string value_text(double value, int digits, const std::string& unit) {
  const double size = std::floor(std::log10(std::abs(value)));
  const bool plain = size >= -4 && size < digits;
  const std::string text =
      plain ? fmt::format("{:.{}f}", value, std::max(0, digits - 1 - static_cast<int>(size)))
            : fmt::format("{:.{}e}", value, digits - 1);
  return unit.empty() ? text : fmt::format("{} {}", text, unit);
}

std::string found_text(const Finding& finding) {
  const auto text = [&](double value) { return value_text(value, finding.digits, finding.unit); };
  switch (finding.outcome) {
    case Finding::Outcome::Found:
      return text(finding.found.value_or(std::nan("")));
    case Finding::Outcome::Always:
      return finding.holds_below ? fmt::format("holds up to {:g}", finding.high)
                                 : fmt::format("holds down to {:g}", finding.low);
    case Finding::Outcome::Never:
      return finding.holds_below ? fmt::format("not even {:g}", finding.low)
                                 : fmt::format("not even {:g}", finding.high);
    case Finding::Outcome::Unclear:
      return fmt::format("unclear, {:.3g} to {:.3g}", finding.low, finding.high);
    case Finding::Outcome::Refused:
      break;
  }
  return "";
}

std::string finding_table(std::span<const Finding> findings, const Style& style) {
  std::string out, name;
  for (const Finding& finding : findings) {
    if (finding.name != name) out += (name.empty() ? "" : "\n") + head(finding, style);
    name = finding.name;
    out += row(finding, style);
  }
  return out;
}

}  // namespace plumb::harness::thresholds
