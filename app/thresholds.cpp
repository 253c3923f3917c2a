#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/progress_line.h"
#include "app/selection.h"
#include "app/usage.h"
#include "harness/interrupt.h"
#include "harness/stress/settings.h"
#include "harness/thresholds/find.h"
#include "harness/thresholds/finding_table.h"
#include "harness/thresholds/record.h"

namespace plumb::app {
namespace {

namespace thresholds = harness::thresholds;

struct ThresholdsOptions {
  std::vector<std::string> names;
  EngineOptions engines;
  std::string out = "stress", seconds, format = "console";
  int digits = 3;
  int jobs = 0;
  bool list = false, all_settings = false;
};

std::vector<const thresholds::Threshold*> chosen_thresholds(const std::vector<std::string>& names) {
  std::vector<const thresholds::Threshold*> out;
  for (const std::string& name : names) out.push_back(&thresholds::find(name));
  if (names.empty())
    for (const thresholds::Threshold& threshold : thresholds::all()) out.push_back(&threshold);
  return out;
}

int list() {
  const harness::Style style = harness::Style::of_file(STDOUT_FILENO);
  for (const thresholds::Threshold& threshold : thresholds::all()) {
    print(style.paint(fmt::format("{:<21}", threshold.name), harness::Style::Ink::Bold) +
          harness::wrap(threshold.quantity, style.width - 21, 21) + "\n");
  }
  return kOk;
}

void show(const std::vector<thresholds::Finding>& findings, const std::string& format) {
  if (format == "console") {
    print(thresholds::finding_table(findings, harness::Style::of_file(STDOUT_FILENO)));
    return;
  }
  if (format == "csv") print(thresholds::finding_csv_header() + "\n");
  for (const thresholds::Finding& finding : findings)
    print((format == "csv" ? thresholds::to_csv(finding) : thresholds::to_json(finding)) + "\n");
}

int start_thresholds(const ThresholdsOptions& options) {
  if (options.list) return list();
  std::vector<std::unique_ptr<reference::Backend>> programs;
  const std::vector<const reference::Backend*> engines = chosen_engines(options.engines, programs);
  thresholds::FindOptions how{.digits = options.digits, .jobs = options.jobs};
  if (how.jobs == 0) how.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (!options.seconds.empty()) how.seconds_a_run = parse_positive("--timeout", options.seconds);

  std::vector<thresholds::Request> requests;
  for (const thresholds::Threshold* threshold : chosen_thresholds(options.names)) {
    for (const reference::Backend* engine : engines) {
      for (const harness::stress::Setting& setting : harness::stress::settings_of(*engine)) {
        if (setting.name == "default" || options.all_settings)
          requests.push_back({threshold, engine, setting.name, setting.with(thresholds::kStep)});
      }
    }
  }

  thresholds::Record record(options.out);
  ProgressLine progress;
  harness::catch_interrupts();
  const auto say = [&](const harness::Progress& now) { progress.show(now); };
  const thresholds::Searched searched = thresholds::find_missing(requests, how, record, say);
  progress.clear();
  if (searched.interrupted) {
    notice(fmt::format("interrupted; the same command continues from the results in {}", record.path()));
    return kInterrupted;
  }
  show(searched.findings, options.format);
  if (options.format == "console") print(fmt::format("\nThese are in {}.\n", record.path()));
  flush();
  return kOk;
}

}  // namespace

void add_thresholds(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "thresholds", "find each engine's critical values by bisection, and compare them with the exact ones");
  auto options = std::make_shared<ThresholdsOptions>();
  command->add_option("names", options->names, "thresholds, see --list (default: all)")->type_name("NAME");
  options->engines.add_to(*command);
  command->add_option("--digits", options->digits, "significant digits of a critical value (default 3)")
      ->check(CLI::Range(1, 4))
      ->type_name("N");
  command->add_option("--timeout", options->seconds, "time limit of a run, s (default 30)")->type_name("T");
  command->add_option("--jobs", options->jobs, "number of searches at the same time (default: one per core)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command
      ->add_option("--out", options->out,
                   "folder of thresholds.jsonl; values that it has are not searched again (default stress)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_option("--format", options->format, "console, json (one value per line) or csv")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command->add_flag("--all-settings", options->all_settings,
                    "also with the engines' other settings (docs/stress.md)");
  command->add_flag("--list", options->list, "list the thresholds");
  // Older names, not in the help.
  command->add_option("--run-seconds", options->seconds)->group("");
  command->footer(
      "Examples:\n  plumb thresholds\n  plumb thresholds ramp_friction overhang --engine plumb-float,box2d\n "
      " plumb thresholds stopped_bullet --format json --out bullets\n  plumb thresholds --engine "
      "plumb-precise --engine-command mine='python3 my_engine.py'\nIf it is stopped, at most the searches in "
      "progress are lost; the same command continues.\nSee docs/thresholds.md. Exit codes: 0 done, 2 usage, "
      "130 interrupted.");
  command->callback([&chosen, options] { chosen = [options] { return start_thresholds(*options); }; });
}

}  // namespace plumb::app
