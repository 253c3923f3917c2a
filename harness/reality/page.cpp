#include <fmt/format.h>

#include "harness/environment.h"
#include "harness/reality/reality.h"
#include "harness/report/markup.h"
#include "harness/report/page_parts.h"

namespace plumb::harness::reality {
namespace {

using report::escaped;

std::string cell(const std::string& text) { return "<td class=\"number\">" + text + "</td>"; }

std::string with_interval(const Estimate& estimate, double scale) {
  return fmt::format("{:.3g} <span class=\"unit\">[{:.3g} {:.3g}]</span>", scale * estimate.value,
                     scale * estimate.low, scale * estimate.high);
}

std::string fitted(std::span<const Parameter> parameters, std::span<const double> values) {
  std::string out;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    out += fmt::format("{}{} {:.3g}{}{}", i == 0 ? "" : "; ", parameters[i].name, values[i],
                       *parameters[i].unit == '\0' ? "" : " ", parameters[i].unit);
  return out;
}

std::string ellipse_row(const EllipseFinding& law, bool best) {
  return fmt::format("<tr><td>{}{}{}</td><td class=\"wide\">{}</td>", best ? "<b>" : "", escaped(law.name),
                     best ? "</b>" : "", escaped(law.text)) +
         cell(fmt::format("{}", law.parameters.size())) + cell(fmt::format("{:.3f}", law.validated)) +
         cell(with_interval(law.median, 1)) + cell(with_interval(law.ninetieth, 1)) +
         fmt::format("<td class=\"wide\">{}</td></tr>\n", escaped(fitted(law.parameters, law.values)));
}

std::string ellipse_table(const EllipseFindings& ellipse) {
  std::string out =
      "<div class=\"scroll\"><table><thead><tr><th>law</th><th></th><th class=\"number\">parameters</th>"
      "<th class=\"number\">cross-validated</th><th class=\"number\">median, held out</th>"
      "<th class=\"number\">90th percentile</th><th>fitted</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < ellipse.laws.size(); ++i)
    out += ellipse_row(ellipse.laws[i], i == ellipse.best || i == ellipse.best_of_all_floors);
  return out + ellipse_row(ellipse.bound, false) + "</tbody></table></div>\n";
}

std::string time_heads() {
  std::string out;
  for (const double time : kTimes) out += fmt::format("<th class=\"number\">{:.0f} ms</th>", 1e3 * time);
  return out;
}

std::string law_table(const DropFindings& drops) {
  std::string out = "<div class=\"scroll\"><table><thead><tr><th>law</th><th>error of the</th>" +
                    time_heads() + "<th>fitted</th></tr></thead><tbody>\n";
  for (const DropFinding& law : drops.laws) {
    out += "<tr><td>" + escaped(law.name) + "</td><td>position, mm</td>";
    for (std::size_t i = 0; i < kTimes.size(); ++i)
      out += cell(with_interval(law.model.position[i], 1e3) +
                  "<br>90 %: " + with_interval(law.model.ninetieth[i], 1e3));
    out += "<td class=\"wide\">" + escaped(fitted(law.parameters, law.values)) +
           "</td></tr>\n<tr><td></td><td>angle, deg</td>";
    for (const Estimate& angle : law.model.angle) out += cell(with_interval(angle, 180 / 3.14159265358979));
    out += "<td></td></tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string engine_table(const DropFindings& drops) {
  std::string out = "<div class=\"scroll\"><table><thead><tr><th>engine</th><th>error, mm</th>" +
                    time_heads() + "</tr></thead><tbody>\n";
  const auto row = [&](const std::string& name, const char* kind, const Differences& differences) {
    out += "<tr><td>" + escaped(name) + "</td><td>" + kind + "</td>";
    for (std::size_t i = 0; i < kTimes.size(); ++i)
      out += cell(with_interval(differences.position[i], 1e3) +
                  "<br>90 %: " + with_interval(differences.ninetieth[i], 1e3));
    out += "</tr>\n";
  };
  for (const EngineFinding& engine : drops.engines) {
    const std::string name =
        engine.dt > 0 ? fmt::format("{} {:.0f} Hz", engine.engine, 1 / engine.dt) : engine.engine;
    if (!engine.why_not.empty()) {
      out += fmt::format("<tr><td>{}</td><td colspan=\"{}\">not run: {}</td></tr>\n", escaped(name),
                         kTimes.size() + 1, escaped(engine.why_not));
      continue;
    }
    row(engine.failed == 0 ? name : fmt::format("{} ({} drops failed)", name, engine.failed), "numerical",
        engine.numerical);
    row("", "of the law", drops.laws.front().model);
    row("", "both", engine.measured);
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string page_of(const Findings& findings) {
  const EllipseFindings& ellipse = findings.ellipse;
  const DropFindings& drops = findings.drops;
  std::string out =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>plumb: held against measurements</title>\n<style>\n";
  out += std::string(report::kStyle) +
         "</style>\n</head>\n<body>\n<header><h1>plumb <span>held against "
         "measurements</span></h1></header>\n<main>\n";
  out += fmt::format(
      "<p class=\"note\">Parameters are fitted on one random half of the data (seed {}), errors are of the "
      "other half. Brackets hold "
      "95 % of bootstrap samples. The law to use is chosen by cross-validation within the first half. plumb "
      "{}.</p>\n",
      findings.seed, version());
  out += fmt::format(
      "<h2>One impact of an ellipse</h2>\n<p class=\"note\">{} impacts, {} that those who recorded them "
      "doubted left out. The error is that of the "
      "velocity after the impact, in the norm of the kinetic energy, as a fraction of the measured velocity. "
      "The laws are formulas: there is "
      "no numerical error here. The bound is the best impulse at the contact point, chosen with sight of the "
      "answer. Laws in bold "
      "are best by cross-validation, with and without a parameter of the place on this floor.</p>\n",
      ellipse.impacts, ellipse.doubted);
  out += ellipse_table(ellipse) + "<figure>" + ellipse_picture(findings) + "</figure>\n";
  out += fmt::format(
      "<h2>Drops of a square</h2>\n<p class=\"note\">{} drops, {} without four frames before the first "
      "impact left out, {} tested. Motion from the last "
      "frames of free fall on, compared at the frames nearest to these times after the first "
      "impact.</p>\n<h3>The laws, solved to a tolerance of 1e-9</h3>\n",
      drops.drops, drops.left_out, drops.tested);
  out += law_table(drops);
  out += fmt::format(
      "<h3>Engines with the law {}</h3>\n<p class=\"note\">Numerical: against the exact motion of the same "
      "law. Of the law: that exact motion "
      "against the measured one. Both: the engine against the measured one.</p>\n",
      escaped(drops.laws.front().name));
  out += "<figure>" + engine_picture(findings) + "</figure>\n" + engine_table(drops);
  return out + "</main>\n</body>\n</html>\n";
}

}  // namespace plumb::harness::reality
