#include "engine/precise/dynamics/ballistic_motion.h"

#include <cassert>
#include <variant>

namespace plumb::precise {
namespace {

/// Returns the wrench of a law that is constant between switching times for any position of its body.
Wrench<double> constant_wrench(const PointForce& law) { return {law.force, 0}; }
Wrench<double> constant_wrench(const Torque& law) { return {{}, law.torque}; }
template <class Law>
Wrench<double> constant_wrench(const Law&) {
  return {};  // this law is constant only as zero
}

bool is_on(const ForceLaw& law, double time) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (requires { l.start; }) return active_fraction(l.start, l.duration, time, time) > 0;
        return true;
      },
      law);
}

}  // namespace

BallisticMotion::BallisticMotion(const Scene& scene, const ScenePartition& partition)
    : slot_(scene.bodies.size(), -1), body_(partition.ballistic), gravity_(scene.gravity) {
  for (const std::size_t i : body_) {
    const Body& body = scene.bodies[i];
    slot_[i] = static_cast<int>(arcs_.size());
    arcs_.emplace_back();
    const bool dynamic = body.type == BodyType::Dynamic;
    const double inertia = inertia_of(body);
    inverse_mass_.push_back(dynamic ? 1 / body.mass : 0);
    inverse_inertia_.push_back(dynamic && inertia > 0 ? 1 / inertia : 0);
  }
  laws_.resize(arcs_.size());
  for (const ForceLaw& law : scene.forces) {
    const auto body = find_body(scene, ends_of(law)[0]);
    if (!body || slot_[*body] < 0 || scene.bodies[*body].type != BodyType::Dynamic) continue;
    laws_[slot_[*body]].push_back(law);
  }
  for (const std::size_t i : body_) restart(i, 0, initial_state(scene.bodies[i]));
}

Motion BallisticMotion::at(std::size_t body, double time) const {
  assert(contains(body));
  const Arc& arc = arcs_[slot_[body]];
  const double s = time - arc.start;
  Motion now = arc.motion;
  now.state.position += s * (arc.motion.state.velocity + (0.5 * s) * arc.motion.acceleration);
  now.state.velocity += s * arc.motion.acceleration;
  now.state.angle += s * (arc.motion.state.angular_velocity + (0.5 * s) * arc.motion.angular_acceleration);
  now.state.angular_velocity += s * arc.motion.angular_acceleration;
  return now;
}

void BallisticMotion::restart(std::size_t body, double time, const BodyState& state) {
  assert(contains(body));
  Arc& arc = arcs_[slot_[body]];
  arc.start = time;
  arc.motion.state = state;
  update_acceleration(body, time);
}

void BallisticMotion::switch_forces(double time) {
  for (std::size_t slot = 0; slot < arcs_.size(); ++slot) {
    const auto switched_now = [&](const auto& law) {
      if constexpr (requires { law.start; }) return law.start == time || law.start + law.duration == time;
      return false;
    };
    for (const ForceLaw& law : laws_[slot]) {
      if (!std::visit(switched_now, law)) continue;
      restart(body_[slot], time, at(body_[slot], time).state);
      break;
    }
  }
}

/// Sets the acceleration from `time` on. The laws are constant until the next switching time.
void BallisticMotion::update_acceleration(std::size_t body, double time) {
  const int slot = slot_[body];
  Motion& motion = arcs_[slot].motion;
  motion.acceleration = inverse_mass_[slot] > 0 ? gravity_ : Vec2d{};
  motion.angular_acceleration = 0;
  for (const ForceLaw& law : laws_[slot]) {
    if (!is_on(law, time)) continue;
    const Wrench<double> wrench = std::visit([](const auto& l) { return constant_wrench(l); }, law);
    motion.acceleration += inverse_mass_[slot] * wrench.force;
    motion.angular_acceleration += inverse_inertia_[slot] * wrench.torque;
  }
}

}  // namespace plumb::precise
