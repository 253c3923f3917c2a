// Calls on a body: its motion, mass, type, sleep and shapes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/math/trigonometry.h"
#include "engine/world/recorder.h"
#include "harness/hunt/caller.h"

namespace plumb::harness::hunt {

template <class Real, class Target>
auto Caller<Real, Target>::on_body() -> Make {
  static constexpr Make kCalls[] = {
      &Caller::set_velocity, &Caller::set_spin,  &Caller::set_position, &Caller::impulse,
      &Caller::turn,         &Caller::force,     &Caller::weightless,   &Caller::damping,
      &Caller::locks,        &Caller::mass,      &Caller::densities,    &Caller::type,
      &Caller::sleep,        &Caller::may_sleep, &Caller::enable,       &Caller::continuous,
      &Caller::towards,      &Caller::name,      &Caller::destroy,      &Caller::add_shape};
  return pick(kCalls);
}

template <class Real, class Target>
std::string Caller<Real, Target>::set_velocity() {
  const Vec2d wanted = vector(3 * size());
  const std::vector<BodyHash> single = single_hashes();
  const Vec2d before = world_.velocity(body_);
  const std::uint64_t hash = world_.hash();
  target_.set_velocity(body_, wanted);
  const BodyLocks locks = world_.locks(body_);
  if (locks.x || locks.y || world_.type(body_) == BodyType::Static) return {};
  if (!near(world_.velocity(body_), wanted)) return answers("set_velocity", false);
  if (!near(before, wanted) && world_.hash() == hash) return "the hash does not change with the velocity";
  if (!near(before, wanted))
    if (std::string wrong = hash_is_wrong("set_velocity", single); !wrong.empty()) return wrong;
  return near(before, wanted) ? std::string() : not_woken("set_velocity");
}

template <class Real, class Target>
std::string Caller<Real, Target>::set_spin() {
  const double wanted = number(5), before = world_.angular_velocity(body_);
  const std::vector<BodyHash> single = single_hashes();
  const std::uint64_t hash = world_.hash();
  target_.set_angular_velocity(body_, wanted);
  if (world_.locks(body_).rotation || world_.type(body_) == BodyType::Static) return {};
  if (!near(world_.angular_velocity(body_), wanted)) return answers("set_angular_velocity", false);
  if (!near(before, wanted) && world_.hash() == hash)
    return "the hash does not change with the angular velocity";
  if (!near(before, wanted))
    if (std::string wrong = hash_is_wrong("set_angular_velocity", single); !wrong.empty()) return wrong;
  return near(before, wanted) ? std::string() : not_woken("set_angular_velocity");
}

template <class Real, class Target>
std::string Caller<Real, Target>::set_position() {
  const double angle = random_.chance(0.5) ? world_.angle(body_) : random_.within(-4, 4);
  const Vec2d to = world_.position(body_) + vector(0.5 * size());
  const Vec2d velocity = world_.velocity(body_);
  const double before = world_.angle(body_);
  std::vector<double> readings;
  for (const JointId joint : world_.joints(body_)) readings.push_back(world_.read(joint).angle);
  target_.set_position(body_, to, angle);
  if (!near(world_.position(body_), to, size()) || !near(world_.angle(body_), angle, 1))
    return answers("set_position", false);
  if (dynamic() && !near(world_.velocity(body_), velocity, size() * std::abs(world_.angular_velocity(body_))))
    return fmt::format("set_position changes the velocity from {:.6g}, {:.6g} to {:.6g}, {:.6g} m/s",
                       velocity.x, velocity.y, world_.velocity(body_).x, world_.velocity(body_).y);
  if (std::string wrong = turned_by(angle - before, readings); !wrong.empty()) return wrong;
  if (std::string wrong = sleepers_inside(); !wrong.empty()) return wrong;
  return not_woken("set_position");
}

template <class Real, class Target>
std::string Caller<Real, Target>::turned_by(double turn, const std::vector<double>& before) const {
  const std::vector<JointId> joints = world_.joints(body_);
  for (std::size_t i = 0; i < joints.size() && i < before.size(); ++i) {
    const auto [a, b] = world_.bodies(joints[i]);
    if (!std::holds_alternative<RevoluteDefinition>(world_.kind(joints[i])) || a == b) continue;
    const double right = before[i] + (b == body_ ? turn : -turn), now = world_.read(joints[i]).angle;
    // Rotations of half a circle and more may be counted in either direction, and so may the angle of a joint
    // that has not been stepped since it was created.
    const bool either = std::abs(turn) > 3 || (std::abs(before[i]) < 3.15 && std::abs(right) > 3.1);
    if (!either && std::abs(now - right) > 1e-3 * (1 + 1e-3 * std::abs(right)))
      return fmt::format("a hinge of '{}' reads {:.6g} rad after a rotation, not {:.6g}", world_.name(body_),
                         now, right);
  }
  return {};
}

template <class Real, class Target>
std::string Caller<Real, Target>::impulse() {
  const MaterialPoints before = motion();
  const Vec2d velocity = world_.velocity(body_), centre = world_.centre(body_);
  const double mass = world_.mass(body_), inertia = world_.inertia(body_);
  const Vec2d change = vector(size()), arm = random_.chance(0.3) ? Vec2d{} : vector(size());
  target_.apply_impulse(body_, mass * change, centre + arm);
  const BodyLocks locks = world_.locks(body_);
  if (!simulated() || locks.x || locks.y || locks.rotation || !(inertia > 0)) return {};
  const double turn = cross(arm, mass * change) / inertia;
  const double scale = length(velocity) + length(change);
  if (!near(world_.velocity(body_), velocity + change, scale) ||
      !near(world_.angular_velocity(body_), before.spin + turn,
            std::abs(turn) + std::abs(before.spin) +
                mass / inertia * length(change) * (length(arm) + 1e-1 * kRounding * length(centre))))
    return "an impulse does not change velocities by J/m and r x J/I";
  return change != Vec2d{} ? not_woken("apply_impulse") : std::string();
}

template <class Real, class Target>
std::string Caller<Real, Target>::turn() {
  const double inertia = world_.inertia(body_), before = world_.angular_velocity(body_), by = number(3);
  target_.apply_angular_impulse(body_, inertia * by);
  if (!simulated() || world_.locks(body_).rotation || !(inertia > 0)) return {};
  if (!near(world_.angular_velocity(body_), before + by, std::abs(before) + std::abs(by)))
    return "an angular impulse does not change the angular velocity by L/I";
  return by != 0 ? not_woken("apply_angular_impulse") : std::string();
}

template <class Real, class Target>
std::string Caller<Real, Target>::force() {
  const Vec2d push = world_.mass(body_) * vector(20);
  const double twist = world_.inertia(body_) * number(20);
  switch (random_.whole(0, 2)) {
    case 0:
      target_.apply_force(body_, push);
      break;
    case 1:
      target_.apply_force(body_, push, world_.centre(body_) + vector(size()));
      break;
    default:
      target_.apply_torque(body_, twist);
      return twist != 0 ? not_woken("apply_torque") : std::string();
  }
  return push != Vec2d{} ? not_woken("apply_force") : std::string();
}

template <class Real, class Target>
std::string Caller<Real, Target>::weightless() {
  const double wanted = random_.pick({1.0, 1.0, 0.0, 0.5, 2.0, -1.0}), before = world_.gravity_scale(body_);
  target_.set_gravity_scale(body_, wanted);
  if (!near(world_.gravity_scale(body_), wanted)) return answers("set_gravity_scale", false);
  return before != wanted ? not_woken("set_gravity_scale") : std::string();
}

template <class Real, class Target>
std::string Caller<Real, Target>::damping() {
  const double linear = random_.pick({0.0, 0.0, 0.1, 1.0}), angular = random_.pick({0.0, 0.0, 0.3});
  const bool other = linear != 0 && world_.linear_damping(body_) == 0;
  target_.set_damping(body_, linear, angular);
  if (!near(world_.linear_damping(body_), linear) || !near(world_.angular_damping(body_), angular))
    return answers("set_damping", false);
  return other ? not_woken("set_damping") : std::string();
}

template <class Real, class Target>
std::string Caller<Real, Target>::locks() {
  const BodyLocks wanted{random_.chance(0.2), random_.chance(0.2), random_.chance(0.2)};
  const BodyLocks before = world_.locks(body_);
  target_.set_locks(body_, wanted.x, wanted.y, wanted.rotation);
  if (!(world_.locks(body_) == wanted)) return answers("set_locks", false);
  return before != wanted ? not_woken("set_locks") : std::string();
}

template <class Real, class Target>
std::string Caller<Real, Target>::mass() {
  const MaterialPoints before = motion();
  const double mass = random_.within(0.5, 2) * std::max(world_.mass(body_), 1e-6);
  const MassProperties wanted{mass, random_.chance(0.3) ? Vec2d{} : vector(0.5 * size()),
                              mass * size() * size() * random_.within(0.1, 1)};
  target_.set_mass(body_, wanted);
  if (!dynamic()) return {};
  if (!near(world_.mass(body_), wanted.mass) ||
      (!world_.locks(body_).rotation && !near(world_.inertia(body_), wanted.inertia)) ||
      !near(world_.centre(body_), world_.world_point(body_, wanted.centre), size()))
    return answers("set_mass", false);
  return mass_is_wrong("set_mass", before);
}

template <class Real, class Target>
std::string Caller<Real, Target>::densities() {
  const MaterialPoints before = motion();
  target_.use_densities(body_);
  if (std::string wrong = mass_by_shapes(); !wrong.empty()) return wrong;
  return mass_is_wrong("use_densities", before);
}

template <class Real, class Target>
std::string Caller<Real, Target>::type() {
  const BodyType wanted = random_.pick(
      {BodyType::Dynamic, BodyType::Dynamic, BodyType::Dynamic, BodyType::Kinematic, BodyType::Static});
  const BodyType before = world_.type(body_);
  target_.set_type(body_, wanted);
  if (world_.type(body_) != wanted) return answers("set_type", false);
  return before != wanted ? not_woken("set_type") : std::string();
}

template <class Real, class Target>
std::string Caller<Real, Target>::sleep() {
  const bool wanted = random_.chance(0.3);
  target_.set_awake(body_, wanted);
  return wanted ? not_woken("set_awake") : std::string();
}

template <class Real, class Target>
std::string Caller<Real, Target>::may_sleep() {
  const bool wanted = random_.chance(0.7);
  target_.set_may_sleep(body_, wanted);
  if (world_.may_sleep(body_) != wanted) return answers("set_may_sleep", false);
  return wanted ? std::string() : not_woken("set_may_sleep");
}

template <class Real, class Target>
std::string Caller<Real, Target>::enable() {
  const bool wanted = random_.chance(0.8);
  target_.set_enabled(body_, wanted);
  return answers("set_enabled", world_.enabled(body_) == wanted || world_.quarantined(body_));
}

template <class Real, class Target>
std::string Caller<Real, Target>::continuous() {
  const bool wanted = random_.chance(0.7);
  target_.set_continuous(body_, wanted);
  return answers("set_continuous", world_.continuous(body_) == wanted);
}

template <class Real, class Target>
std::string Caller<Real, Target>::towards() {
  const Vec2d to = world_.position(body_) + vector(0.3 * size());
  const double angle = world_.angle(body_) + number(0.5), dt = random_.pick({1.0 / 60, 0.01, 0.1});
  const Vec2d local = world_.local_point(body_, world_.centre(body_));
  target_.move_towards(body_, to, angle, dt);
  const BodyLocks locks = world_.locks(body_);
  if (world_.type(body_) == BodyType::Static || locks.x || locks.y || locks.rotation) return {};
  const Rotation<double> turn = rotation_of(angle);
  const Vec2d arrives = world_.centre(body_) + dt * world_.velocity(body_), wanted = to + turn * local;
  if (length(arrives - wanted) > 10 * kRounding * (size() + length(local)) + kRounding * 0.01 * length(to) ||
      !near(world_.angle(body_) + dt * world_.angular_velocity(body_), angle, 1))
    return "move_towards does not reach its target";
  return {};
}

template <class Real, class Target>
std::string Caller<Real, Target>::name() {
  const std::uint64_t data = static_cast<std::uint64_t>(random_.whole(0, 5));
  target_.set_user_data(body_, data);
  return answers("set_user_data", world_.user_data(body_) == data);
}

template <class Real, class Target>
std::string Caller<Real, Target>::destroy() {
  if (random_.chance(0.7)) return {};
  const int before = world_.counts().bodies;
  target_.destroy(body_);
  return answers("destroy", !world_.valid(body_) && world_.counts().bodies == before - 1);
}

template <class Real, class Target>
std::string Caller<Real, Target>::add_shape() {
  const MaterialPoints before = motion();
  ShapeDefinition definition = shape_of(size() * random_.within(0.2, 1));
  definition.position = vector(0.7 * size());
  const std::size_t count = world_.shapes(body_).size();
  target_.create_shape(body_, definition);
  if (world_.shapes(body_).size() != count + 1) return answers("create_shape", false);
  if (std::string wrong = sleepers_inside(); !wrong.empty()) return wrong;
  return moves_otherwise("create_shape", before);
}

#define PLUMB_FOR(Real, World) template auto Caller<Real, World<Real>>::on_body()->Make;
PLUMB_FOR(float, BasicWorld)
PLUMB_FOR(double, BasicWorld)
PLUMB_FOR(float, RecordedWorld)
PLUMB_FOR(double, RecordedWorld)
#undef PLUMB_FOR

}  // namespace plumb::harness::hunt
