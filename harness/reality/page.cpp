#include <array>

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

std::string fitted_text(std::span<const Parameter> parameters, std::span<const Estimate> values) {
  std::string out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    out += fmt::format("{}{} {}", i == 0 ? "" : "; ", parameters[i].name, with_interval(values[i], 1));
    if (*parameters[i].unit != '\0') out += std::string(" ") + parameters[i].unit;
  }
  return out;
}

std::string ellipse_row(const EllipseFinding& law, bool best) {
  return fmt::format("<tr><td>{}{}{}</td>", best ? "<b>" : "", escaped(law.name), best ? "</b>" : "") +
         cell(fmt::format("{}", law.parameters.size())) + cell(with_interval(law.validated, 1)) +
         cell(with_interval(law.median, 1)) + cell(with_interval(law.ninetieth, 1)) + "</tr>\n";
}

/// Returns a paragraph, because a table would grow as wide as its longest row.
std::string fitted_line(const EllipseFinding& law) {
  return fmt::format("<p class=\"note fitted\"><b>{}</b>: {}. Fitted: {}</p>\n", escaped(law.name),
                     escaped(law.text), fitted_text(law.parameters, law.fitted));
}

/// Returns the name of an engine with its rate, and the number of runs that it could not finish.
std::string name_of(const std::string& engine, double dt, int failed, const char* what) {
  std::string out = dt > 0 ? fmt::format("{} {:.0f} Hz", engine, 1 / dt) : engine;
  if (failed > 0) out += fmt::format(" ({} {} failed)", failed, what);
  return escaped(out);
}

std::string ellipse_engine_table(const EllipseFindings& ellipse) {
  std::string out =
      "<div class=\"scroll\"><table><thead><tr><th>engine</th><th class=\"number\">numerical</th>"
      "<th class=\"number\">of the law</th><th class=\"number\">both</th>"
      "<th class=\"number\">numerical / law, %</th></tr></thead><tbody>\n";
  for (const EllipseEngine& engine : ellipse.engines) {
    out += "<tr><td>" + name_of(engine.engine, engine.dt, engine.failed, "impacts") + "</td>";
    if (engine.why_not.empty()) {
      for (const Quantiles* quantiles : {&engine.numerical, &engine.of_the_law, &engine.measured})
        out +=
            cell(with_interval(quantiles->median, 1) + "<br>90 %: " + with_interval(quantiles->ninetieth, 1));
      out += cell(with_interval(engine.share.median, 100) +
                  "<br>90 %: " + with_interval(engine.share.ninetieth, 100));
    } else {
      out += "<td colspan=\"4\">not run: " + escaped(engine.why_not) + "</td>";
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string ellipse_table(const EllipseFindings& ellipse) {
  std::string out =
      "<div class=\"scroll\"><table><thead><tr><th>law</th><th class=\"number\">parameters</th>"
      "<th class=\"number\">cross-validated</th><th class=\"number\">median, held out</th>"
      "<th class=\"number\">90th percentile</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < ellipse.laws.size(); ++i)
    out += ellipse_row(ellipse.laws[i], i == ellipse.best || i == ellipse.best_of_all_floors);
  out += ellipse_row(ellipse.bound, false) + "</tbody></table></div>\n";
  for (const EllipseFinding& law : ellipse.laws) out += fitted_line(law);
  return out + fitted_line(ellipse.bound);
}

std::string time_heads() {
  std::string out;
  for (const double time : kTimes) out += fmt::format("<th class=\"number\">{:.0f} ms</th>", 1e3 * time);
  return out;
}

constexpr double kMillimetres = 1e3, kDegrees = 180 / 3.14159265358979, kPercent = 100;

using Estimates = std::array<Estimate, kTimes.size()>;

/// Returns the cells of the medians with the 90th percentiles.
std::string cells(const Estimates& medians, const Estimates& ninetieths, double scale) {
  std::string out;
  for (std::size_t i = 0; i < kTimes.size(); ++i)
    out += cell(with_interval(medians[i], scale) + "<br>90 %: " + with_interval(ninetieths[i], scale));
  return out;
}

std::string law_table(const DropFindings& drops) {
  std::string out = "<div class=\"scroll\"><table><thead><tr><th>law</th><th>error of the</th>" +
                    time_heads() + "<th>fitted</th></tr></thead><tbody>\n";
  for (const DropFinding& law : drops.laws) {
    out += "<tr><td>" + escaped(law.name) + "</td><td>position, mm</td>" +
           cells(law.model.position, law.model.ninetieth, kMillimetres) + "<td class=\"wide\">" +
           fitted_text(law.parameters, law.fitted) + "</td></tr>\n<tr><td></td><td>angle, deg</td>" +
           cells(law.model.angle, law.model.angle_ninetieth, kDegrees) + "<td></td></tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string engine_table(const DropFindings& drops) {
  std::string out = "<div class=\"scroll\"><table><thead><tr><th>engine</th><th>error</th>" + time_heads() +
                    "</tr></thead><tbody>\n";
  const auto row = [&](const std::string& name, const char* kind, const std::string& figures) {
    out += "<tr><td>" + name + "</td><td>" + kind + "</td>" + figures + "</tr>\n";
  };
  const auto position = [](const Differences& d, double scale) {
    return cells(d.position, d.ninetieth, scale);
  };
  const auto angle = [](const Differences& d, double scale) {
    return cells(d.angle, d.angle_ninetieth, scale);
  };
  const Differences& law = drops.laws.front().model;
  for (const EngineFinding& engine : drops.engines) {
    const std::string name = name_of(engine.engine, engine.dt, engine.failed, "drops");
    if (!engine.why_not.empty()) {
      out += fmt::format("<tr><td>{}</td><td colspan=\"{}\">not run: {}</td></tr>\n", name, kTimes.size() + 1,
                         escaped(engine.why_not));
      continue;
    }
    row(name, "numerical, mm", position(engine.numerical, kMillimetres));
    row("", "of the law, mm", position(law, kMillimetres));
    row("", "both, mm", position(engine.measured, kMillimetres));
    row("", "numerical / law, %", position(engine.share, kPercent));
    row("", "numerical, deg", angle(engine.numerical, kDegrees));
    row("", "of the law, deg", angle(law, kDegrees));
    row("", "numerical / law, %", angle(engine.share, kPercent));
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string page_of(const Findings& findings) {
  const EllipseFindings& ellipse = findings.ellipse;
  const DropFindings& drops = findings.drops;
  std::string out =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n<title>plumb: "
      "compared with measurements</title>\n<style>\n";
  out += std::string(report::kStyle) +
         "</style>\n</head>\n<body>\n<header><h1>plumb <span>compared with "
         "measurements</span></h1></header>\n<main>\n";
  out += fmt::format(
      "<p class=\"note\">Parameters are fitted on one random half of the data (seed {}), errors are of the "
      "other half. Brackets hold "
      "95 % of bootstrap samples; for fitted values, of fits to such samples. The law to use is chosen by "
      "cross-validation within the first half. plumb "
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
  if (!ellipse.engines.empty()) {
    out +=
        fmt::format(
            "<h3>Engines with the law {}</h3>\n<p class=\"note\">Each impact as an engine computes it: a "
            "disc "
            "touches at the measured point of contact, on a body of the fitted inertia, at any time within "
            "a step. Numerical: against the same law solved to a tolerance. Of the law: that against the "
            "measured velocity. Both: the engine against the measured velocity.</p>\n",
            escaped(ellipse.laws.front().name)) +
        ellipse_engine_table(ellipse);
  }
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
