#pragma once

#include <cmath>

#include "engine/world/ablation/ablation.h"
#include "engine/world/world_data.h"

/// Manifolds that are kept while their bodies have moved little relative to each other. Inlined into the pass
/// over the constraints, which takes most of what a resting contact costs in the narrow phase.
namespace plumb {

/// rad, largest rotation of a body in a step for which its manifolds are recycled: the error of the series
/// below is then 1e-9 of an arm.
inline constexpr double kMaxRecycleRotation = 1.0 / 32;

/// Recycles the manifold of bodies that move together, as in the filling of a drum: rotates the manifold with
/// body a, and subtracts only the motion of b relative to a from the budget. Returns false if that is too
/// much. Not inlined: contacts at rest would pay for its registers.
template <class Real>
[[gnu::noinline]] bool rotate_manifold(const SolverBody<Real>& a, const SolverBody<Real>& b, Real extent_b,
                                       ContactConstraint<Real>& c) {
  const Vec2<Real> displacement = b.delta_position - a.delta_position, n = c.normal;
  // Sine of a's rotation angle, and 1 - its cosine.
  const Real angle = a.delta_angle, squared = angle * angle;
  const Real sine = angle - angle * squared * (Real(1) / 6);
  const Real versine = Real(0.5) * squared * (1 - squared * (Real(1) / 12));
  const Vec2<Real> new_normal{n.x - sine * n.y - versine * n.x, n.y + sine * n.x - versine * n.y};
  // The normal is that of the step's middle (common_rotation.h). Under a common rotation the bodies keep
  // their arms there and move along a chord: the normal times the chord equals the difference of the arms
  // times twice the sine of half the angle.
  const Real chord = angle - angle * squared * (Real(1) / 24);
  const Real relative_angle = b.delta_angle - angle;
  const Real opening = dot(n, displacement) + (c.arm_b[0] - c.arm_a[0]) * chord;
  const Real slip = cross(n, displacement) - (c.arm_tangent_b - c.arm_tangent_a) * chord;
  c.recycle_budget -= std::abs(opening) + std::abs(slip) + std::abs(relative_angle) * extent_b;
  if (c.recycle_budget < 0 || std::abs(angle) > Real(kMaxRecycleRotation)) return false;
  c.normal = new_normal;
  for (int i = 0; i < c.count; ++i) c.separation[i] += opening + c.arm_b[i] * relative_angle;
  return true;
}

/// Recycles the manifold: updates separations to first order. Returns false if the bodies moved too far for
/// that. As long as the budget suffices, spends it on their whole motion and keeps the normal fixed, because
/// a normal that follows each tremor of a light body would make the load of a heavy one on it swing.
template <class Real>
bool recycle_manifold(const WorldData<Real>& w, ContactConstraint<Real>& c, Real extent_a, Real extent_b) {
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Vec2<Real> displacement = b.delta_position - a.delta_position;
  const Real total =
      l1_norm(displacement) + std::abs(a.delta_angle) * extent_a + std::abs(b.delta_angle) * extent_b;
  if (!(total <= c.recycle_budget))
    return enabled(Switch::TurnedManifolds) && rotate_manifold(a, b, extent_b, c);
  c.recycle_budget -= total;
  const Real opening = dot(c.normal, displacement);
  for (int i = 0; i < c.count; ++i) {
    c.separation[i] += opening + c.arm_b[i] * b.delta_angle - c.arm_a[i] * a.delta_angle;
  }
  return true;
}

}  // namespace plumb
