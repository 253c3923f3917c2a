#include "app/compare_again.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <unistd.h>

#include "app/exit_codes.h"
#include "app/output.h"
#include "app/progress_line.h"
#include "app/result_log.h"
#include "app/source.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/sweep/again.h"
#include "harness/sweep/difference.h"
#include "harness/sweep/own_limit.h"
#include "harness/sweep/rows.h"

namespace plumb::app {
namespace {

namespace sweep = harness::sweep;
using harness::Result;

// Returns the scenes of `rows`. Throws `Error` (Name) for one that is no scenario: files are to be named.
std::vector<scenarios::Instance> instances_of(const std::vector<Result>& rows) {
  std::vector<scenarios::Instance> out;
  for (const std::vector<Result>& scene : sweep::by_label(rows)) {
    try {
      out.push_back(chosen_instances({scene.front().label}, 0).front());
    } catch (const Error&) {
      throw Error(Error::Kind::Name, "the results", "scene", scene.front().label,
                  "is not a scenario; after --again DIR, name the scene files, case files or folders that "
                  "the results "
                  "come from");
    }
  }
  return out;
}

// Returns the scenes that `names` select, those of scene files with the duration that they have in `rows`.
std::vector<scenarios::Instance> named_instances(const AgainRequest& request, const std::vector<Result>& rows,
                                                 std::vector<std::unique_ptr<scenarios::Scenario>>& files) {
  std::vector<scenarios::Instance> out;
  for (const std::string& name : request.names) {
    if (!is_file(name) || !case_files(name).empty()) {
      for (scenarios::Instance& instance : chosen_instances({name}, request.size))
        out.push_back(std::move(instance));
      continue;
    }
    scenarios::Instance instance = file_instance(name, "", files);
    const auto row = std::ranges::find(rows, instance.label(), &Result::label);
    if (row == rows.end())
      throw Error(Error::Kind::Name, fmt::format("'{}'", request.results), "scene", instance.label(),
                  fmt::format("is in file '{}', but has no results", name));
    out.push_back(file_instance(name, fmt::format("{}", row->duration), files));
  }
  return out;
}

// Keeps the runs that can be made again: of these scenes and engines, not stopped for their time, and not
// left out because the engine's own limit was not found in time.
void keep_possible(std::vector<Result>& rows, const sweep::AgainOptions& options) {
  std::set<std::string, std::less<>> labels, engines;
  for (const scenarios::Instance& instance : options.instances) labels.insert(instance.label());
  for (const reference::Backend* engine : options.engines) engines.emplace(engine->name());
  std::erase_if(rows, [&](const Result& row) {
    return row.status == harness::Status::Timeout || row.reason.starts_with(sweep::kNoLimit) ||
           !labels.contains(row.label) || !engines.contains(row.engine);
  });
}

}  // namespace

int compare_again(const AgainRequest& request) {
  std::error_code code;
  if (std::filesystem::equivalent(request.results, request.out, code))
    throw UsageError(
        fmt::format("--again {0} --out {0}: the repeated runs need another folder", request.results));
  std::vector<Result> rows = sweep::read_all_costs(request.results);
  const std::size_t there = rows.size();
  sweep::AgainOptions options{.jobs = request.jobs, .seconds_a_run = request.seconds_a_run};
  std::vector<std::unique_ptr<scenarios::Scenario>> files;
  options.instances = request.names.empty() ? instances_of(rows) : named_instances(request, rows, files);
  std::vector<std::unique_ptr<reference::Backend>> programs;
  EngineOptions wanted = request.engines;
  if (wanted.names.empty() && wanted.commands.empty()) wanted.names = sweep::engines_of(rows);
  options.engines = chosen_engines(wanted, programs);
  keep_possible(rows, options);

  std::vector<Result> made =
      sweep::holds_rows(request.out) ? sweep::read_all_costs(request.out) : std::vector<Result>{};
  std::set<std::string> known;
  for (const Result& row : made) known.insert(sweep::key_of(row));
  std::vector<Result> missing;
  for (const Result& row : rows)
    if (!known.contains(sweep::key_of(row))) missing.push_back(row);

  ResultLog log(request.out);
  ProgressLine progress;
  harness::catch_interrupts();
  harness::CompareEvents events;
  events.progress = [&](const harness::Progress& now) { progress.show(now); };
  events.finished = [&](std::span<const Result> results) {
    log.append(results);
    made.insert(made.end(), results.begin(), results.end());
  };
  const bool whole = sweep::run_again(missing, options, events);
  progress.clear();
  if (!whole) {
    notice(fmt::format("interrupted; the same command continues from the results in {}", request.out));
    return kInterrupted;
  }
  const std::vector<sweep::Difference> differences = sweep::differences(rows, made);
  if (request.format == "json") {
    print(sweep::difference_json(differences));
  } else if (request.format == "csv") {
    print(sweep::difference_csv(differences));
  } else {
    print(sweep::difference_table(differences, harness::Style::of_file(STDOUT_FILENO)));
    if (there > rows.size())
      print(
          fmt::format("{} runs were not repeated: they exceeded the time limit, had no limit to be compared "
                      "with, or their scenes or engines are not available\n",
                      there - rows.size()));
    print(sweep::all_same(differences) ? "all runs are identical to the bit\n"
                                       : "not all runs are the same\n");
  }
  return sweep::all_same(differences) ? kOk : kCheckFailed;
}

}  // namespace plumb::app
