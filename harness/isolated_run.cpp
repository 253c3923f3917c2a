#include "harness/isolated_run.h"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <utility>

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
      return Status::Crashed;
    case reference::ProcessError::Fault::Diverged:
      return Status::Diverged;
    case reference::ProcessError::Fault::Start:
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
  result.status = Status::Failed;
  result.reason = std::move(why);
  return result;
}

// A run that diverged by its engine's own account, marked like one that the harness caught.
void mark_diverged(Result& result) {
  if (result.status == Status::Diverged)
    result.checks.push_back({"finite", Oracle::Invariant, INFINITY, 1, false, {}});
}

// One line for the nanoseconds, one for the result.
std::string work(const Case& scene_case, const reference::Backend& backend,
                 const reference::StepSettings& settings, Track* track) {
  double nanoseconds = 0;
  Result result;
  try {
    result = run(scene_case, backend, settings, track, &nanoseconds);
  } catch (const reference::ProcessError& error) {
    result = describe(scene_case, backend, settings);
    result.status = status_of(error.fault());
    result.reason = error.what();
    mark_diverged(result);
  }
  return fmt::format("{}\n{}", nanoseconds, to_json(result));
}

}  // namespace

IsolatedRun run_isolated(const Case& scene_case, const reference::Backend& backend,
                         const reference::StepSettings& settings, Track* track, double seconds) {
  IsolatedRun out;
  // Asked here, so that what an engine's program says about itself is asked once and not by every child.
  try {
    out.result = describe(scene_case, backend, settings);
  } catch (const std::exception& error) {
    out.result = failed(scene_case, backend, settings, error.what());
    return out;
  }
  if (out.result.status == Status::Skipped) return out;
  const Outcome outcome = isolate([&] { return work(scene_case, backend, settings, track); }, seconds);
  if (outcome.kind == Outcome::Kind::Interrupted) {
    out.interrupted = true;
  } else if (outcome.kind == Outcome::Kind::Done) {
    const std::size_t line = outcome.text.find('\n');
    out.nanoseconds = std::strtod(outcome.text.substr(0, line).c_str(), nullptr);
    out.result = result_from_json(std::string_view(outcome.text).substr(line + 1));
  } else {
    out.result.status = status_of(outcome.kind);
    out.result.reason = outcome.text;
  }
  return out;
}

}  // namespace plumb::harness
