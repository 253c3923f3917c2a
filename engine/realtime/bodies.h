#pragma once

#include <vector>

#include "engine/joints/row.h"
#include "engine/math/trigonometry.h"

namespace plumb {

/// State and inverse masses of the bodies: one array per quantity, indexed by body in the scene's order.
/// Static and kinematic bodies have inverse mass 0, bodies of fixed rotation inverse inertia 0.
template <class Real>
struct Bodies {
  std::vector<Pose<Real>> pose;           ///< m
  std::vector<Real> angle;                ///< rad, whole turns counted
  std::vector<Twist<Real>> twist;         ///< m/s, rad/s
  std::vector<Twist<Real>> acceleration;  ///< m/s^2, rad/s^2: by forces, at the start of the substep
  std::vector<Real> inverse_mass;         ///< 1/kg
  std::vector<Real> inverse_inertia;      ///< 1/(kg m^2)

  std::size_t size() const { return pose.size(); }

  void apply(int body, Vec2<Real> impulse, Real angular_impulse) {
    twist[body].velocity += inverse_mass[body] * impulse;
    twist[body].angular_velocity += inverse_inertia[body] * angular_impulse;
  }

  /// Changes positions as `apply` changes velocities: x += M^-1 push, for a push in kg m.
  void move(int body, Vec2<Real> push, Real turning_push) {
    pose[body].position += inverse_mass[body] * push;
    const Real turn = inverse_inertia[body] * turning_push;
    if (turn == 0) return;
    angle[body] += turn;
    pose[body].rotation = rotation_of(angle[body]);
  }
};

/// Returns the velocity of the point at `arm` from the centre of mass.
template <class Real>
Vec2<Real> velocity_at(const Twist<Real>& twist, Vec2<Real> arm) {
  return twist.velocity + cross(twist.angular_velocity, arm);
}

/// Returns the position `t` into a substep of length `h` that began at `start`, if no impulse acts.
/// `velocity` is that at mid-step: x(t) = x + v t - a t (h - t) / 2, exact for constant acceleration.
template <class Real>
Vec2<Real> position_after(const Vec2<Real>& start, Vec2<Real> velocity, Vec2<Real> acceleration, Real t,
                          Real h) {
  return start + t * (velocity - Real(0.5) * (h - t) * acceleration);
}

template <class Real>
Pose<Real> pose_after(const Bodies<Real>& bodies, int body, Real t, Real h) {
  const Twist<Real>& twist = bodies.twist[body];
  const Twist<Real>& acceleration = bodies.acceleration[body];
  const Real turn = t * (twist.angular_velocity - Real(0.5) * (h - t) * acceleration.angular_velocity);
  return {position_after(bodies.pose[body].position, twist.velocity, acceleration.velocity, t, h),
          turn == 0 ? bodies.pose[body].rotation : rotation_of(bodies.angle[body] + turn)};
}

/// Returns the velocity at that time: v(t) = v + a (t - h/2).
template <class Real>
Twist<Real> twist_after(const Bodies<Real>& bodies, int body, Real t, Real h) {
  const Real since_middle = t - Real(0.5) * h;
  return {bodies.twist[body].velocity + since_middle * bodies.acceleration[body].velocity,
          bodies.twist[body].angular_velocity + since_middle * bodies.acceleration[body].angular_velocity};
}

}  // namespace plumb
