#include <fmt/format.h>

#include "harness/reality/reality.h"

namespace plumb::harness::reality {
namespace {

std::string with_interval(const Estimate& estimate, double scale, int digits) {
  return fmt::format("{:.{}f} [{:.{}f} {:.{}f}]", scale * estimate.value, digits, scale * estimate.low,
                     digits, scale * estimate.high, digits);
}

std::string fitted_text(std::span<const Parameter> parameters, std::span<const double> values) {
  std::string out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string unit = *parameters[i].unit == '\0' ? "" : std::string(" ") + parameters[i].unit;
    out += fmt::format("{}{} {:.3g}{}", i == 0 ? "" : ", ", parameters[i].name, values[i], unit);
  }
  return out;
}

std::string ellipse_line(const EllipseFinding& law, const std::string& mark) {
  return fmt::format("  {:<24}{:>2}  {:>6.3f}  {:<22}{:<22}{}\n", law.name, law.parameters.size(),
                     law.validated, with_interval(law.median, 1, 3), with_interval(law.ninetieth, 1, 3),
                     mark);
}

std::string position_columns(const Differences& differences) {
  std::string out;
  for (const Estimate& estimate : differences.position)
    out += fmt::format(" {:>21}", with_interval(estimate, 1e3, 2));
  return out;
}

}  // namespace

std::string to_text(const Findings& findings, const Style& style) {
  const EllipseFindings& ellipse = findings.ellipse;
  const auto title = [&](const std::string& text) { return style.paint(text, Style::Ink::Bold) + "\n"; };
  std::string out =
      title(fmt::format("Ellipse: velocity after an impact, relative error ({} impacts, {} doubted "
                        "left out; seed {})",
                        ellipse.impacts, ellipse.doubted, findings.seed));
  out += fmt::format("  {:<24}{:>2}  {:>6}  {:<22}{}\n", "law", "p", "cv", "test median", "90 %");
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
      "interval]\n\n";

  const DropFindings& drops = findings.drops;
  out += title(fmt::format("Square: position after the first impact, mm ({} drops, {} left out, {} tested)",
                           drops.drops, drops.left_out, drops.tested));
  std::string heads;
  for (const double time : kTimes) heads += fmt::format(" {:>21}", fmt::format("{:.0f} ms", 1e3 * time));
  out += fmt::format("  {:<22}{}\n", "law, against measured", heads);
  for (const DropFinding& law : drops.laws)
    out += fmt::format("  {:<22}{}\n    {}\n", law.name, position_columns(law.model),
                       fitted_text(law.parameters, law.values));
  out += fmt::format("  {:<22}{}\n", "engine, numerical", heads);
  for (const EngineFinding& engine : drops.engines) {
    const std::string name =
        engine.dt > 0 ? fmt::format("{} {:.0f} Hz", engine.engine, 1 / engine.dt) : engine.engine;
    if (!engine.why_not.empty()) {
      out += fmt::format("  {:<22} {}\n", name, engine.why_not);
    } else {
      out += fmt::format("  {:<22}{}\n", name, position_columns(engine.numerical));
    }
  }
  return out + "  numerical: against the law's exact motion, by Precise\n";
}

}  // namespace plumb::harness::reality
