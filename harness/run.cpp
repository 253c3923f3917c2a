#include "harness/run.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "engine/scene/validate.h"
#include "harness/observer.h"

namespace plumb::harness {

Case::Case(const scenarios::Instance& which, double sample)
    : instance(which), label(which.label()), problem(which.build()), truth(problem, sample) {
  validate(problem.scene);
}

Result describe(const Case& scene_case, const reference::Backend& backend,
                const reference::StepSettings& settings) {
  Result result;
  result.scenario = scene_case.instance.scenario->name;
  result.variant = scene_case.instance.variant;
  result.size = scene_case.instance.size;
  result.label = scene_case.label;
  result.engine = backend.name();
  const reference::Identity identity = backend.identity();
  result.engine_version = identity.version;
  result.precision = identity.precision;
  result.dt = settings.dt;
  result.sample = scene_case.truth.dt();
  result.asked = settings;
  result.duration = scene_case.problem.duration;
  result.truth = scene_case.problem.truth.source;
  const std::vector<std::string>& must_pass = scene_case.problem.must_pass;
  if (identity.guest) {
    result.excused = identity.limits.empty() ? std::string(kGuest) : identity.limits;
  } else if (!must_pass.empty() &&
             std::find(must_pass.begin(), must_pass.end(), result.engine) == must_pass.end()) {
    result.excused = "the case does not require this engine to pass";
  }
  result.foreign_cost = identity.foreign_cost;
  if (!identity.available) {
    result.status = Status::Skipped;
    result.reason = fmt::format("not installed: {}", identity.reason);
    return result;
  }
  const Scene& scene = scene_case.problem.scene;
  const std::string unsupported = backend.unsupported(scene, settings);
  if (!unsupported.empty()) {
    result.status = Status::Skipped;
    result.reason = unsupported;
    return result;
  }
  result.settings = backend.effective_settings(scene, settings);
  return result;
}

namespace {

// Returns the number of steps of dt from one sample of the truth to the next.
int steps_a_sample(double sample, double dt) {
  const double steps = sample / dt, whole = std::round(steps);
  if (whole < 1 || std::abs(steps - whole) > 1e-6 * whole) {
    throw Error(Error::Kind::Value, "the run", "dt", fmt::format("{}", dt),
                fmt::format("must divide the interval of {} s between samples", sample));
  }
  return static_cast<int>(whole);
}

}  // namespace

Result run(const Case& scene_case, const reference::Backend& backend, const reference::StepSettings& settings,
           Track* track, double* nanoseconds) {
  Result result = describe(scene_case, backend, settings);
  if (result.status == Status::Skipped) return result;
  const Scene& scene = scene_case.problem.scene;
  const int every = steps_a_sample(scene_case.truth.dt(), settings.dt);
  Observer observer(scene_case, backend.method(settings), settings, track);
  const auto simulator = backend.create(scene, settings);
  std::vector<BodyState> start(scene.bodies.size());
  simulator->read(start);
  observer.add(0, start);
  int sample = 0;
  const auto sink = [&](double, std::span<const BodyState> states) { observer.add(++sample, states); };
  const double spent = simulator->record(scene_case.truth.steps(), every, scene.bodies.size(), sink);
  if (nanoseconds != nullptr) *nanoseconds = spent;
  if (sample != scene_case.truth.steps()) {
    throw Error(Error::Kind::Run, fmt::format("engine '{}'", backend.name()), "samples",
                fmt::format("{}", sample),
                fmt::format("were returned instead of {}", scene_case.truth.steps()));
  }
  observer.finish(result);
  return result;
}

}  // namespace plumb::harness
