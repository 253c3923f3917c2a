#include "harness/explain.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "harness/truth_table.h"

namespace plumb::harness {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSeconds = 0.5;  // wall time per measurement

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Steps the world at most `steps` times within the time limit; returns the number of steps and the time.
std::pair<int, double> advance(Simulation& world, int steps) {
  const Clock::time_point start = Clock::now();
  int done = 0;
  while (done < steps && since(start) < kSeconds) {
    world.step();
    ++done;
  }
  return {done, since(start) * 1e9};
}

double share_of(const Stage& stage, double total) { return total > 0 ? stage.nanoseconds / total : 0; }

}  // namespace

Accuracy accuracy_of(const reference::Backend& backend, const reference::StepSettings& settings) {
  if (!backend.name().starts_with("plumb")) {
    throw Error(Error::Kind::Unsupported, fmt::format("engine '{}'", backend.name()), "", "",
                "cannot be explained: only 'plumb', 'plumb-float' and 'plumb-precise' have a plan");
  }
  const reference::Method method = backend.method(settings);
  if (method.scheme == reference::Scheme::Adaptive) {
    Precise precise{.max_dt = settings.dt};
    precise.tolerance = settings.tolerance.value_or(precise.tolerance);
    return precise;
  }
  Realtime realtime{.dt = settings.dt};
  realtime.substeps = settings.substeps.value_or(realtime.substeps);
  if (backend.identity().precision == name_of(Precision::Float)) realtime.precision = Precision::Float;
  for (const Integrator integrator :
       {Integrator::VelocityVerlet, Integrator::SemiImplicitEuler, Integrator::ExplicitEuler}) {
    const auto chosen = settings.options.find("integrator");
    if (chosen != settings.options.end() && chosen->second == name_of(integrator))
      realtime.integrator = integrator;
  }
  if (const auto solver = settings.options.find("solver"); solver != settings.options.end())
    realtime.solver = solver_of(solver->second).value_or(realtime.solver);
  if (const auto chosen = settings.options.find("continuous"); chosen != settings.options.end())
    realtime.continuous = chosen->second == "on";
  if (const auto chosen = settings.options.find("sleep"); chosen != settings.options.end())
    realtime.sleeping = chosen->second == "on";
  if (const auto iterations = settings.options.find("iterations"); iterations != settings.options.end())
    realtime.iterations = std::atoi(iterations->second.c_str());
  return realtime;
}

Explanation explain(const Scene& scene, const reference::Backend& backend,
                    const reference::StepSettings& settings, double duration) {
  const Accuracy accuracy = accuracy_of(backend, settings);
  if (const std::string reason = unsupported(scene, accuracy); !reason.empty())
    throw Error(Error::Kind::Unsupported, fmt::format("engine '{}'", backend.name()), "", "", reason);
  Explanation out;
  out.scene = scene.name;
  out.engine = backend.name();
  out.settings = backend.effective_settings(scene, settings);
  const int steps = step_count(duration, settings.dt);

  Simulation plain = compile(scene, accuracy);
  const auto [plain_steps, nanoseconds] = advance(plain, steps);
  out.ns_per_step = nanoseconds / plain_steps;

  Simulation world = compile(scene, accuracy);
  world.profile(true);
  out.steps = advance(world, plain_steps).first;
  out.plan = world.plan();
  for (const Stage& stage : out.plan.stages) out.nanoseconds += stage.nanoseconds;
  return out;
}

std::string to_console(const Explanation& explanation, const Style& style) {
  using Ink = Style::Ink;
  std::string settings;
  for (const auto& [name, value] : explanation.settings)
    settings += fmt::format("{}{} {}", settings.empty() ? "" : ", ", name, value);
  std::string out =
      style.paint(explanation.scene, Ink::Bold) +
      style.paint(fmt::format("  on {} ({})", explanation.engine, explanation.plan.driver), Ink::Dim) + "\n";
  if (!settings.empty()) out += style.paint(wrap("settings: " + settings, style.width, 10), Ink::Dim) + "\n";
  out +=
      fmt::format("{} a step over {} steps\n\n", duration_text(explanation.ns_per_step), explanation.steps);
  if (!explanation.plan.substeps_why.empty())
    out += wrap(fmt::format("substeps: {}, {}", explanation.plan.substeps, explanation.plan.substeps_why),
                style.width, 10) +
           "\n\n";
  int width = 5;
  for (const Stage& stage : explanation.plan.stages)
    width = std::max(width, static_cast<int>(stage.name.size()));
  out += style.paint(fmt::format("{:<{}}   share  why", "stage", width), Ink::Dim) + "\n";
  for (const Stage& stage : explanation.plan.stages) {
    const std::string share =
        stage.active ? fmt::format("{:.1f} %", 100 * share_of(stage, explanation.nanoseconds)) : "off";
    const std::string line = fmt::format("{:<{}} {:>7}  ", stage.name, width, share) + stage.why;
    out += style.paint(wrap(line, style.width, width + 10), stage.active ? Ink::Plain : Ink::Dim) + "\n";
  }
  return out;
}

std::string to_json(const Explanation& explanation) {
  using Json = nlohmann::ordered_json;
  Json stages = Json::array(), settings = Json::object();
  for (const auto& [name, value] : explanation.settings) settings[name] = value;
  for (const Stage& stage : explanation.plan.stages) {
    stages.push_back({{"name", stage.name},
                      {"active", stage.active},
                      {"why", stage.why},
                      {"share", share_of(stage, explanation.nanoseconds)},
                      {"ns_per_step", stage.nanoseconds / std::max(1, explanation.steps)}});
  }
  const Json json{
      {"scene", explanation.scene},
      {"engine", explanation.engine},
      {"driver", explanation.plan.driver},
      {"settings", settings},
      {"substeps", {{"count", explanation.plan.substeps}, {"why", explanation.plan.substeps_why}}},
      {"steps", explanation.steps},
      {"ns_per_step", explanation.ns_per_step},
      {"stages", stages}};
  return json.dump(2);
}

}  // namespace plumb::harness
