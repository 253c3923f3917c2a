#include "harness/sweep/sweep.h"

#include <memory>
#include <set>
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
#include "app/source.h"
#include "app/usage.h"
#include "harness/interrupt.h"
#include "harness/sweep/front_tables.h"

namespace plumb::app {
namespace {

namespace sweep = harness::sweep;

struct Options {
  std::vector<std::string> names;
  EngineOptions engines;
  std::string budget, duration, out = "sweep", format = "console";
  int size = 0;
  int jobs = 0;
};

// Throws if two scenes have the same label, because a sweep's folder identifies scenes by label.
void require_different(const std::vector<scenarios::Instance>& instances) {
  std::set<std::string> labels;
  for (const scenarios::Instance& instance : instances)
    if (!labels.insert(instance.label()).second)
      throw UsageError(
          fmt::format("'{}' is named twice: give each scene once, and files' scenes names of their own",
                      instance.label()));
}

int start(const Options& options) {
  std::vector<std::unique_ptr<reference::Backend>> programs;
  std::vector<std::unique_ptr<scenarios::Scenario>> files;
  sweep::SweepOptions what;
  for (const std::string& name : options.names) {
    if (is_file(name) && case_files(name).empty()) {
      what.instances.push_back(file_instance(name, options.duration, files));
    } else {
      for (scenarios::Instance& instance : chosen_instances({name}, options.size))
        what.instances.push_back(std::move(instance));
    }
  }
  if (!options.duration.empty() && files.empty())
    throw UsageError("--duration goes with a scene file: scenarios have their own");
  if (options.names.empty()) what.instances = chosen_instances({}, options.size);
  require_different(what.instances);
  what.engines = chosen_engines(options.engines, programs);
  what.folder = options.out;
  if (!options.budget.empty()) what.budget = parse_positive("--budget", options.budget);
  what.jobs =
      options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));

  ProgressLine progress;
  harness::catch_interrupts();
  sweep::SweepEvents events;
  events.progress = [&](const harness::Progress& now) { progress.show(now); };
  const harness::Style style = harness::Style::of_file(STDOUT_FILENO);
  events.finished = [&](std::span<const harness::Result> rows) {
    progress.clear();
    if (options.format == "console") print(sweep::front_table(rows, nullptr, style) + "\n");
    flush();
  };
  const sweep::Swept swept = sweep::sweep(what, events);
  progress.clear();
  if (swept.interrupted) {
    notice(fmt::format("interrupted; the same command goes on from what is in {}", options.out));
    return kInterrupted;
  }
  if (swept.dropped > 0)
    notice(fmt::format(
        "the budget of {:g} s left out the costs of {} settings; a larger --budget in a new folder "
        "measures them",
        what.budget, swept.dropped));
  if (options.format == "console") {
    print(sweep::dominance_table(sweep::dominance(swept.rows), style));
    print(
        fmt::format("\nresults are in {0}/results.jsonl; `plumb front {0}` prints this again, `plumb report "
                    "{0}` draws it\n",
                    options.out));
  } else {
    print(sweep::trade_data(swept.rows, nullptr, options.format));
  }
  return kOk;
}

}  // namespace

void add_sweep(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("sweep", "run every engine over its settings: what accuracy costs on each of them");
  auto options = std::make_shared<Options>();
  command
      ->add_option("names", options->names,
                   "scenarios, variants, sizes, scene files, case files or folders of these (default: all)")
      ->type_name("NAME|FILE");
  options->engines.add_to(*command);
  add_size(*command, options->size);
  add_file_duration(*command, options->duration);
  command->add_option("--budget", options->budget, "s that the whole may take (default 540)")->type_name("T");
  command
      ->add_option("--jobs", options->jobs,
                   "runs at a time; costs are measured one at a time (default: one a core)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command
      ->add_option("--out", options->out,
                   "folder for the results; a sweep that is there goes on (default sweep)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_option("--format", options->format, "console, json or csv")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command->footer(
      "Examples:\n  plumb sweep free_fall off_centre_torque elastic_collision pendulum_chain\n"
      "  plumb sweep pendulum_chain --size 20 --engine plumb,box2d --budget 60 --out chain\n"
      "  plumb sweep my_scene.json\n"
      "Stopping it at any instant loses at most the run under way; the same command goes on.\n"
      "See docs/trade.md. Exit codes: 0 done, 2 usage, 130 interrupted.");
  command->callback([&chosen, options] { chosen = [options] { return start(*options); }; });
}

}  // namespace plumb::app
