#pragma once

#include <cmath>

#include "engine/world/world_data.h"

/// Manifolds that are kept while their bodies have moved little relative to each other. Inlined into the pass
/// over the constraints, which takes most of what a resting contact costs in the narrow phase.
namespace plumb {

/// rad, largest rotation of a body in a step for which its manifolds are recycled: the error of the series
/// below is then 1e-9 of an arm.
inline constexpr double kRecycleTurn = 1.0 / 32;

/// Recycles the manifold of bodies that move together, as in the filling of a drum: rotates the manifold with
/// body a, and subtracts only the motion of b relative to a from the budget. Returns false if that is too
/// much. Not inlined: contacts at rest would pay for its registers.
template <class Real>
[[gnu::noinline]] bool turn_manifold(const SolverBody<Real>& a, const SolverBody<Real>& b, Real extent_b,
                                     ContactConstraint<Real>& c) {
  const Vec2<Real> shift = b.delta_position - a.delta_position, n = c.normal;
  // Sine of a's rotation angle, and 1 - its cosine.
  const Real turn = a.delta_angle, squared = turn * turn;
  const Real sine = turn - turn * squared * (Real(1) / 6);
  const Real bend = Real(0.5) * squared * (1 - squared * (Real(1) / 12));
  const Vec2<Real> after{n.x - sine * n.y - bend * n.x, n.y + sine * n.x - bend * n.y};
  // The normal is that of the step's middle (common_rotation.h). Under a common rotation the bodies keep
  // their arms there and move along a chord: the normal times the chord equals the difference of the arms
  // times twice the sine of half the angle.
  const Real chord = turn - turn * squared * (Real(1) / 24);
  const Real relative_turn = b.delta_angle - turn;
  const Real closed = dot(n, shift) + (c.arm_b[0] - c.arm_a[0]) * chord;
  const Real slid = cross(n, shift) - (c.arm_tangent_b - c.arm_tangent_a) * chord;
  c.recycle_budget -= std::abs(closed) + std::abs(slid) + std::abs(relative_turn) * extent_b;
  if (c.recycle_budget < 0 || std::abs(turn) > Real(kRecycleTurn)) return false;
  c.normal = after;
  for (int i = 0; i < c.count; ++i) c.separation[i] += closed + c.arm_b[i] * relative_turn;
  return true;
}

/// Recycles the manifold: updates separations to first order. Returns false if the bodies moved too far for
/// that. As long as the budget suffices, spends it on their whole motion and keeps the normal fixed, because
/// a normal that follows each tremor of a light body would make the load of a heavy one on it swing.
template <class Real>
bool recycle_manifold(const WorldData<Real>& w, ContactConstraint<Real>& c, Real extent_a, Real extent_b) {
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Vec2<Real> shift = b.delta_position - a.delta_position;
  const Real all = l1_norm(shift) + std::abs(a.delta_angle) * extent_a + std::abs(b.delta_angle) * extent_b;
  if (!(all <= c.recycle_budget)) return turn_manifold(a, b, extent_b, c);
  c.recycle_budget -= all;
  const Real closed = dot(c.normal, shift);
  for (int i = 0; i < c.count; ++i) {
    c.separation[i] += closed + c.arm_b[i] * b.delta_angle - c.arm_a[i] * a.delta_angle;
  }
  return true;
}

}  // namespace plumb
