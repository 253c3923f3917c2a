#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/guard.h"
#include "app/output.h"
#include "app/selection.h"
#include "app/settings.h"
#include "app/usage.h"
#include "harness/compare.h"
#include "harness/course/course.h"
#include "harness/course/report.h"
#include "harness/interrupt.h"
#include "harness/summary.h"
#include "harness/table.h"
#include "reference/process_backend.h"

namespace plumb::app {
namespace {

using harness::Style;

struct CheckOptions {
  std::vector<std::string> command, cases;
  std::string engine, dt, timeout = "10", format = "console";
  std::optional<int> chapter;
  bool show = false;
};

constexpr const char* kOwnEngine = "yours";  // until it has said its name
constexpr double kLargestStep = 1.0 / 30;

std::vector<course::Chapter> chosen_chapters(std::optional<int> number) {
  std::vector<course::Chapter> all = course::chapters();
  if (!number) return all;
  for (course::Chapter& chapter : all)
    if (chapter.number == *number) return {std::move(chapter)};
  throw UsageError(fmt::format("--chapter is {}; the chapters are 1 to {}", *number, all.size()));
}

// Opens the window with the first check that failed, in place of this program.
[[noreturn]] void show(const CheckOptions& options, const course::Outcome& failed) {
  constexpr const char* kDemos[] = {"bouncing_ball", "cannonballs", "pool_break", "spinning_boxes",
                                    "ragdoll"};
  std::string command;
  for (const std::string& word : options.command) {
    const char quote = word.find('\'') == std::string::npos ? '\'' : '"';
    command += fmt::format("{}{}{}{}", command.empty() ? "" : " ", quote, word, quote);
  }
  std::vector<std::string> words{"plumb",
                                 "demo",
                                 kDemos[failed.chapter->number - 1],
                                 "--engine-command",
                                 fmt::format("{}={}", kOwnEngine, command),
                                 "--check",
                                 failed.check->name};
  if (!options.dt.empty()) words.insert(words.end(), {"--dt", options.dt});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  run_window(static_cast<int>(words.size()), arguments.data());
  throw std::logic_error("the window's program was not started");
}

int examine(const CheckOptions& options, const reference::Backend& engine) {
  reference::StepSettings settings;
  if (!options.dt.empty()) settings.dt = parse_positive("--dt", options.dt);
  if (settings.dt > kLargestStep)
    throw UsageError(fmt::format("--dt is '{}'; the checks require steps of 1/30 s or less", options.dt));
  engine.method(settings);  // throws for settings that the engine rejects

  const std::vector<course::Chapter> chapters = chosen_chapters(options.chapter);
  const Style style = Style::of_file(STDOUT_FILENO);
  const bool console = options.format == "console";
  const course::Chapter* at = nullptr;
  const auto outcomes = course::examine(engine, settings, chapters, [&](const course::Outcome& outcome) {
    if (!console) return;
    if (outcome.chapter != at) print(course::heading(*outcome.chapter, style));
    at = outcome.chapter;
    print(course::line(outcome, style));
    flush();
  });
  print(console ? course::score(outcomes, style) : course::as_json(std::string(engine.name()), outcomes));
  flush();
  if (options.show) {
    const auto failed = std::ranges::find_if(outcomes, [](const course::Outcome& outcome) {
      return outcome.finding.verdict == course::Verdict::Fail && !outcome.runs.empty();
    });
    if (failed != outcomes.end()) show(options, *failed);
    notice("no check failed: there is nothing to show");
  }
  return course::all_passed(outcomes) ? kOk : kCheckFailed;
}

// Runs case files in place of the course.
int examine_cases(const CheckOptions& options, const reference::Backend& engine) {
  harness::CompareOptions what{.instances = {}, .engines = {&engine}};
  for (const std::string& name : options.cases)
    if (case_files(name).empty())
      throw UsageError(fmt::format(
          "--case is '{}', which is neither a case file nor a folder of case files; see docs/cases.md",
          name));
  what.instances = chosen_instances(options.cases, 0);
  if (!options.dt.empty()) what.settings.dt = parse_positive("--dt", options.dt);
  what.measure_cost = false;
  engine.method(what.settings);  // throws for settings that the engine rejects
  const Style style = Style::of_file(STDOUT_FILENO);
  harness::CompareEvents events;
  events.finished = [&](std::span<const harness::Result> results) {
    if (options.format == "json") {
      for (const harness::Result& result : results) print(harness::to_json(result) + "\n");
    } else {
      print(harness::table(results, style) + "\n");
    }
    flush();
  };
  harness::catch_interrupts();
  const harness::Comparison comparison = harness::compare(what, events);
  if (options.format == "console") print(harness::summary(comparison.results, style));
  flush();
  return comparison.interrupted ? kInterrupted : comparison.as_expected() ? kOk : kCheckFailed;
}

int examine_engine(const CheckOptions& options, const reference::Backend& engine) {
  return options.cases.empty() ? examine(options, engine) : examine_cases(options, engine);
}

int start_check(const CheckOptions& options) {
  if (options.chapter && !options.cases.empty())
    throw UsageError("--chapter applies to the course and cannot be combined with --case");
  if (options.command.empty() == options.engine.empty())
    throw UsageError(
        "give either the command that starts your engine after `--`, or a built-in engine with --engine; see "
        "`plumb check --help`");
  if (options.show && options.command.empty()) throw UsageError("--show needs the command of your engine");
  const double seconds = parse_positive("--timeout", options.timeout);
  if (!options.engine.empty()) {
    const reference::Backend& engine = reference::find_backend(options.engine);
    if (const reference::Identity identity = engine.identity(); !identity.available)
      throw UsageError(fmt::format("engine '{}' is not available: {}", options.engine, identity.reason));
    return guarded(options.engine, [&] { return examine_engine(options, engine); });
  }
  const reference::ProcessLimits limits{.seconds = seconds};
  auto engine = reference::make_process_backend(kOwnEngine, options.command, "", limits);
  const reference::Identity identity = engine->identity();
  if (!identity.available) {
    const bool late = identity.reason.find("did not answer within") != std::string::npos;
    throw UsageError(identity.reason + (late ? "; --timeout sets the limit, in s" : ""));
  }
  if (!identity.own_name.empty())
    engine = reference::make_process_backend(identity.own_name, options.command, "", limits);
  return examine_engine(options, *engine);
}

}  // namespace

void add_check(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "check", "check an engine chapter by chapter with the tasks of the course, and name its mistakes");
  auto options = std::make_shared<CheckOptions>();
  command
      ->add_option("command", options->command,
                   "the command that starts your engine (docs/protocol.md); put it after --")
      ->type_name("COMMAND...");
  command->add_option("--engine", options->engine, "check this built-in engine instead of a command")
      ->type_name("E");
  command->add_option("--chapter", options->chapter, "only this chapter, 1 to 5")
      ->type_name("N")
      ->check([](const std::string& text) -> std::string {
        int number = 0;
        return CLI::detail::lexical_cast(text, number)
                   ? ""
                   : fmt::format("'{}' is not a chapter; give 1 to 5", text);
      });
  command
      ->add_option("--case", options->cases,
                   "instead of the course: a case file or a folder of case files; may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE|DIR");
  command->add_option("--dt", options->dt, "step in s, like 0.01 or 1/240 (default 1/60)")->type_name("DT");
  command
      ->add_option("--timeout", options->timeout, "time limit for each line of the program, s (default 10)")
      ->type_name("T");
  command->add_flag("--show", options->show,
                    "open a window with the first check that failed, and the right motion as an outline");
  command->add_option("--format", options->format, "console or json")
      ->check(CLI::IsMember({"console", "json"}));
  command->footer(
      "Examples:\n  plumb check -- python3 docs/course/starters/ball.py\n  plumb check --chapter 3 -- "
      "./my_engine --quiet\n  plumb check --show -- python3 my_engine.py\n  plumb check --engine plumb "
      "--format json\n  plumb check --case my_case.json -- ./my_engine\nA feature that the engine does not "
      "declare is reported as \"not yet\". The chapters are in docs/course.\nExit codes: 0 all checks pass, "
      "1 some do not, 2 usage, or a program that does not answer \"hello\".");
  command->callback([&chosen, options] { chosen = [options] { return start_check(*options); }; });
}

}  // namespace plumb::app
