#include "harness/stress/stress.h"

#include <algorithm>
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
#include "app/usage.h"
#include "harness/interrupt.h"
#include "harness/stress/map_text.h"

namespace plumb::app {
namespace {

namespace stress = harness::stress;

constexpr double kCellSeconds = 10, kQuickSeconds = 3, kMegabytes = 2048;

struct StressCommandOptions {
  std::vector<std::string> names;
  EngineOptions engines;
  std::string out = "stress", format = "console", cell_seconds, cell_memory;
  int jobs = 0;
  bool quick = false, list = false;
};

std::vector<const stress::Family*> chosen_families(const std::vector<std::string>& names) {
  std::vector<const stress::Family*> out;
  for (const std::string& name : names) {
    const stress::Family* family = &stress::find_family(name);
    if (std::find(out.begin(), out.end(), family) == out.end()) out.push_back(family);
  }
  if (!names.empty()) return out;
  for (const stress::Family& family : stress::all()) out.push_back(&family);
  return out;
}

void list(const std::vector<const stress::Family*>& families, const harness::Style& style) {
  for (const stress::Family* family : families) {
    std::string values;
    for (const double value : family->values) values += " " + stress::value_text(value);
    print(fmt::format("{}\n  {}\n  {}{}:{}\n  {}\n", style.paint(family->name, harness::Style::Ink::Bold),
                      harness::wrap(family->title, style.width - 2, 2), family->axis,
                      family->unit.empty() ? "" : ", " + family->unit, values,
                      harness::wrap("right is: " + family->rule, style.width - 2, 2)));
  }
}

void print_data(const std::vector<stress::Cell>& cells, const std::string& format) {
  if (format == "csv") {
    print(fmt::format("{}\n", stress::csv_columns()));
    for (const stress::Cell& cell : cells) print(stress::to_csv(cell) + "\n");
    return;
  }
  std::string text = "[";
  for (const stress::Cell& cell : cells) text += (text.size() > 1 ? ",\n" : "\n") + stress::to_json(cell);
  print(text + "\n]\n");
}

stress::StressOptions what_to_run(const StressCommandOptions& options,
                                  std::vector<std::unique_ptr<reference::Backend>>& programs) {
  stress::StressOptions what{.families = chosen_families(options.names),
                             .engines = chosen_engines(options.engines, programs),
                             .folder = options.out,
                             .quick = options.quick};
  what.jobs =
      options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  what.cell_seconds = options.quick ? kQuickSeconds : kCellSeconds;
  if (!options.cell_seconds.empty()) what.cell_seconds = parse_positive("--timeout", options.cell_seconds);
  const double megabytes =
      options.cell_memory.empty() ? kMegabytes : parse_positive("--cell-memory", options.cell_memory);
  if (megabytes < 1 || megabytes > 1e9)
    throw UsageError(fmt::format("--cell-memory is '{}'; give megabytes, like 2048", options.cell_memory));
  what.cell_memory = static_cast<std::size_t>(megabytes) << 20;
  return what;
}

int start_stress(const StressCommandOptions& options) {
  const harness::Style style = harness::Style::of_file(STDOUT_FILENO);
  if (options.list) {
    list(chosen_families(options.names), style);
    return kOk;
  }
  std::vector<std::unique_ptr<reference::Backend>> programs;
  const stress::StressOptions what = what_to_run(options, programs);
  ProgressLine progress;
  harness::catch_interrupts();
  stress::StressEvents events;
  events.progress = [&](const harness::Progress& now) { progress.show(now); };
  events.finished = [&](const stress::Family& family, const std::vector<stress::Cell>& cells) {
    progress.clear();
    if (options.format == "console") print(stress::map_text(family, cells, style) + "\n");
    flush();
  };
  const stress::Stressed done = stress::stress(what, events);
  progress.clear();
  if (done.interrupted) {
    notice(fmt::format("interrupted; the same command continues from the results in {}", options.out));
    return kInterrupted;
  }
  if (options.format != "console") {
    print_data(done.cells, options.format);
    return kOk;
  }
  print(stress::legend(style) + "\n" + stress::survival_text(done.cells, style));
  print(fmt::format("\ncells are in {0}/stress.jsonl; `plumb report {0}` draws the maps\n", options.out));
  return kOk;
}

}  // namespace

void add_stress(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "stress", "show where each engine breaks in families of scenes, as maps along an axis");
  auto options = std::make_shared<StressCommandOptions>();
  command->add_option("families", options->names, "families of scenes (default: all); see --list")
      ->type_name("FAMILY");
  options->engines.add_to(*command);
  command
      ->add_option("--out", options->out, "folder for the cells; an existing run continues (default stress)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_option("--jobs", options->jobs, "number of cells at the same time (default: one per core)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command->add_flag("--quick", options->quick, "every third value of each axis, and 3 s per cell");
  command->add_option("--timeout", options->cell_seconds, "time limit of a run, s (default 10)")
      ->type_name("T");
  command
      ->add_option("--cell-memory", options->cell_memory,
                   "limit of the address space of a cell's process in megabytes (default 2048)")
      ->type_name("MB");
  command->add_option("--format", options->format, "console, json or csv")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command->add_flag("--list", options->list, "list the families, with their axes and bounds");
  // Older names, not in the help.
  command->add_option("--cell-seconds", options->cell_seconds)->group("");
  command->footer(
      "Examples:\n  plumb stress --quick\n  plumb stress mass_ratio_stack stack_height --engine "
      "plumb-float,box2d --out tall\n  plumb stress --list\n  plumb stress bullet_circle --engine-command "
      "\"mine=python3 my_engine.py\" --out mine\nEach cell runs in its own process. If it is stopped, at "
      "most the cells "
      "that run are lost; the same command\ncontinues. See docs/stress.md. Exit codes: 0 done, whatever the "
      "outcomes; 2 usage; 130\ninterrupted.");
  command->callback([&chosen, options] { chosen = [options] { return start_stress(*options); }; });
}

}  // namespace plumb::app
