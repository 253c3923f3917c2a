#include <array>

#include <fmt/format.h>

#include "harness/reality/reality.h"

namespace plumb::harness::reality {
namespace {

std::string with_interval(const Estimate& estimate, double scale, int digits) {
  return fmt::format("{:.{}f} [{:.{}f} {:.{}f}]", scale * estimate.value, digits, scale * estimate.low,
                     digits, scale * estimate.high, digits);
}

/// Formats an estimate with three significant digits, enough to distinguish a rounding error from zero.
std::string significant(const Estimate& estimate, double scale) {
  return fmt::format("{:.3g} [{:.3g} {:.3g}]", scale * estimate.value, scale * estimate.low,
                     scale * estimate.high);
}

std::string fitted_text(std::span<const Parameter> parameters, std::span<const Estimate> values) {
  std::string out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string unit = *parameters[i].unit == '\0' ? "" : std::string(" ") + parameters[i].unit;
    out += fmt::format("{}{} {}{}", i == 0 ? "" : ", ", parameters[i].name, significant(values[i], 1), unit);
  }
  return out;
}

std::string ellipse_line(const EllipseFinding& law, const std::string& mark) {
  return fmt::format("  {:<24}{:>2}  {:<22}{:<22}{:<22}{}\n", law.name, law.parameters.size(),
                     with_interval(law.validated, 1, 3), with_interval(law.median, 1, 3),
                     with_interval(law.ninetieth, 1, 3), mark);
}

std::string columns(const std::array<Estimate, kTimes.size()>& estimates, double scale) {
  std::string out;
  for (const Estimate& estimate : estimates) out += fmt::format(" {:>29}", significant(estimate, scale));
  return out;
}

std::string name_of(const std::string& engine, double dt) {
  return dt > 0 ? fmt::format("{} {:.0f} Hz", engine, 1 / dt) : engine;
}

/// Returns the lines of the engines in the ellipse's impacts.
std::string ellipse_engine_lines(const EllipseFindings& ellipse) {
  if (ellipse.engines.empty()) return "";
  std::string out = fmt::format("  {:<24}{:<30}{:<30}{}\n", "engine, " + ellipse.laws.front().name,
                                "numerical, median", "90 %", "numerical / law, %");
  for (const EllipseEngine& engine : ellipse.engines) {
    out += fmt::format("  {:<24}", name_of(engine.engine, engine.dt));
    out += engine.why_not.empty() ? fmt::format("{:<30}{:<30}{}\n", significant(engine.numerical.median, 1),
                                                significant(engine.numerical.ninetieth, 1),
                                                significant(engine.share.median, 100))
                                  : engine.why_not + "\n";
  }
  return out + "\n";
}

}  // namespace

std::string to_text(const Findings& findings, const Style& style) {
  const EllipseFindings& ellipse = findings.ellipse;
  const auto title = [&](const std::string& text) { return style.paint(text, Style::Ink::Bold) + "\n"; };
  std::string out =
      title(fmt::format("Ellipse: velocity after an impact, relative error ({} impacts, {} doubted "
                        "left out; seed {})",
                        ellipse.impacts, ellipse.doubted, findings.seed));
  out += fmt::format("  {:<24}{:>2}  {:<22}{:<22}{}\n", "law", "p", "cv", "test median", "90 %");
  for (std::size_t i = 0; i < ellipse.laws.size(); ++i) {
    const std::string mark = i == ellipse.best ? "best by cross-validation"
                             : i == ellipse.best_of_all_floors
                                 ? "best without a parameter of the floor's place"
                                 : "";
    out += ellipse_line(ellipse.laws[i], mark);
  }
  out += ellipse_line(ellipse.bound, "best impulse at the contact point");
  out +=
      "  p: parameters fitted on one half; cv: median error by cross-validation in that half; [95 % "
      "interval]\n";
  for (const EllipseFinding& law : ellipse.laws)
    out += fmt::format("  {:<24}{}\n", law.name, fitted_text(law.parameters, law.fitted));
  out += "\n" + ellipse_engine_lines(ellipse);

  const DropFindings& drops = findings.drops;
  out += title(fmt::format("Square: position after the first impact, mm ({} drops, {} left out, {} tested)",
                           drops.drops, drops.left_out, drops.tested));
  std::string heads;
  for (const double time : kTimes) heads += fmt::format(" {:>29}", fmt::format("{:.0f} ms", 1e3 * time));
  out += fmt::format("  {:<22}{}\n", "law, against measured", heads);
  for (const DropFinding& law : drops.laws)
    out += fmt::format("  {:<22}{}\n    {}\n", law.name, columns(law.model.position, 1e3),
                       fitted_text(law.parameters, law.fitted));
  out += fmt::format("  {:<22}{}\n", "engine, numerical", heads);
  for (const EngineFinding& engine : drops.engines) {
    const std::string name = name_of(engine.engine, engine.dt);
    if (!engine.why_not.empty()) {
      out += fmt::format("  {:<22} {}\n", name, engine.why_not);
    } else {
      out += fmt::format("  {:<22}{}\n  {:<22}{}\n", name, columns(engine.numerical.position, 1e3),
                         "  of the law's, %", columns(engine.share.position, 100));
    }
  }
  return out + "  numerical: against the law's exact motion, by Precise\n";
}

}  // namespace plumb::harness::reality
