#include "harness/sweep/sweep.h"

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/local_work.h"
#include "app/output.h"
#include "app/plan.h"
#include "app/progress_line.h"
#include "app/selection.h"
#include "app/source.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/cluster/gather.h"
#include "harness/cluster/work.h"
#include "harness/interrupt.h"
#include "harness/sweep/front_tables.h"
#include "harness/sweep/rows.h"

namespace plumb::app {
namespace {

namespace cluster = harness::cluster;
namespace sweep = harness::sweep;

struct SweepCommandOptions {
  std::vector<std::string> names;
  EngineOptions engines;
  std::string budget, duration, explore, out = "sweep", format = "console";
  std::vector<std::string> from;
  int size = 0;
  int jobs = 1;
};

// Throws if two scenes have the same label, because a sweep's folder identifies scenes by label.
void require_different(const std::vector<scenarios::Instance>& instances) {
  std::set<std::string> labels;
  for (const scenarios::Instance& instance : instances)
    if (!labels.insert(instance.label()).second)
      throw UsageError(
          fmt::format("'{}' is given twice; give each scene once, and unique names to scenes from files",
                      instance.label()));
}

// Prints the fronts of a folder of results, and which engine dominates.
void show(const std::vector<harness::Result>& rows, const SweepCommandOptions& options) {
  if (options.format != "console") return print(sweep::trade_data(rows, nullptr, options.format));
  const harness::Style style = harness::Style::of_file(STDOUT_FILENO);
  print(sweep::dominance_table(sweep::dominance(rows), style));
  print(
      fmt::format("\nresults are in {0}/results.jsonl; `plumb front {0}` prints this again, `plumb report "
                  "{0}` draws it\n",
                  options.out));
}

// Plans the sweep in a folder of work in its results, does the units here, and gathers them, as `plumb plan`,
// `submit --on local` and `gather` do.
int sweep_on_cores(const SweepCommandOptions& options) {
  const std::string folder = std::filesystem::absolute(options.out + "/work").lexically_normal().string();
  std::vector<std::string> words{"sweep"};
  words.insert(words.end(), options.names.begin(), options.names.end());
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {name, value});
  };
  for (const std::string& name : options.engines.names) add("--engine", name);
  for (const std::string& command : options.engines.commands) add("--engine-command", command);
  add("--size", options.size > 0 ? std::to_string(options.size) : "");
  add("--duration", options.duration);
  add("--budget", options.budget);
  if (!std::filesystem::exists(folder + "/plan.json")) {
    cluster::add_to_plan(
        folder,
        plan_of({.folder = folder, .unit_seconds = {}, .earlier = {}, .at_once = options.jobs}, words));
  } else if (const cluster::Plan plan = cluster::read_plan(folder); plan.commands.front() != words) {
    throw Error(Error::Kind::Value, fmt::format("folder '{}'", options.out), "", "",
                fmt::format("belongs to another sweep, `plumb {}`; choose another folder with --out",
                            fmt::join(plan.commands.front(), " ")));
  } else {
    cluster::require_same_program(folder, plan, cluster::this_program());
  }
  // The time is given: what was disturbed is not measured again.
  if (!do_here({.folder = folder, .jobs = options.jobs, .repeats = false})) {
    notice(fmt::format("interrupted; the same command continues from the results in {}", options.out));
    return kInterrupted;
  }
  const cluster::Gathered gathered =
      cluster::gather(folder, cluster::read_plan(folder), options.out, cluster::WorkOptions{}.expiry);
  for (const auto& [kind, numbers] : gathered.survey.failed)
    notice(fmt::format("units {} failed: {}; `plumb status {}` says more", cluster::ranges(numbers), kind,
                       folder));
  if (gathered.lines.empty()) return kCheckFailed;
  const std::vector<harness::Result> rows = sweep::read_rows(options.out);
  if (options.format == "console")
    for (const std::vector<harness::Result>& scene : sweep::by_label(rows))
      print(sweep::front_table(scene, nullptr, harness::Style::of_file(STDOUT_FILENO)) + "\n");
  show(rows, options);
  return gathered.survey.failed.empty() ? kOk : kCheckFailed;
}

int start_sweep(const SweepCommandOptions& options) {
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
    throw UsageError("--duration needs a scene file: scenarios have their own duration");
  if (options.names.empty()) what.instances = chosen_instances({}, options.size);
  require_different(what.instances);
  what.engines = chosen_engines(options.engines, programs);
  what.folder = options.out;
  if (!options.budget.empty()) what.budget = parse_positive("--budget", options.budget);
  if (!options.explore.empty()) what.only_explore = parse_positive("--explore", options.explore);
  what.from = options.from;
  if (options.jobs > 1) {
    if (what.only_explore > 0 || !what.from.empty())
      throw UsageError("--jobs cannot be combined with --explore or --from");
    return sweep_on_cores(options);
  }

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
    notice(fmt::format("interrupted; the same command continues from the results in {}", options.out));
    return kInterrupted;
  }
  if (swept.dropped > 0)
    notice(
        fmt::format("the budget of {:g} s was too short for the costs of {} settings; measure them with a "
                    "larger --budget in a new folder",
                    what.budget, swept.dropped));
  if (what.only_explore == 0) show(swept.rows, options);
  return kOk;
}

}  // namespace

void add_sweep(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "sweep", "run engines with many settings, and show what accuracy costs on each of them");
  auto options = std::make_shared<SweepCommandOptions>();
  command
      ->add_option("names", options->names,
                   "scenarios, variants, sizes, scene files, case files or folders of these (default: all)")
      ->type_name("NAME|FILE");
  options->engines.add_to(*command);
  add_size(*command, options->size);
  add_file_duration(*command, options->duration);
  command->add_option("--budget", options->budget, "time limit of the whole sweep, s (default 540)")
      ->type_name("T");
  command
      ->add_option("--jobs", options->jobs,
                   "number of searches at the same time, as units of a folder of work in DIR (see `plumb "
                   "plan`); costs are measured one at a time (default 1)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command
      ->add_option("--explore", options->explore,
                   "time limit in s for the search for the fronts, without costs; measure these with another "
                   "sweep and --from")
      ->type_name("T");
  command->add_option("--from", options->from, "folder of a sweep whose runs are reused; may be repeated")
      ->allow_extra_args(false)
      ->type_name("DIR");
  command
      ->add_option("--out", options->out,
                   "folder for the results; an existing sweep continues (default sweep)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_option("--format", options->format, "console, json or csv")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command->footer(
      "Examples:\n  plumb sweep free_fall off_centre_torque elastic_collision pendulum_chain\n  plumb sweep "
      "pendulum_chain --size 20 --engine plumb,box2d --budget 60 --out chain\n  plumb sweep "
      "my_scene.json --out mine\nIf it is stopped, at most the run in progress is lost; the same command "
      "continues.\nSee docs/trade.md. Exit codes: 0 done, 2 usage, 130 interrupted.");
  command->callback([&chosen, options] { chosen = [options] { return start_sweep(*options); }; });
}

}  // namespace plumb::app
