#include "harness/isolated_run.h"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "reference/process_backend.h"

namespace plumb::harness {
namespace {

Status status_of(reference::ProcessError::Fault fault) {
  switch (fault) {
    case reference::ProcessError::Fault::Timeout:
      return Status::Timeout;
    case reference::ProcessError::Fault::Crash:
    case reference::ProcessError::Fault::Killed:
      return Status::Crashed;
    case reference::ProcessError::Fault::Diverged:
      return Status::Diverged;
    case reference::ProcessError::Fault::Start:
    case reference::ProcessError::Fault::Time:
    case reference::ProcessError::Fault::Protocol:
      break;
  }
  return Status::Failed;
}

Status status_of(Outcome::Kind kind) {
  switch (kind) {
    case Outcome::Kind::Crashed:
      return Status::Crashed;
    case Outcome::Kind::Timeout:
      return Status::Timeout;
    case Outcome::Kind::Done:
    case Outcome::Kind::Failed:
    case Outcome::Kind::Interrupted:
      break;
  }
  return Status::Failed;
}

Result failed(const Case& scene_case, const reference::Backend& backend,
              const reference::StepSettings& settings, std::string why) {
  Result result;
  result.scenario = scene_case.instance.scenario->name;
  result.variant = scene_case.instance.variant;
  result.size = scene_case.instance.size;
  result.label = scene_case.label;
  result.engine = backend.name();
  result.dt = settings.dt;
  result.asked = settings;
  result.status = Status::Failed;
  result.reason = std::move(why);
  return result;
}

// Marks a run that its engine reported as diverged like one that the harness detected.
void mark_diverged(Result& result) {
  if (result.status == Status::Diverged)
    result.checks.push_back({"finite", Oracle::Invariant, INFINITY, 1, false, {}});
}

std::string as_text(const CostSample& sample) {
  return fmt::format("{} {} {}", sample.ns_per_step, sample.setup_ns, sample.steps);
}

CostSample sample_from(const std::string& text) {
  char* end = nullptr;
  CostSample sample;
  sample.ns_per_step = std::strtod(text.c_str(), &end);
  sample.setup_ns = std::strtod(end, &end);
  sample.steps = static_cast<int>(std::strtol(end, nullptr, 10));
  return sample;
}

// Returns a line for the nanoseconds, one for the rough cost, and one for the result.
std::string work(const RunRequest& request) {
  double nanoseconds = 0;
  Result result;
  std::string rough;
  try {
    result = run(*request.scene_case, *request.backend, request.settings, request.track, &nanoseconds);
    if (request.rough && result.status == Status::Ok) {
      const int steps = step_count(request.scene_case->problem.duration, request.settings.dt);
      rough = as_text(measure_cost(*request.scene_case, *request.backend, request.settings,
                                   nanoseconds / steps, *request.rough));
    }
  } catch (const reference::ProcessError& error) {
    if (error.fault() == reference::ProcessError::Fault::Killed) throw;
    result = describe(*request.scene_case, *request.backend, request.settings);
    result.status = status_of(error.fault());
    result.reason = error.what();
    mark_diverged(result);
  }
  return fmt::format("{}\n{}\n{}", nanoseconds, rough, to_json(result));
}

IsolatedRun described(const RunRequest& request) {
  IsolatedRun out;
  // Described here, so that an engine's program is queried once, not by every child.
  try {
    out.result = describe(*request.scene_case, *request.backend, request.settings);
  } catch (const std::exception& error) {
    out.result = failed(*request.scene_case, *request.backend, request.settings, error.what());
  }
  return out;
}

void take(const Outcome& outcome, IsolatedRun& out) {
  if (outcome.kind == Outcome::Kind::Interrupted) {
    out.interrupted = true;
  } else if (outcome.kind == Outcome::Kind::Done) {
    const std::size_t line = outcome.text.find('\n'), second = outcome.text.find('\n', line + 1);
    out.nanoseconds = std::strtod(outcome.text.substr(0, line).c_str(), nullptr);
    if (second > line + 1) out.rough = sample_from(outcome.text.substr(line + 1, second - line - 1));
    out.result = result_from_json(std::string_view(outcome.text).substr(second + 1));
  } else {
    out.result.status = status_of(outcome.kind);
    out.result.reason = outcome.text;
  }
}

}  // namespace

void run_isolated_all(std::span<const RunRequest> requests, int jobs, double seconds,
                      const std::function<void(std::size_t, IsolatedRun)>& done) {
  std::vector<IsolatedRun> runs;
  std::vector<std::size_t> to_run;
  for (const RunRequest& request : requests) {
    runs.push_back(described(request));
    const Status status = runs.back().result.status;
    if (status == Status::Skipped || status == Status::Failed) {
      done(runs.size() - 1, runs.back());
    } else {
      to_run.push_back(runs.size() - 1);
    }
  }
  isolate_all(
      to_run.size(), jobs, seconds, [&](std::size_t i) { return work(requests[to_run[i]]); },
      [&](std::size_t i, const Outcome& outcome) {
        take(outcome, runs[to_run[i]]);
        done(to_run[i], std::move(runs[to_run[i]]));
      });
}

IsolatedRun run_isolated(const Case& scene_case, const reference::Backend& backend,
                         const reference::StepSettings& settings, Track* track, double seconds) {
  IsolatedRun out;
  const RunRequest request{&scene_case, &backend, settings, track, {}};
  run_isolated_all({&request, 1}, 1, seconds, [&](std::size_t, IsolatedRun run) { out = std::move(run); });
  return out;
}

IsolatedCost measure_cost_isolated(const Case& scene_case, const reference::Backend& backend,
                                   const reference::StepSettings& settings, double expected_ns_per_step,
                                   const CostBudget& budget, double seconds) {
  const Outcome outcome = isolate(
      [&] { return as_text(measure_cost(scene_case, backend, settings, expected_ns_per_step, budget)); },
      seconds);
  if (outcome.kind == Outcome::Kind::Interrupted) return {.sample = {}, .interrupted = true};
  if (outcome.kind != Outcome::Kind::Done) return {.problem = outcome.text};
  return {.sample = sample_from(outcome.text)};
}

}  // namespace plumb::harness
