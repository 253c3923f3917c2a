#include "harness/energy.h"

#include <algorithm>
#include <cmath>

#include "engine/forces/potential.h"

namespace plumb::harness {
namespace {

// Returns 0 for 0/0. If the scale is 0 (nothing moves in the truth), any figure would otherwise be infinite.
double ratio(double value, double scale) { return value == 0 ? 0 : std::abs(value) / scale; }

std::vector<BodyState> initial_states(const Scene& scene) {
  std::vector<BodyState> out;
  for (const Body& body : scene.bodies) out.push_back(initial_state(body));
  return out;
}

}  // namespace

Mechanics mechanics(const Scene& scene, std::span<const BodyState> states) {
  Mechanics sum;
  if (!scene.forces.empty())
    sum.potential += potential_energy(scene, states) - potential_energy(scene, initial_states(scene));
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    const BodyState& state = states[i];
    const double m = body.mass, inertia = inertia_of(body), w = state.angular_velocity;
    sum.kinetic += 0.5 * m * length_squared(state.velocity) + 0.5 * inertia * w * w;
    sum.potential -= m * body.gravity_scale * dot(scene.gravity, state.position - body.position);
    sum.momentum += m * state.velocity;
    sum.sum_of_momenta += m * std::hypot(state.velocity.x, state.velocity.y);
    const double orbital = m * cross(state.position, state.velocity), spin = inertia * w;
    sum.angular_momentum += orbital + spin;
    sum.sum_of_angular_momenta += std::abs(orbital) + std::abs(spin);
  }
  return sum;
}

ConservationScale conservation_scale(const Scene& scene, const TruthTable& truth) {
  ConservationScale scale;
  double highest = 0, lowest = 0;
  const auto include = [&](const Mechanics& now) {
    highest = std::max(highest, now.kinetic + now.potential);
    lowest = std::min(lowest, now.potential);
    scale.momentum = std::max(scale.momentum, now.sum_of_momenta);
    scale.angular_momentum = std::max(scale.angular_momentum, now.sum_of_angular_momenta);
  };
  double mass = 0;
  for (const Body& body : scene.bodies)
    if (body.type == BodyType::Dynamic) mass += body.mass;
  include(mechanics(scene, initial_states(scene)));
  if (truth.known())
    for (int k = 0; k <= truth.steps(); ++k) include(mechanics(scene, truth.at(k)));
  const double length = truth.scale().extent, time = truth.scale().duration;
  scale.energy = highest - lowest;
  if (!truth.known() || scale.energy == 0)
    scale.energy = std::max(scale.energy, mass * length * length / (time * time));
  if (!truth.known() || scale.momentum == 0) scale.momentum = std::max(scale.momentum, mass * length / time);
  if (!truth.known() || scale.angular_momentum == 0)
    scale.angular_momentum = std::max(scale.angular_momentum, mass * length * length / time);
  return scale;
}

DriftMeter::DriftMeter(const scenarios::Problem& problem, const ConservationScale& scale)
    : problem_(problem), scale_(scale), start_(mechanics(problem.scene, initial_states(problem.scene))) {}

Drift DriftMeter::drift(std::span<const BodyState> states) const {
  const scenarios::Conserved& kept = problem_.conserved;
  const Mechanics now = mechanics(problem_.scene, states);
  Drift drift;
  if (kept.energy) {
    const double change = now.kinetic + now.potential - start_.kinetic - start_.potential;
    drift.energy = ratio(change, scale_.energy);
  }
  if (kept.momentum_x || kept.momentum_y) {
    const Vec2d change = now.momentum - start_.momentum;
    drift.momentum =
        ratio(std::hypot(kept.momentum_x ? change.x : 0, kept.momentum_y ? change.y : 0), scale_.momentum);
  }
  if (kept.angular_momentum)
    drift.angular_momentum = ratio(now.angular_momentum - start_.angular_momentum, scale_.angular_momentum);
  return drift;
}

}  // namespace plumb::harness
