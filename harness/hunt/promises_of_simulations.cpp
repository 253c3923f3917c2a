#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "harness/hunt/promises.h"

namespace plumb::harness::hunt {
namespace {

constexpr int kMostSteps = 150;

Realtime realtime_of(const Case& one, const Engine& engine) {
  return {.dt = one.dt,
          .substeps = one.substeps,
          .precision = engine.kind == Engine::Kind::World ? Precision::Float : Precision::Double,
          .sleeping = one.sleeping};
}

Accuracy accuracy_of(const Case& one, const Engine& engine) {
  if (engine.kind == Engine::Kind::Precise) return Precise{.max_dt = one.dt};
  return realtime_of(one, engine);
}

int steps_of(const Case& one) { return std::min(one.steps, kMostSteps); }

/// Runs a check that returns an objection, or an empty text. Errors of the run itself are not judged here.
Verdict judged(const Case& one, const Engine& engine, const char* name, const char* right,
               const std::function<std::string()>& check) {
  const std::string what = engine.kind == Engine::Kind::Precise ? checked_apart(check) : checked(check);
  if (what.empty()) return {};
  return Objection{.law = name, .judge = name, .what = what, .right = right, .time = one.steps * one.dt};
}

/// Returns true if states are equal up to the rounding of setting a pose.
bool is_about(const BodyState& a, const BodyState& b) {
  const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-12 * (1 + std::abs(x)); };
  return near(a.position.x, b.position.x) && near(a.position.y, b.position.y) && near(a.angle, b.angle) &&
         a.velocity == b.velocity && a.angular_velocity == b.angular_velocity;
}

std::optional<std::size_t> some_dynamic(const Scene& scene) {
  for (std::size_t i = scene.bodies.size(); i-- > 0;)
    if (scene.bodies[i].type == BodyType::Dynamic) return i;
  return {};
}

}  // namespace

Verdict simulation_restored(const Case& one, const Engine& engine, const Motion&) {
  return judged(one, engine, "simulation_restore",
                "a simulation that is saved and restored continues with the same bits", [&]() -> std::string {
                  const Accuracy accuracy = accuracy_of(one, engine);
                  Simulation first = compile(one.scene, accuracy), other = compile(one.scene, accuracy);
                  other.step(std::min(3, steps_of(one)));
                  for (int k = 0; k < steps_of(one); ++k) {
                    if (k % 20 == 10) other.restore(first.save());
                    first.step();
                    if (k >= 10) other.step();
                    if (k >= 10 && (first.hash() != other.hash() || first.time() != other.time()))
                      return fmt::format("continues with other bits after step {}", k + 1);
                  }
                  return {};
                });
}

Verdict simulation_stages(const Case& one, const Engine& engine, const Motion&) {
  return judged(one, engine, "simulation_stages",
                "unneeded stages, profiles, threads and getters change no bits", [&]() -> std::string {
                  Accuracy accuracy = accuracy_of(one, engine);
                  Simulation plain = compile(one.scene, accuracy);
                  if (auto* realtime = std::get_if<Realtime>(&accuracy))
                    realtime->on_violation = OnViolation::Report, realtime->threads = 2;
                  Simulation full = compile(one.scene, accuracy, {.every_stage = true});
                  full.profile(true);
                  std::vector<BodyState> states(one.scene.bodies.size());
                  for (int k = 0; k < steps_of(one); ++k) {
                    plain.step(), full.step();
                    full.read(states), full.save(), full.statistics();
                    if (engine.kind == Engine::Kind::Precise) full.forces();
                    if (plain.hash() != full.hash())
                      return fmt::format("continues with other bits after step {}", k + 1);
                  }
                  return {};
                });
}

Verdict simulation_stops(const Case& one, const Engine& engine, const Motion&) {
  return judged(
      one, engine, "simulation_stop",
      "`OnViolation::Stop` undoes the step with the violation, and `Report` reports the same violation",
      [&]() -> std::string {
        Realtime accuracy = realtime_of(one, engine);
        accuracy.on_violation = OnViolation::Report;
        Simulation reports = compile(one.scene, accuracy);
        accuracy.on_violation = OnViolation::Stop;
        Simulation stops = compile(one.scene, accuracy);
        for (int k = 0; k < steps_of(one); ++k) {
          reports.step();
          const std::uint64_t before = stops.hash();
          bool stopped = false;
          try {
            stops.step();
          } catch (const Error& error) {
            stopped = true;
            if (error.kind() != Error::Kind::Run) return "stops with an error of another kind";
          }
          if (stopped != (reports.violation() != nullptr))
            return fmt::format("{} in step {}", stopped ? "stops alone" : "reports alone", k + 1);
          if (stopped) return stops.hash() == before ? "" : "stops without undoing the step";
          if (stops.hash() != reports.hash()) return fmt::format("other bits after step {}", k + 1);
        }
        return {};
      });
}

Verdict simulation_overrun(const Case& one, const Engine& engine, const Motion&) {
  const auto body = some_dynamic(one.scene);
  if (!body) return {};
  return judged(one, engine, "simulation_overrun",
                "a step to a number beyond 1e12 is rejected with the body's name and undone",
                [&]() -> std::string {
                  Scene scene = one.scene;
                  const std::string name = scene.bodies[*body].name;
                  const double dt = one.dt, mass = scene.bodies[*body].mass;
                  const int before = std::min(one.steps, 20);
                  // A force that is itself in range but exceeds the speed limit within the step.
                  const double force = std::min(9e11, 4e7 * mass / dt);
                  scene.forces.push_back(PointForce{
                      .body = name, .force = {force, 0}, .start = (before - 0.5) * dt, .duration = 3 * dt});
                  Simulation simulation = compile(scene, realtime_of(one, engine));
                  simulation.step(before - 1);
                  const BodyState sound = simulation.state(*body);
                  BodyState fast = sound;
                  fast.velocity = {9.9999e11, 0};
                  simulation.set_state(*body, fast);
                  bool refused = false;
                  for (int i = 0; i < 2 && !refused; ++i) {
                    std::vector<BodyState> states(scene.bodies.size()), after(scene.bodies.size());
                    simulation.read(states);
                    try {
                      simulation.step();
                    } catch (const Error& error) {
                      refused = true;
                      if (error.kind() != Error::Kind::Run && error.kind() != Error::Kind::Value)
                        return fmt::format("is rejected with an error of another kind: {}", error.what());
                      simulation.read(after);
                      for (std::size_t k = 0; k < states.size(); ++k)
                        if (!is_about(states[k], after[k])) return "is rejected, but not undone";
                    }
                  }
                  const Body& of = scene.bodies[*body];
                  const bool free = one.scene.joints.empty() && !of.lock_x && of.shapes.empty() &&
                                    of.linear_damping == 0 && force * dt / mass > 2e7;
                  if (!refused && free) return "continues with a speed beyond 1e12 m/s";
                  simulation.set_state(*body, sound);
                  std::vector<BodyState> states(scene.bodies.size());
                  simulation.read(states);
                  for (const BodyState& state : states)
                    if (!(std::abs(state.position.x) <= 1e13) || !(std::abs(state.velocity.x) <= 1e13))
                      return "leaves a state that is not finite";
                  return {};
                });
}

}  // namespace plumb::harness::hunt
