#include "harness/known_limits.h"

namespace plumb::harness {
namespace {

constexpr KnownLimit kLimits[] = {
    {"box2d", "off_centre_torque/spin_100",
     "angle_error|angular_velocity_error|discrete_angle|discrete_angular_velocity|energy_drift|angular_"
     "momentum_drift",
     "Box2D lets a body turn by at most pi/2 a step (b2_maxRotation), which is 94 rad/s at 1/60 s, "
     "and slows it down to that."},
    {"bullet|bullet-double", "off_centre_torque/spin_100", "angle_error|discrete_angle",
     "Bullet limits the rotation of a step to pi/4 (ANGULAR_MOTION_THRESHOLD), but builds the "
     "quaternion of the step with the unlimited spin: of the 1.667 rad that 100 rad/s make in 1/60 "
     "s, 1.442 rad are left."},
    {"box2d", "pendulum_chain[20]", "velocity_error",
     "Box2D's sequential impulses carry a pull from one joint to the next in each of its 8 sweeps a "
     "step; a chain of 20 needs more of them to feel its own weight."},
    {"box2d", "pendulum_chain[100]", "velocity_error|angular_velocity_error",
     "Box2D's sequential impulses carry a pull from one joint to the next in each of its 8 sweeps a "
     "step; through a chain of 100 it comes steps too late, and the chain stretches."},
    {"bullet|bullet-double", "pendulum_chain[20]", "velocity_error",
     "Bullet's sequential impulses carry a pull from one joint to the next in each of its 10 sweeps "
     "a step; a chain of 20 needs more of them to feel its own weight."},
    {"bullet|bullet-double", "pendulum_chain[100]", "position_error|velocity_error|angular_velocity_error",
     "Bullet's sequential impulses carry a pull from one joint to the next in each of its 10 sweeps "
     "a step; through a chain of 100 it comes steps too late, and the chain stretches."},
    {"box2d", "free_fall/*",
     "position_error|velocity_error|discrete_position|discrete_velocity|energy_drift|momentum_drift",
     "Box2D lets a body move by at most 2 m a step (b2_maxTranslation), which is less than free fall "
     "makes at 1/30 s.",
     true},
    {"bullet|bullet-double", "off_centre_torque/*",
     "position_error|angle_error|velocity_error|discrete_position|discrete_angle|discrete_velocity",
     "Bullet limits the rotation of a step to pi/4 (ANGULAR_MOTION_THRESHOLD), which a long step "
     "reaches at a lower spin.",
     true},
    {"box2d|bullet|bullet-double", "pendulum_chain*",
     "position_error|angle_error|velocity_error|angular_velocity_error|energy_drift|joint_gap",
     "Sequential impulses are stopped after a few sweeps, whatever the step: what they leave undone "
     "falls more slowly than the error of the step.",
     true},
};

bool matches_one(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() != '*') {
    return !text.empty() && text.front() == pattern.front() && matches_one(pattern.substr(1), text.substr(1));
  }
  for (std::size_t skip = 0; skip <= text.size(); ++skip)
    if (matches_one(pattern.substr(1), text.substr(skip))) return true;
  return false;
}

}  // namespace

std::span<const KnownLimit> known_limits() { return kLimits; }

bool matches(std::string_view pattern, std::string_view text) {
  while (true) {
    const std::size_t bar = pattern.find('|');
    if (matches_one(pattern.substr(0, bar), text)) return true;
    if (bar == std::string_view::npos) return false;
    pattern.remove_prefix(bar + 1);
  }
}

const KnownLimit* find_known_limit(std::span<const KnownLimit> limits, std::string_view engine,
                                   std::string_view instance, std::string_view check, bool defaults) {
  for (const KnownLimit& limit : limits) {
    if (defaults && limit.elsewhere_only) continue;
    if (matches(limit.engine, engine) && matches(limit.instance, instance) && matches(limit.check, check))
      return &limit;
  }
  return nullptr;
}

}  // namespace plumb::harness
