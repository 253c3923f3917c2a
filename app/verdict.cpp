#include "harness/verdict.h"

#include <algorithm>
#include <chrono>
#include <cmath>
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
#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/isolate.h"
#include "harness/isolated_run.h"
#include "harness/junit.h"
#include "harness/text_file.h"
#include "reference/process_backend.h"

namespace plumb::app {
namespace {

using harness::Result;
using Clock = std::chrono::steady_clock;

struct VerdictOptions {
  std::vector<std::string> command, names;
  std::string engine, budget = "60", format = "console", junit, json, badge, name = "yours";
};

Result not_run(const scenarios::Instance& instance, const reference::Backend& engine, harness::Status status,
               const std::string& reason) {
  Result result;
  result.scenario = instance.scenario->name;
  result.variant = instance.variant;
  result.size = instance.size;
  result.label = instance.label();
  result.engine = engine.name();
  result.status = status;
  result.reason = reason;
  return result;
}

// Queries the engine about a case in this process, which caches its program's answer: the run's own process
// inherits it and need not start the program again.
void ask_about(const scenarios::Instance& instance, const reference::Backend& engine) {
  try {
    const Scene scene = instance.build().scene;
    if (engine.unsupported(scene, {}).empty()) engine.effective_settings(scene, {});
  } catch (const std::exception&) {
    return;  // the run says what is wrong
  }
}

// Runs every case in a process of its own that also computes its truth, so that the truths are computed in
// parallel too.
std::vector<Result> judge_all(const std::vector<scenarios::Instance>& cases, const reference::Backend& engine,
                              double budget) {
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(budget));
  const auto left = [&] { return std::chrono::duration<double>(end - Clock::now()).count(); };
  std::vector<Result> results(cases.size());
  ProgressLine progress;
  std::size_t done = 0;
  const int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  harness::isolate_all(
      cases.size(), jobs,
      [&](std::size_t i) {
        ask_about(cases[i], engine);
        return harness::ChildLimits{std::max(0.01, left())};
      },
      [&](std::size_t i) {
        if (left() <= 0)
          return harness::to_json(not_run(cases[i], engine, harness::Status::Skipped, harness::kOutOfTime));
        const harness::Case scene_case(cases[i], reference::StepSettings{}.dt);
        try {
          return harness::to_json(harness::run(scene_case, engine, {}));
        } catch (const reference::ProcessError& error) {
          using Fault = reference::ProcessError::Fault;
          if (error.fault() == Fault::Killed) throw;
          const harness::Status status = error.fault() == Fault::Timeout    ? harness::Status::Timeout
                                         : error.fault() == Fault::Crash    ? harness::Status::Crashed
                                         : error.fault() == Fault::Diverged ? harness::Status::Diverged
                                                                            : harness::Status::Failed;
          return harness::to_json(not_run(cases[i], engine, status, error.what()));
        }
      },
      [&](std::size_t i, const harness::Outcome& outcome) {
        using Kind = harness::Outcome::Kind;
        if (outcome.kind == Kind::Done) {
          results[i] = harness::result_from_json(outcome.text);
        } else if (outcome.kind == Kind::Timeout || outcome.kind == Kind::Interrupted) {
          results[i] = not_run(cases[i], engine, harness::Status::Skipped, harness::kOutOfTime);
        } else {
          const bool crashed = outcome.kind == Kind::Crashed;
          results[i] = not_run(cases[i], engine, crashed ? harness::Status::Crashed : harness::Status::Failed,
                               outcome.text);
        }
        progress.show({++done, cases.size(), cases[i].label()});
      });
  progress.clear();
  return results;
}

// Says of a miss that its bound is what an order of 2 promises: that impacts are located within the step.
void name_promise(Result& result, const scenarios::Instance& instance, int order) {
  if (order < 2 || harness::ruling_on(result) != harness::Ruling::Misses || !result.reason.empty()) return;
  const scenarios::Problem problem = instance.build();
  if (problem.truth.impacts.empty() || std::isnan(problem.second_order.position)) return;
  result.reason = fmt::format("order {} promises that impacts are located within the step", order);
}

int start_verdict(const VerdictOptions& options) {
  if (options.command.empty() == options.engine.empty())
    throw UsageError(
        "give either the command that starts an engine after `--`, or a built-in engine with --engine; see "
        "`plumb verdict --help`");
  std::unique_ptr<reference::Backend> program;
  if (!options.command.empty()) program = reference::make_process_backend(options.name, options.command);
  const reference::Backend& engine = program ? *program : reference::find_backend(options.engine);
  if (const reference::Identity identity = engine.identity(); !identity.available)
    throw UsageError(identity.reason);
  const std::vector<scenarios::Instance> cases = chosen_instances(options.names, 0);
  harness::catch_interrupts();
  std::vector<Result> results = judge_all(cases, engine, parse_positive("--budget", options.budget));
  for (Result& result : results) harness::judge(result, true, {});  // foreign engines have no declared limits
  const int order = engine.method({}).order;
  for (std::size_t i = 0; i < results.size(); ++i) name_promise(results[i], cases[i], order);
  print(options.format == "json" ? harness::verdict_json(results)
                                 : harness::verdict_text(results, harness::Style::of_file(STDOUT_FILENO)));
  flush();
  if (!options.junit.empty()) harness::write_whole(options.junit, harness::junit(results));
  if (!options.json.empty()) harness::write_whole(options.json, harness::verdict_json(results));
  if (!options.badge.empty()) harness::write_whole(options.badge, harness::verdict_badge(results));
  if (harness::interrupted()) return kInterrupted;
  const harness::Score score = harness::score_of(results);
  return score.misses + score.broke == 0 ? kOk : kCheckFailed;
}

}  // namespace

void add_verdict(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "verdict", "run all scenarios on one engine, with a verdict for each case; misses come first");
  auto options = std::make_shared<VerdictOptions>();
  command
      ->add_option("command", options->command,
                   "command of a program that speaks the line protocol (docs/protocol.md); put it after --")
      ->type_name("COMMAND...");
  command
      ->add_option("--engine", options->engine,
                   "an engine that is built in or installed, instead of a command")
      ->type_name("E");
  command
      ->add_option("--case", options->names,
                   "only these scenarios, case files or folders of them; may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME|FILE");
  command->add_option("--name", options->name, "name of the engine in the output (default yours)")
      ->type_name("NAME");
  command->add_option("--budget", options->budget, "time limit of the whole run, s (default 60)")
      ->type_name("T");
  command->add_option("--format", options->format, "console or json")
      ->check(CLI::IsMember({"console", "json"}));
  command->add_option("--junit", options->junit, "also write JUnit XML")
      ->check(problem_with_path)
      ->type_name("FILE");
  command->add_option("--json", options->json, "also write the verdicts as JSON")
      ->check(problem_with_path)
      ->type_name("FILE");
  command->add_option("--badge", options->badge, "also write a badge as SVG")
      ->check(problem_with_path)
      ->type_name("FILE");
  command->footer(
      "Examples:\n  plumb verdict -- python3 my_engine.py\n  plumb verdict --engine box2d --junit report.xml "
      "--badge badge.svg\n"
      "Exit codes: 0 all that ran agree, 1 some do not, 2 usage, 130 interrupted. See docs/cases.md.");
  command->callback([&chosen, options] { chosen = [options] { return start_verdict(*options); }; });
}

}  // namespace plumb::app
