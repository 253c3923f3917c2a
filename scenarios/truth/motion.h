#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/math/vec2.h"
#include "engine/scene/scene.h"

/// Common parts of truths. They compute in extended precision if the platform has it, and round once, at the
/// end.
namespace plumb::scenarios::truth {

#ifdef __wasm__
// In this build long double is emulated in software, a hundred times slower, and a page needs only a few
// digits.
using Real = double;
#else
using Real = long double;
#endif

/// Motion of a body, in SI units.
struct Motion {
  Vec2<Real> position{};
  Real angle = 0;
  Vec2<Real> velocity{};
  Real angular_velocity = 0;
};

/// Accelerations of a body, in SI units.
struct Acceleration {
  Vec2<Real> linear{};
  Real angular = 0;
};

inline Motion motion_of(const Body& body) {
  return {body.position.as<Real>(), body.angle, body.velocity.as<Real>(), body.angular_velocity};
}

inline std::vector<Motion> motions_of(const Scene& scene) {
  std::vector<Motion> motions;
  for (const Body& body : scene.bodies) motions.push_back(motion_of(body));
  return motions;
}

inline BodyState rounded(const Motion& motion) {
  return {motion.position.as<double>(), static_cast<double>(motion.angle), motion.velocity.as<double>(),
          static_cast<double>(motion.angular_velocity)};
}

/// Returns the motion under a constant acceleration: x + v t + a t^2/2.
inline Motion coast(const Motion& from, Real time, const Acceleration& acceleration = {}) {
  const auto& [linear, angular] = acceleration;
  return {from.position + time * from.velocity + time * time / 2 * linear,
          from.angle + time * from.angular_velocity + time * time / 2 * angular,
          from.velocity + time * linear, from.angular_velocity + time * angular};
}

/// Returns (cos, sin) of `angle`.
inline Vec2<Real> direction(Real angle) { return {std::cos(angle), std::sin(angle)}; }

/// Rotates `v` by `angle`.
inline Vec2<Real> turned(Real angle, Vec2<Real> v) {
  const auto [c, s] = direction(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// Returns a shape that gives a body its appearance and inertia, but collides with nothing.
inline Shape untouchable(const Geometry& geometry) {
  return {.geometry = geometry, .friction = 0, .filter = {.mask = 0}};
}

}  // namespace plumb::scenarios::truth
