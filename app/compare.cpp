#include "harness/compare.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/compare_again.h"
#include "app/compare_results.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/progress_line.h"
#include "app/result_log.h"
#include "app/selection.h"
#include "app/source.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/agreement.h"
#include "harness/interrupt.h"
#include "harness/junit.h"
#include "harness/plain_words.h"
#include "harness/report/report.h"
#include "harness/summary.h"
#include "harness/table.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

using harness::Result;
using harness::Style;

struct CompareCommandOptions {
  std::vector<std::string> names;
  EngineOptions engines;
  std::string dt, timeout, out = "results", format = "console", junit, again;
  int size = 0, jobs = 1;
  bool no_cost = false, no_report = false;
};

std::string as_text(std::span<const Result> results, const std::string& format, const Style& style) {
  if (format == "console") return harness::table(results, style) + "\n";
  std::string text;
  for (const Result& result : results)
    text += (format == "json" ? harness::to_json_with_environment(result) : harness::csv_row(result)) + "\n";
  return text;
}

// Writes a report of everything in the folder, not of this run alone. Returns false if it could not be
// written; the results are saved by then.
bool report(const CompareCommandOptions& options, std::span<const reference::Backend* const> engines) {
  const std::string path = harness::report::default_report_path(options.out);
  try {
    if (!harness::report::write_report(options.out, path, engines)) {
      notice(fmt::format("interrupted; the results are complete, `plumb report {}` writes the report",
                         options.out));
      return true;
    }
  } catch (const Error& error) {
    notice(fmt::format("there is no report: {}; `plumb report {}` tries again", error.what(), options.out));
    return false;
  }
  if (options.format == "console") print(fmt::format("the report is in {}\n", path));
  flush();
  return true;
}

// Moves the first scenario that every engine runs to the front, so that a reader begins with a full table.
void put_common_first(harness::CompareOptions& what) {
  const auto runs_everywhere = [&](const scenarios::Instance& instance) {
    const scenarios::Problem problem = instance.build();
    return std::ranges::all_of(what.engines, [&](const reference::Backend* engine) {
      return !engine->identity().available || engine->unsupported(problem.scene, what.settings).empty();
    });
  };
  const auto first = std::ranges::find_if(what.instances, runs_everywhere);
  if (first != what.instances.end()) std::rotate(what.instances.begin(), first, first + 1);
}

int again(const CompareCommandOptions& options) {
  if (!options.dt.empty())
    throw UsageError("--dt cannot be combined with --again, which repeats each run with its own step");
  AgainRequest request{.results = options.again,
                       .names = options.names,
                       .size = options.size,
                       .engines = options.engines,
                       .out = options.out,
                       .format = options.format,
                       .jobs = options.jobs};
  if (!options.timeout.empty()) request.seconds_a_run = parse_positive("--timeout", options.timeout);
  return compare_again(request);
}

int start_compare(const CompareCommandOptions& options) {
  if (!options.again.empty()) return again(options);
  if (options.jobs > 1) throw UsageError("--jobs needs --again: costs are measured one at a time");
  if (mean_results(options.names))
    return compare_results(options.names.front(), options.names.back(), options.format);
  std::vector<std::unique_ptr<reference::Backend>> programs;
  EngineOptions wanted = options.engines;
  if (wanted.names.empty()) wanted.names = {"linked"};
  harness::CompareOptions what{.instances = chosen_instances(options.names, options.size),
                               .engines = chosen_engines(wanted, programs)};
  if (!options.dt.empty()) what.settings.dt = parse_positive("--dt", options.dt);
  if (!options.timeout.empty()) what.seconds_a_run = parse_positive("--timeout", options.timeout);
  what.measure_cost = !options.no_cost;
  for (const reference::Backend* backend : what.engines)
    if (backend->identity().available) backend->method(what.settings);  // throws if it rejects them

  if (options.names.empty()) put_common_first(what);

  ResultLog log(options.out);
  const Style style = Style::of_file(STDOUT_FILENO);
  ProgressLine progress;
  harness::catch_interrupts();
  if (options.format == "csv") print(harness::csv_header() + "\n");
  if (options.format == "console") print(harness::legend(style));
  const auto begin = std::chrono::steady_clock::now();
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
  if (options.format == "console") {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const std::vector<harness::Agreement> agreements = harness::agreements(comparison.results);
    // A few cases fit a screen with all names.
    const bool few = agreements.size() <= 3;
    print(harness::agreement_text(
              agreements, few ? harness::AgreementDetail::Full : harness::AgreementDetail::Brief, style) +
          "\n" + harness::summary(comparison.results, style) +
          harness::conclusion(comparison.results, style) +
          fmt::format("compared in {:.0f} s\n", took.count()));
  }
  flush();
  if (!options.junit.empty()) harness::write_whole(options.junit, harness::junit(comparison.results));
  if (comparison.interrupted) {
    notice(fmt::format("interrupted; {} finished results are in {}", comparison.results.size(), log.path()));
    return kInterrupted;
  }
  if (!options.no_report && !report(options, what.engines)) return kUsage;
  return comparison.as_expected() ? kOk : kCheckFailed;
}

}  // namespace

void add_compare(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("compare",
                         "run scenarios on engines, compare each run with the truth, and measure its cost; "
                         "or compare two\nsets of results: compare OLD NEW");
  auto options = std::make_shared<CompareCommandOptions>();
  command
      ->add_option("names", options->names,
                   "scenarios, variants or sizes (default: all), case files and folders of them "
                   "(docs/cases.md); or two folders of results to compare")
      ->type_name("NAME");
  options->engines.add_to(*command);
  add_size(*command, options->size);
  command->add_option("--dt", options->dt, "step in s, like 0.01 or 1/240 (default 1/60)")->type_name("DT");
  command->add_option("--timeout", options->timeout, "time limit of a run, s (default 300)")->type_name("T");
  command
      ->add_option("--out", options->out,
                   "folder for the results, which are appended to its results.jsonl (default results)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_option("--format", options->format, "console, json (one result per line) or csv")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command->add_option("--junit", options->junit, "also write the results as JUnit XML, for CI")
      ->check(problem_with_path)
      ->type_name("FILE");
  command->add_flag("--no-cost", options->no_cost, "do not measure costs");
  command
      ->add_option("--again", options->again,
                   "repeat the runs of a set of results, each with its own settings, and print which differ "
                   "in any bit; costs are not measured")
      ->type_name("DIR");
  command->add_option("--jobs", options->jobs, "with --again: number of runs at the same time (default 1)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command->add_flag("--no-report", options->no_report,
                    "write only results.jsonl; `plumb report` writes the report");
  command->footer(
      "Examples:\n  plumb compare\n  plumb compare free_fall pendulum_chain[20] --engine plumb,box2d\n"
      "  plumb compare elastic_collision/oblique --dt 1/240 --format json --out /tmp/oblique\n"
      "  plumb compare free_fall --engine plumb --engine-command mine='python3 my_engine.py'\n"
      "  plumb compare my_case.json --junit report.xml\n"
      "  plumb compare results-before results-after\n"
      "  plumb compare --again results-of-a-cluster --out made-here --jobs 2\n"
      "Exit codes: 0 all as expected, 1 a check failed, 2 usage, 130 interrupted (finished results kept).");
  command->callback([&chosen, options] { chosen = [options] { return start_compare(*options); }; });
}

}  // namespace plumb::app
