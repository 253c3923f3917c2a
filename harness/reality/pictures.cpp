#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "harness/reality/reality.h"
#include "harness/report/markup.h"

namespace plumb::harness::reality {
namespace {

// Strokes differ in dashes too, so that nothing is shown by colour alone.
constexpr const char* kStyle = R"(
  text { font: 12px system-ui, sans-serif; fill: #1c1c1a; }
  .back { fill: #ffffff; } .soft { fill: #5c5c57; } .line { stroke: #d6d6d0; fill: none; }
  .curve { fill: none; stroke-width: 2; }
  .c0 { stroke: #0b57a3; } .c1 { stroke: #a3320b; stroke-dasharray: 8 3; } .c2 { stroke: #1d6b45; stroke-dasharray: 3 3; }
  .c3 { stroke: #7a3fa0; stroke-dasharray: 10 3 2 3; } .c4 { stroke: #5c5c57; stroke-dasharray: 1 3; }
  .numerical { fill: #0b57a3; } .law { fill: #f0b48a; }
  @media (prefers-color-scheme: dark) {
    text { fill: #ecebe6; } .back { fill: #16181a; } .soft { fill: #a9a9a2; } .line { stroke: #43474b; }
    .c0 { stroke: #7cb8f5; } .c1 { stroke: #ff9a70; } .c2 { stroke: #74d3a2; } .c3 { stroke: #c79ae6; } .c4 { stroke: #a9a9a2; }
    .numerical { fill: #7cb8f5; } .law { fill: #8a4a1f; }
  }
)";

std::string open(int width, int height, const std::string& title) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "role=\"img\">\n<title>{2}</title>\n<style>{3}</style>\n<rect class=\"back\" width=\"{0}\" "
      "height=\"{1}\"/>\n",
      width, height, title, kStyle);
}

std::string label(double x, double y, const std::string& text, const char* anchor = "start",
                  const char* kind = "") {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", kind, x,
                     y, anchor, report::escaped(text));
}

std::string line(double x0, double y0, double x1, double y1) {
  return fmt::format("<path class=\"line\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", x0, y0, x1, y1);
}

}  // namespace

std::string ellipse_picture(const Findings& findings) {
  constexpr double kLeft = 60, kTop = 20, kWide = 560, kHigh = 300, kLargest = 0.5;
  const EllipseFindings& ellipse = findings.ellipse;
  std::vector<const EllipseFinding*> shown{&ellipse.laws[0], &ellipse.laws[1]};
  for (const std::size_t i : {ellipse.best_of_all_floors, ellipse.best})
    if (std::find(shown.begin(), shown.end(), &ellipse.laws[i]) == shown.end())
      shown.push_back(&ellipse.laws[i]);
  shown.push_back(&ellipse.bound);
  const auto at = [&](double error, double share) {
    return std::array<double, 2>{kLeft + kWide * error / kLargest, kTop + kHigh * (1 - share)};
  };
  std::string out = open(960, 370, "Fraction of the measured impacts whose error is below a value");
  for (int i = 0; i <= 4; ++i) {
    const double share = 0.25 * i, y = at(0, share)[1];
    out += line(kLeft, y, kLeft + kWide, y) +
           label(kLeft - 8, y + 4, fmt::format("{:.0f} %", 100 * share), "end", "soft");
  }
  for (int i = 0; i <= 5; ++i) {
    const double x = at(0.1 * i, 0)[0];
    out += line(x, kTop, x, kTop + kHigh) +
           label(x, kTop + kHigh + 18, fmt::format("{:.1f}", 0.1 * i), "middle", "soft");
  }
  out += label(kLeft + kWide / 2, kTop + kHigh + 40, "relative error of the velocity after the impact",
               "middle");
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const std::vector<double>& errors = shown[k]->errors;
    const std::size_t kind = k + 1 == shown.size() ? 4 : k;
    std::string path;
    for (std::size_t i = 0; i < errors.size(); i += std::max<std::size_t>(1, errors.size() / 150)) {
      if (errors[i] > kLargest) break;
      const auto place = at(errors[i], static_cast<double>(i + 1) / static_cast<double>(errors.size()));
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", place[0], place[1]);
    }
    out += fmt::format("<path class=\"curve c{}\" d=\"{}\"/>\n", kind, path);
    const double y = kTop + 20 + 22 * static_cast<double>(k);
    out += fmt::format("<path class=\"curve c{}\" d=\"M640 {:.0f}h30\"/>\n", kind, y);
    out += label(678, y + 4,
                 fmt::format("{} {:.3f} [{:.3f} {:.3f}]", shown[k]->name, shown[k]->median.value,
                             shown[k]->median.low, shown[k]->median.high));
  }
  return out +
         label(640, kTop + 20 + 22 * static_cast<double>(shown.size()) + 4,
               "the median, in brackets 95 % of samples", "start", "soft") +
         "</svg>\n";
}

std::string engine_picture(const Findings& findings) {
  // The bars are logarithmic, from a micrometre to a decimetre.
  constexpr double kLeft = 170, kTop = 40, kWide = 560, kHigh = 16, kGap = 12, kLeast = 1e-6, kMost = 0.1;
  constexpr std::size_t kTime = 1;
  const auto x_of = [&](double value) {
    return kLeft + kWide * std::log(std::clamp(value, kLeast, kMost) / kLeast) / std::log(kMost / kLeast);
  };
  std::vector<const EngineFinding*> rows;
  for (const EngineFinding& engine : findings.drops.engines)
    if (engine.why_not.empty()) rows.push_back(&engine);
  const double height = kTop + static_cast<double>(rows.size()) * (2 * kHigh + kGap) + 40;
  std::string out =
      open(900, static_cast<int>(height), "Numerical error and error of the law, engine by engine");
  out +=
      label(kLeft, 18,
            fmt::format("Position {:.0f} ms after the first impact, median: blue, numerical error (a line if "
                        "below 1 um); orange, error of the law",
                        1e3 * kTimes[kTime]));
  const char* const names[] = {"1 um", "10 um", "0.1 mm", "1 mm", "1 cm", "10 cm"};
  for (int i = 0; i <= 5; ++i) {
    const double x = kLeft + kWide * i / 5;
    out += line(x, kTop - 6, x, height - 34) + label(x, height - 16, names[i], "middle", "soft");
  }
  const Estimate& law = findings.drops.laws.front().model.position[kTime];
  const double law_error = law.value;
  const auto in_millimetres = [](const Estimate& e) {
    return fmt::format("{:.3g} [{:.3g} {:.3g}] mm", 1e3 * e.value, 1e3 * e.low, 1e3 * e.high);
  };
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double y = kTop + static_cast<double>(k) * (2 * kHigh + kGap);
    const Estimate& numerical = rows[k]->numerical.position[kTime];
    const double error = numerical.value;
    out += label(
        kLeft - 8, y + kHigh + 4,
        rows[k]->dt > 0 ? fmt::format("{} {:.0f} Hz", rows[k]->engine, 1 / rows[k]->dt) : rows[k]->engine,
        "end");
    out += fmt::format("<rect class=\"numerical\" x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\"/>\n",
                       kLeft, y, std::max(1.0, x_of(error) - kLeft), kHigh);
    out += fmt::format("<rect class=\"law\" x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\"/>\n", kLeft,
                       y + kHigh, x_of(law_error) - kLeft, kHigh);
    out += label(std::max(x_of(error), kLeft + 1) + 6, y + kHigh - 4, in_millimetres(numerical));
    out += label(x_of(law_error) + 6, y + 2 * kHigh - 4, in_millimetres(law));
  }
  return out + "</svg>\n";
}

}  // namespace plumb::harness::reality
