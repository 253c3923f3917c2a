#include "harness/sweep/tune.h"

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/metric.h"
#include "app/output.h"
#include "app/progress_line.h"
#include "app/selection.h"
#include "app/source.h"
#include "app/usage.h"
#include "harness/interrupt.h"

namespace plumb::app {
namespace {

namespace sweep = harness::sweep;

struct TuneCommandOptions {
  std::string name, tolerance, budget, step, seconds, duration, metric, format = "console";
  EngineOptions engines;
  int size = 0;
};

int start_tune(const TuneCommandOptions& options) {
  std::vector<std::unique_ptr<reference::Backend>> programs;
  std::vector<std::unique_ptr<scenarios::Scenario>> files;
  // A case file contains its own tolerances.
  const bool is_case = !case_files(options.name).empty();
  const bool own = is_case && options.metric.empty() && options.budget.empty() && options.tolerance.empty();
  const std::string metric = !options.metric.empty() ? options.metric
                             : is_case               ? "expected_miss"
                                                     : "position_error";
  if (!own && options.tolerance.empty() == options.budget.empty())
    throw UsageError(
        "give either --tolerance, the error to reach, or --cost-us, the cost allowed for a step");
  if (options.size > 0 && is_file(options.name))
    throw UsageError("--size needs the name of a scenario, not a file");
  if (!options.duration.empty() && !is_file(options.name))
    throw UsageError("--duration needs a scene file: scenarios have their own duration");
  sweep::TuneOptions what{.instance = is_file(options.name)
                                          ? file_instance(options.name, options.duration, files)
                                          : one_instance(options.name, options.size),
                          .engines = chosen_engines(options.engines, programs),
                          .metric = &metric_by_name(metric)};
  if (is_file(options.name)) what.run_as = options.name;
  if (own) what.tolerance = 1;
  if (!options.tolerance.empty()) what.tolerance = parse_positive("--tolerance", options.tolerance);
  if (!options.budget.empty()) what.budget_ns = 1e3 * parse_positive("--cost-us", options.budget);
  if (!options.step.empty()) what.step = parse_positive("--dt", options.step);
  if (!options.seconds.empty()) what.seconds = parse_positive("--budget", options.seconds);
  what.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));

  ProgressLine progress;
  harness::catch_interrupts();
  const sweep::Tuned tuned = sweep::tune(what, [&](const std::string& text) { progress.say(text); });
  progress.clear();
  if (tuned.interrupted) {
    notice("interrupted; nothing is stored. A smaller --budget makes the search shorter");
    return kInterrupted;
  }
  print(options.format == "json" ? sweep::tune_json(what, tuned)
                                 : sweep::tune_text(what, tuned, harness::Style::of_file(STDOUT_FILENO)));
  const bool any = std::any_of(tuned.answers.begin(), tuned.answers.end(),
                               [](const sweep::TuneAnswer& answer) { return answer.found; });
  return any ? kOk : kCheckFailed;
}

}  // namespace

void add_tune(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("tune",
                                         "find the cheapest settings that reach an accuracy, or the most "
                                         "accurate within a cost, on every engine");
  auto options = std::make_shared<TuneCommandOptions>();
  command->add_option("name", options->name, "a scenario, a scene file or a case file")
      ->required()
      ->type_name("NAME|FILE");
  command
      ->add_option("--tolerance", options->tolerance,
                   "largest allowed error, in the unit of the metric, like 1e-3")
      ->type_name("X");
  command
      ->add_option("--cost-us", options->budget, "instead: cost allowed for a step of the game, microseconds")
      ->type_name("US");
  add_metric(*command, options->metric,
             "the error to minimise (default position_error; for a case file expected_miss, which must be at "
             "most 1)");
  command->add_option("--dt", options->step, "step of the game in s (default 1/60); engines may divide it")
      ->type_name("DT");
  command->add_option("--budget", options->seconds, "time limit of the whole search, s (default 45)")
      ->type_name("T");
  add_file_duration(*command, options->duration);
  options->engines.add_to(*command);
  add_size(*command, options->size);
  command->add_option("--format", options->format, "console or json")
      ->check(CLI::IsMember({"console", "json"}));
  // Older names, not in the help.
  command->add_option("--budget-us", options->budget)->group("");
  command->add_option("--step", options->step)->group("");
  command->add_option("--seconds", options->seconds)->group("");
  command->footer(
      "Examples:\n  plumb tune pendulum_chain --size 20 --tolerance 1e-3\n  plumb tune my_scene.json "
      "--cost-us 200 --engine plumb,plumb-float,box2d\nExit codes: 0 settings were found, 1 none meet the "
      "requirement, 2 usage, 130 interrupted. See docs/trade.md.");
  command->callback([&chosen, options] { chosen = [options] { return start_tune(*options); }; });
}

}  // namespace plumb::app
