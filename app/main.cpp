// Command line of `plumb`.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/modules.h"
#include "app/output.h"
#include "app/report_error.h"
#include "app/usage.h"
#include "engine/core/suggest.h"
#include "harness/environment.h"

namespace plumb::app {
namespace {

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

// Describes the first option that `app`, or its active subcommand, does not know, with the nearest known one.
std::string unknown_option(const CLI::App& app) {
  const CLI::App* used = &app;
  for (const CLI::App* command : app.get_subcommands()) used = command;
  std::vector<std::string> known;
  for (const CLI::Option* option : used->get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  const std::string where = used == &app ? "plumb" : "plumb " + used->get_name();
  for (const std::string& text : app.remaining(true)) {
    const std::string name = text.substr(0, text.find('='));
    return fmt::format("{} does not take '{}'{}; see `{} --help`", where, text, did_you_mean(name, known),
                       where);
  }
  return "";
}

int parse_and_run(CLI::App& app, Action& action, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  const std::vector<std::string> names = subcommand_names(app);
  if (first.empty()) {
    write_error(app.help());
    return kUsage;
  }
  if (first == "bench") return run_bench(argc, argv);
  if (first == "demo" || first == "view") return run_window(argc, argv);
  if (first.front() != '-' && std::find(names.begin(), names.end(), first) == names.end())
    throw UsageError(
        fmt::format("'{}' is not a subcommand{}; see `plumb --help`", first, did_you_mean(first, names)));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return say(app, success);
  } catch (const CLI::ExtrasError& error) {
    const std::string unknown = unknown_option(app);
    throw UsageError(unknown.empty() ? error.what() : unknown);
  } catch (const CLI::ParseError& error) {
    std::string where = "plumb";
    for (const CLI::App* command : app.get_subcommands()) where += " " + command->get_name();
    throw UsageError(fmt::format("{}; see `{} --help`", error.what(), where));
  }
  for (const CLI::App* command : app.get_subcommands()) refuse_empty_values(*command);
  return action ? action() : kUsage;
}

int main(int argc, char** argv) {
  keep_standard_files();
  // Make such writes fail with an error, which is reported, instead of ending the program.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app("plumb, a 2D rigid-body engine and the harness that verifies it", "plumb");
  app.set_version_flag("--version", fmt::format("plumb {}", harness::version()));
  app.require_subcommand(0, 1);
  app.footer(
      "Examples:\n  plumb compare\n  plumb compare pendulum_chain --size 20 --engine plumb,box2d\n"
      "  plumb run free_fall/vacuum --engine plumb-precise --rate 10\n  plumb explain "
      "elastic_collision/oblique\n  plumb check -- python3 my_engine.py\n"
      "Each subcommand has its own --help. Exit codes: 0 ok, 1 a check failed, 2 usage or bad input,\n"
      "3 no unit is free (work --next), 4 no measurements (reality), 130 interrupted.\n"
      "PLUMB_SCENARIOS names modules of scenarios to load, built by plumb_add_scenarios\n"
      "(docs/adding-a-scenario.md).");
  Action action;
  add_list(app, action);
  add_new(app, action);
  add_engines(app, action);
  add_explain(app, action);
  add_run(app, action);
  add_scene(app, action);
  add_compare(app, action);
  add_check(app, action);
  add_verdict(app, action);
  add_bisect(app, action);
  add_sweep(app, action);
  add_front(app, action);
  add_tune(app, action);
  add_stress(app, action);
  add_hunt(app, action);
  add_thresholds(app, action);
  add_limits(app, action);
  add_reality(app, action);
  add_report(app, action);
  add_agreement(app, action);
  add_plan(app, action);
  add_submit(app, action);
  add_work(app, action);
  add_status(app, action);
  add_gather(app, action);
  add_bench(app);
  add_window(app);
  return reporting_errors([&] {
    load_scenario_modules();
    return parse_and_run(app, action, argc, argv);
  });
}

}  // namespace
}  // namespace plumb::app

int main(int argc, char** argv) { return plumb::app::main(argc, argv); }
