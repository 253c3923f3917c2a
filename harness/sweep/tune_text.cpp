#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/sweep/front.h"
#include "harness/sweep/space.h"
#include "harness/sweep/tune.h"

namespace plumb::harness::sweep {
namespace {

using Ink = Style::Ink;
using Json = nlohmann::ordered_json;

std::string wish(const TuneOptions& options) {
  const std::string unit = options.metric->unit.empty() ? "" : " " + std::string(options.metric->unit);
  if (options.tolerance)
    return fmt::format("the cheapest settings with {} at most {:g}{}", options.metric->name,
                       *options.tolerance, unit);
  return fmt::format("the settings with the least {} at a cost of at most {} per step of {} s",
                     options.metric->name, duration_text(*options.budget_ns), dt_text(options.step));
}

// Returns the command that runs these settings.
std::string command_of(const TuneOptions& options, const TuneAnswer& answer) {
  const reference::StepSettings& asked = answer.row.asked;
  std::string out = fmt::format("plumb run {} --engine {} --dt {}",
                                options.run_as.empty() ? options.instance.label() : options.run_as,
                                answer.engine, dt_text(asked.dt));
  if (asked.substeps) out += fmt::format(" --substeps {}", *asked.substeps);
  if (asked.tolerance) out += fmt::format(" --tolerance {:g}", *asked.tolerance);
  for (const auto& [name, value] : asked.options) out += fmt::format(" --set {}={}", name, value);
  return out;
}

Json answer_json(const TuneOptions& options, const TuneAnswer& answer) {
  Json json{{"engine", answer.engine}};
  if (!answer.found) {
    json["problem"] = answer.problem;
    return json;
  }
  const reference::StepSettings& asked = answer.row.asked;
  json["dt"] = asked.dt;
  json["steps_per_game_step"] = static_cast<int>(std::lround(options.step / asked.dt));
  if (asked.substeps) json["substeps"] = *asked.substeps;
  if (asked.tolerance) json["tolerance"] = *asked.tolerance;
  if (!asked.options.empty()) json["options"] = asked.options;
  json["reaches"] = {{std::string(options.metric->name), answer.error},
                     {"ns_per_game_step", answer.ns_a_step},
                     {"truth", answer.row.truth},
                     {"confirmed", answer.confirmed}};
  json["command"] = command_of(options, answer);
  return json;
}

std::string line_of(const TuneAnswer& answer, const Style& style) {
  if (!answer.found)
    return style.paint(
               "  " + pad_right(answer.engine, 20) + wrap("none: " + answer.problem, style.width - 22, 22),
               Ink::Dim) +
           "\n";
  return fmt::format("  {:<20}{:>10}{:>12}  {}{}\n", answer.engine, figure(answer.error),
                     duration_text(answer.ns_a_step), settings_text(answer.row.asked),
                     answer.confirmed ? "" : " (a second run gave another error)");
}

}  // namespace

std::string settings_json(const TuneOptions& options, const TuneAnswer& answer) {
  return answer_json(options, answer).dump(2) + "\n";
}

std::string tune_json(const TuneOptions& options, const Tuned& tuned) {
  Json answers = Json::array();
  for (const TuneAnswer& answer : tuned.answers) answers.push_back(answer_json(options, answer));
  Json json{{"scene", options.instance.label()}, {"metric", options.metric->name}};
  if (options.tolerance) json["tolerance"] = *options.tolerance;
  if (options.budget_ns) json["budget_ns"] = *options.budget_ns;
  json["game_step"] = options.step;
  json["against"] = tuned.has_truth ? "truth" : "each engine's own limit";
  json["answers"] = answers;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string tune_text(const TuneOptions& options, const Tuned& tuned, const Style& style) {
  std::string out = style.paint(options.instance.label(), Ink::Bold) + ": " + wish(options) + "\n";
  if (tuned.has_truth) {
    const std::string source = options.instance.build().truth.source;
    out +=
        style.paint("  " + wrap("errors against the truth: " + source, style.width - 2, 4), Ink::Dim) + "\n";
  } else {
    out += style.paint(
               "  " + wrap("no truth is known for this scene: each engine is compared with its own limit for "
                           "small steps, which shows that it is consistent, not that it is right",
                           style.width - 2, 4),
               Ink::Yellow) +
           "\n";
  }
  out += style.paint(fmt::format("  {:<20}{:>10}{:>12}  settings", "engine", "error",
                                 fmt::format("{} s", dt_text(options.step))),
                     Ink::Dim) +
         "\n";
  for (const TuneAnswer& answer : tuned.answers) out += line_of(answer, style);
  if (!tuned.has_truth)
    for (const TuneAnswer& answer : tuned.answers)
      if (answer.found)
        out += style.paint("  " + wrap(answer.row.truth, style.width - 2, 4), Ink::Dim) + "\n";
  const auto own = std::find_if(tuned.answers.begin(), tuned.answers.end(), [](const TuneAnswer& answer) {
    return answer.found && is_plumb(answer.engine);
  });
  const auto best = own != tuned.answers.end() ? own : tuned.answers.begin();
  if (best != tuned.answers.end() && best->found)
    out += fmt::format("\n{}'s settings, to paste:\n{}", best->engine, settings_json(options, *best));
  return out;
}

}  // namespace plumb::harness::sweep
