#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "harness/interrupt.h"
#include "harness/reality/ellipse.h"
#include "harness/reality/parallel.h"

// Engines have no ellipses. An impact depends on the contact point alone. So a disc at the measured contact,
// on a body of the fitted inertia, has the same lever arms and the same contact velocities.
namespace plumb::harness::reality {
namespace {

constexpr double kRadius = 0.01;  // m, of the disc
/// Frames from the start to the time at which velocities are read: the impact is within the second frame.
constexpr int kFrames = 4;
/// Tolerance of the exact impacts.
constexpr double kExact = 1e-9;

/// Returns the base-2 radical inverse, which spreads times of impact evenly over a step for any number of
/// impacts.
double radical_inverse(std::size_t index) {
  double out = 0;
  for (double place = 0.5; index > 0; index /= 2, place /= 2) out += place * static_cast<double>(index % 2);
  return out;
}

/// Builds a scene of free motion, without gravity, up to an impact in the second frame.
Scene scene_of(const MeasuredImpact& impact, std::span<const double> values, std::size_t index) {
  const double before = (1 + radical_inverse(index)) / kFramesPerSecond;
  Scene scene{.name = "impact"};
  scene.gravity = {};
  Body floor{.name = "floor", .type = BodyType::Static, .position = {0, -0.5}};
  floor.shapes = {{.geometry = Box{20, 1}, .friction = values[1], .restitution = 0}};
  Body ellipse{.name = "ellipse", .velocity = impact.velocity, .angular_velocity = impact.angular_velocity};
  ellipse.position = Vec2d{0, impact.lever_tangent} - before * impact.velocity;
  ellipse.angle = -before * impact.angular_velocity;
  ellipse.inertia = values[0];  // of 1 kg
  ellipse.shapes = {{.geometry = Circle{kRadius}, .friction = values[1], .restitution = values[2]}};
  ellipse.shapes[0].position = {impact.lever_normal, kRadius - impact.lever_tangent};
  scene.bodies = {floor, ellipse};
  return scene;
}

/// Velocities after the impact; empty if the run did not finish.
using Result = std::optional<BodyState>;

Result exact(const Scene& scene) {
  try {
    Simulation simulation =
        compile(scene, plumb::Precise{.tolerance = kExact, .max_dt = 1 / kFramesPerSecond});
    simulation.step(kFrames);
    return simulation.state(1);
  } catch (const Error&) {
    return {};
  }
}

Result run(const reference::Backend& engine, const Scene& scene, double dt) {
  try {
    const auto simulator = engine.create(scene, {.dt = dt});
    simulator->advance(static_cast<int>(std::lround(kFrames / (dt * kFramesPerSecond))));
    std::vector<BodyState> states(scene.bodies.size());
    simulator->read(states);
    const BodyState& state = states[1];
    if (std::isfinite(state.velocity.x + state.velocity.y + state.angular_velocity)) return state;
  } catch (const Error&) {  // counted as failed
  }
  return {};
}

double size_of(Vec2d velocity, double turning) {
  return std::sqrt(dot(velocity, velocity) + kUniformEllipse * turning * turning);
}

struct Pairs {
  std::vector<double> numerical, of_the_law, measured;
};

Quantiles quantiles(std::span<const double> errors, std::uint64_t seed) {
  return {estimate(errors, 0.5, seed), estimate(errors, 0.9, seed)};
}

Pairs pairs_of(std::span<const MeasuredImpact* const> test, std::span<const Result> exacts,
               std::span<const Result> found) {
  Pairs out;
  for (std::size_t i = 0; i < test.size(); ++i) {
    if (!exacts[i] || !found[i]) continue;
    const MeasuredImpact& seen = *test[i];
    const double size = size_of(seen.velocity_after, seen.angular_velocity_after);
    const auto apart = [&](const BodyState& a, Vec2d velocity, double turning) {
      return size_of(a.velocity - velocity, a.angular_velocity - turning) / size;
    };
    out.numerical.push_back(apart(*found[i], exacts[i]->velocity, exacts[i]->angular_velocity));
    out.of_the_law.push_back(apart(*exacts[i], seen.velocity_after, seen.angular_velocity_after));
    out.measured.push_back(apart(*found[i], seen.velocity_after, seen.angular_velocity_after));
  }
  return out;
}

}  // namespace

std::vector<EllipseEngine> examine_ellipse_engines(std::span<const MeasuredImpact* const> test,
                                                   const EllipseFinding& law,
                                                   std::span<const reference::Backend* const> engines,
                                                   std::uint64_t seed) {
  std::vector<EllipseEngine> out;
  if (test.empty()) return out;
  std::vector<Scene> scenes;
  for (std::size_t i = 0; i < test.size(); ++i) scenes.push_back(scene_of(*test[i], law.values, i));
  const std::vector<Result> exacts =
      in_parallel(test.size(), [&](std::size_t i) { return exact(scenes[i]); });
  for (const reference::Backend* engine : engines) {
    for (const double dt : kSteps) {
      if (interrupted()) return out;
      EllipseEngine one;
      one.engine = engine->name();
      one.law = law.name;
      one.dt = dt;
      const reference::Identity identity = engine->identity();
      one.why_not = identity.available ? engine->unsupported(scenes.front(), {.dt = dt}) : identity.reason;
      if (one.why_not.empty()) {
        std::vector<Result> found;
        for (const Scene& scene : scenes) found.push_back(run(*engine, scene, dt));
        for (const Result& result : found) one.failed += result ? 0 : 1;
        const Pairs pairs = pairs_of(test, exacts, found);
        one.numerical = quantiles(pairs.numerical, seed);
        one.of_the_law = quantiles(pairs.of_the_law, seed);
        one.measured = quantiles(pairs.measured, seed);
        one.share = {ratio(pairs.numerical, pairs.of_the_law, 0.5, seed),
                     ratio(pairs.numerical, pairs.of_the_law, 0.9, seed)};
        if (engine->method({.dt = dt}).scheme == reference::Scheme::Adaptive) one.dt = 0;
      }
      const bool adaptive = one.dt == 0;
      out.push_back(std::move(one));
      if (adaptive) break;  // its steps do not depend on dt
    }
  }
  return out;
}

}  // namespace plumb::harness::reality
