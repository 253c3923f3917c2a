#pragma once

#include <cstdint>

#include "engine/math/pose.h"

namespace plumb {

/// Solver body of the real-time world: the part of a body that solvers read and write, half a cache line in
/// float. Only dynamic bodies have an inverse mass; kinematic ones follow their given velocity.
template <class Real>
struct alignas(16) SolverBody {
  Vec2<Real> velocity{};        ///< m/s, of the centre of mass
  Real angular_velocity = 0;    ///< rad/s
  Vec2<Real> delta_position{};  ///< m, of the centre of mass since the start of the step
  Real delta_angle = 0;         ///< rad, since the start of the step
  Real inverse_mass = 0;        ///< 1/kg
  Real inverse_inertia = 0;     ///< 1/(kg m^2)

  void apply(Vec2<Real> impulse, Real angular_impulse) {
    velocity += inverse_mass * impulse;
    angular_velocity += inverse_inertia * angular_impulse;
  }
};

/// Returns true if impulses change the body's velocity.
template <class Real>
bool is_dynamic(const SolverBody<Real>& motion) {
  return motion.inverse_mass + motion.inverse_inertia > 0;
}

/// The solver bodies of a world, indexed by body: awake, static and all others.
template <class Real>
struct SolverBodies {
  SolverBody<Real>* motion = nullptr;
  const Rotation<Real>* rotation = nullptr;  ///< from the body's frame to the world's, updated every substep
  const Vec2d* position = nullptr;  ///< m, centres of mass at the start of the step. In double, because far
                                    ///< from the origin only differences may be rounded
};

/// A soft constraint's coefficients for a substep h (Catto, Soft Constraints, 2011):
/// lambda' = -mass (mass_scale (Jv + bias_rate C)) - impulse_scale lambda. A rigid constraint has {0, 1, 0}.
template <class Real>
struct Softness {
  Real bias_rate = 0;  ///< 1/s
  Real mass_scale = 1;
  Real impulse_scale = 0;
};

/// Returns the softness for omega = 2 pi hertz and c = h omega (2 zeta + h omega):
/// bias_rate = omega / (2 zeta + h omega), mass_scale = c / (1 + c), impulse_scale = 1 / (1 + c).
template <class Real>
Softness<Real> softness(double hertz, double damping_ratio, double h) {
  if (!(hertz > 0)) return {};
  const double omega = 2 * 3.14159265358979323846 * hertz;
  const double a = 2 * damping_ratio + h * omega, c = h * omega * a;
  return {static_cast<Real>(omega / a), static_cast<Real>(c / (1 + c)), static_cast<Real>(1 / (1 + c))};
}

}  // namespace plumb
