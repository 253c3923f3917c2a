// Calls on a shape or a joint.
#include <type_traits>

#include "engine/world/recorder.h"
#include "harness/hunt/caller.h"

namespace plumb::harness::hunt {

template <class Real, class Target>
auto Caller<Real, Target>::on_shape() -> Make {
  static constexpr Make kCalls[] = {&Caller::material, &Caller::filter, &Caller::density,
                                    &Caller::sensor,   &Caller::flags,  &Caller::destroy_shape};
  return pick(kCalls);
}

template <class Real, class Target>
auto Caller<Real, Target>::on_joint() -> Make {
  static constexpr Make kCalls[] = {&Caller::change, &Caller::loads, &Caller::loads, &Caller::rejoin,
                                    &Caller::destroy_joint};
  return pick(kCalls);
}

template <class Real, class Target>
std::string Caller<Real, Target>::material() {
  const Material wanted{.friction = random_.pick({0.6, 0.6, 0.0, 1.0}),
                        .restitution = random_.pick({0.0, 0.0, 0.5}),
                        .rolling_resistance = random_.pick({0.0, 0.0, 0.1}),
                        .surface_speed = random_.pick({0.0, 0.0, 1.0})};
  target_.set_material(shape_, wanted);
  const Material now = world_.material(shape_);
  if (!near(now.friction, wanted.friction) || !near(now.restitution, wanted.restitution) ||
      !near(now.rolling_resistance, wanted.rolling_resistance) ||
      !near(now.surface_speed, wanted.surface_speed))
    return answers("set_material", false);
  return {};
}

template <class Real, class Target>
std::string Caller<Real, Target>::filter() {
  Filter wanted;
  if (random_.chance(0.5)) wanted.category = std::uint64_t{1} << random_.whole(0, 63);
  if (random_.chance(0.4)) wanted.mask = ~(std::uint64_t{1} << random_.whole(0, 63));
  if (random_.chance(0.2)) wanted.group = random_.whole(-2, 2);
  target_.set_filter(shape_, wanted);
  return answers("set_filter", world_.filter(shape_) == wanted);
}

template <class Real, class Target>
std::string Caller<Real, Target>::density() {
  const MaterialPoints before = motion();
  const double wanted = random_.pick({1.0, 1.0, 0.5, 4.0});
  target_.set_density(shape_, wanted);
  if (!near(world_.density(shape_), wanted)) return answers("set_density", false);
  return moves_otherwise("set_density", before);
}

template <class Real, class Target>
std::string Caller<Real, Target>::sensor() {
  const MaterialPoints before = motion();
  const bool wanted = random_.chance(0.4);
  target_.set_sensor(shape_, wanted);
  if (world_.sensor(shape_) != wanted) return answers("set_sensor", false);
  return moves_otherwise("set_sensor", before);
}

template <class Real, class Target>
std::string Caller<Real, Target>::flags() {
  const bool hits = random_.chance(0.6), solves = random_.chance(0.5);
  target_.set_hit_events(shape_, hits), target_.set_pre_solve(shape_, solves);
  return answers("set_hit_events or set_pre_solve",
                 world_.hit_events(shape_) == hits && world_.pre_solve(shape_) == solves);
}

template <class Real, class Target>
std::string Caller<Real, Target>::destroy_shape() {
  if (random_.chance(0.5)) return {};
  const MaterialPoints before = motion();
  target_.destroy(shape_);
  if (world_.valid(shape_)) return answers("destroy", false);
  return moves_otherwise("destroy of a shape", before);
}

template <class Real, class Target>
std::string Caller<Real, Target>::change() {
  JointKind wanted = world_.kind(joint_);
  // Resets one member at a time to its default; switches a motor or a spring on or off.
  std::visit(
      [&](auto& kind) {
        const std::remove_reference_t<decltype(kind)> usual{};
        if constexpr (requires { kind.motor.reset(); }) {
          if (random_.chance(0.5)) kind.motor = usual.motor;
        }
        if constexpr (requires { kind.spring.reset(); }) {
          if (random_.chance(0.3)) kind.spring = usual.spring;
        }
        if constexpr (requires { kind.limits.reset(); }) {
          if (random_.chance(0.3)) kind.limits = usual.limits;
        }
        if constexpr (requires { kind.motor->speed; }) {
          if (kind.motor) kind.motor->speed = number(3);
        }
        // Keeps its anchors, and the angle from which it counts.
        if constexpr (!requires { kind.reference_angle; }) {
          if (random_.chance(0.15)) kind = usual;
        }
      },
      wanted);
  target_.change(joint_, wanted);
  return answers("change", world_.kind(joint_).index() == wanted.index());
}

template <class Real, class Target>
std::string Caller<Real, Target>::loads() {
  const JointReading reading = world_.read(joint_);
  // Chooses limits near the joint's present load, so that a slightly larger or smaller load decides.
  const double force = random_.chance(0.2) ? 0 : reading.force * random_.within(0.85, 1.02),
               torque = random_.chance(0.6) ? 0 : reading.torque * random_.within(0.85, 1.02);
  target_.set_load_events(joint_, force, torque);
  const JointDefinition now = world_.definition(joint_);
  return answers("set_load_events", near(now.report_force, force) && near(now.report_torque, torque));
}

template <class Real, class Target>
std::string Caller<Real, Target>::rejoin() {
  const JointReading reading = world_.read(joint_);
  const auto [a, b] = world_.bodies(joint_);
  JointDefinition definition = world_.definition(joint_);
  definition.break_force = random_.chance(0.3) ? 0 : reading.force * random_.within(0.85, 1.05);
  definition.break_torque = random_.chance(0.5) ? 0 : reading.torque * random_.within(0.85, 1.05);
  target_.destroy(joint_);
  joint_ = target_.create_joint(a, b, definition);
  const JointDefinition now = world_.definition(joint_);
  return answers("create_joint", near(now.break_force, definition.break_force) &&
                                     near(now.break_torque, definition.break_torque));
}

template <class Real, class Target>
std::string Caller<Real, Target>::destroy_joint() {
  if (random_.chance(0.7)) return {};
  target_.destroy(joint_);
  return answers("destroy", !world_.valid(joint_));
}

#define PLUMB_FOR(Real, World)                               \
  template auto Caller<Real, World<Real>>::on_shape()->Make; \
  template auto Caller<Real, World<Real>>::on_joint()->Make;
PLUMB_FOR(float, BasicWorld)
PLUMB_FOR(double, BasicWorld)
PLUMB_FOR(float, RecordedWorld)
PLUMB_FOR(double, RecordedWorld)
#undef PLUMB_FOR

}  // namespace plumb::harness::hunt
