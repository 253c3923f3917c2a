#include "harness/compare.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/progress_line.h"
#include "app/result_log.h"
#include "app/source.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/summary.h"
#include "harness/table.h"
#include "reference/process_backend.h"

namespace plumb::app {
namespace {

using harness::Result;
using harness::Style;

struct Options {
  std::vector<std::string> names, engines, engine_commands;
  std::string dt, timeout, out = "results", format = "console";
  int size = 0;
  bool no_cost = false;
};

std::vector<scenarios::Instance> chosen_instances(const Options& options) {
  std::vector<scenarios::Instance> out;
  const auto append = [&](const std::string& name) {
    for (scenarios::Instance& instance : scenarios::select(name, options.size))
      out.push_back(std::move(instance));
  };
  for (const std::string& name : options.names) append(name);
  if (!options.names.empty()) return out;
  for (const scenarios::Scenario& scenario : scenarios::all())
    if (options.size == 0 || scenario.scales) append(scenario.name);
  if (out.empty()) throw UsageError("--size is given, but no scenario scales");
  return out;
}

// The engines that were asked for, or all of them; programs given with --engine-command come last.
std::vector<const reference::Backend*> chosen_engines(
    const Options& options, std::vector<std::unique_ptr<reference::Backend>>& programs) {
  std::vector<const reference::Backend*> out;
  for (const std::string& name : options.engines) {
    const reference::Backend* backend = &reference::find_backend(name);
    if (std::find(out.begin(), out.end(), backend) == out.end()) out.push_back(backend);
  }
  if (options.engines.empty()) out = reference::backends();
  for (const std::string& text : options.engine_commands) {
    const std::size_t equals = text.find('=');
    const std::vector<std::string> command =
        equals == std::string::npos ? std::vector<std::string>{} : split_command(text.substr(equals + 1));
    if (equals == 0 || command.empty())
      throw UsageError(
          fmt::format("--engine-command is '{}': give NAME=COMMAND, see docs/protocol.md", text));
    const std::string name = text.substr(0, equals);
    for (const reference::Backend* other : out)
      if (other->name() == name)
        throw UsageError(
            fmt::format("--engine-command: there is an engine '{}' already; choose another name", name));
    programs.push_back(reference::make_process_backend(name, command));
    out.push_back(programs.back().get());
    if (const reference::Identity identity = out.back()->identity(); !identity.available)
      throw UsageError(fmt::format("--engine-command {}: {}", text, identity.reason));
  }
  return out;
}

std::string as_text(std::span<const Result> results, const std::string& format, const Style& style) {
  if (format == "console") return harness::table(results, style) + "\n";
  std::string text;
  for (const Result& result : results)
    text += (format == "json" ? harness::to_json_with_environment(result) : harness::csv_row(result)) + "\n";
  return text;
}

int start(const Options& options) {
  std::vector<std::unique_ptr<reference::Backend>> programs;
  harness::CompareOptions what{.instances = chosen_instances(options),
                               .engines = chosen_engines(options, programs)};
  if (!options.dt.empty()) what.settings.dt = parse_positive("--dt", options.dt);
  if (!options.timeout.empty()) what.seconds_a_run = parse_positive("--timeout", options.timeout);
  what.measure_cost = !options.no_cost;
  for (const reference::Backend* backend : what.engines)
    if (backend->identity().available) backend->method(what.settings);  // throws for what it cannot take

  ResultLog log(options.out);
  const Style style = Style::of_file(STDOUT_FILENO);
  ProgressLine progress;
  harness::catch_interrupts();
  if (options.format == "csv") print(harness::csv_header() + "\n");
  harness::CompareEvents events;
  events.progress = [&](const harness::Progress& now) { progress.show(now); };
  events.finished = [&](std::span<const Result> results) {
    log.append(results);
    progress.clear();
    print(as_text(results, options.format, style));
    flush();
  };
  const harness::Comparison comparison = harness::compare(what, events);
  progress.clear();
  if (options.format == "console") print(harness::summary(comparison.results, style));
  flush();
  if (comparison.interrupted) {
    fmt::print(stderr, "plumb: interrupted; {} finished results are in {}\n", comparison.results.size(),
               log.path());
    return kInterrupted;
  }
  return comparison.as_expected() ? kOk : kCheckFailed;
}

}  // namespace

void add_compare(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "compare", "run scenarios on engines, hold each run against the truth, and measure its cost");
  auto options = std::make_shared<Options>();
  command->add_option("names", options->names, "scenarios, variants or sizes (default: all)")
      ->type_name("NAME");
  command->add_option("--engine", options->engines, "engines, parted by commas (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("E");
  command
      ->add_option("--engine-command", options->engine_commands,
                   "one more engine: a program that speaks docs/protocol.md; may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME=COMMAND");
  add_size(*command, options->size);
  command->add_option("--dt", options->dt, "step in s, like 0.01 or 1/240 (default 1/60)")->type_name("X");
  command->add_option("--timeout", options->timeout, "s after which a run is stopped (default 300)")
      ->type_name("T");
  command->add_option("--out", options->out, "folder whose results.jsonl is appended to (default results)")
      ->type_name("DIR");
  command->add_option("--format", options->format, "console, json (a result a line) or csv")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command->add_flag("--no-cost", options->no_cost, "leave out what a step costs");
  command->footer(
      "Examples:\n  plumb compare\n  plumb compare free_fall pendulum_chain --size 20 --engine plumb,box2d\n"
      "  plumb compare elastic_collision/oblique --dt 1/240 --format json --out /tmp/oblique\n"
      "  plumb compare free_fall --engine plumb --engine-command mine='python3 my_engine.py'\n"
      "Exit codes: 0 all as expected, 1 a check failed, 2 usage, 130 interrupted (finished results kept).");
  command->callback([&chosen, options] { chosen = [options] { return start(*options); }; });
}

}  // namespace plumb::app
