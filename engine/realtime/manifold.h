#pragma once

#include <cstdint>

#include "engine/geometry/shape.h"

namespace plumb {

/// A contact point: between touching shapes, or at the place of first contact.
template <class Real>
struct ManifoldPoint {
  Vec2<Real> on_a{}, on_b{};  ///< m, in the world, on either surface; on_b - on_a = separation normal
  Real separation = 0;        ///< m, negative where they overlap
  std::uint32_t feature = 0;  ///< the corners or edges in contact: the same while the contact persists
};

/// Up to two points with one normal.
template <class Real>
struct Manifold {
  Vec2<Real> normal{};  ///< unit, from a to b
  int count = 0;
  bool reference_is_b = false;  ///< for two boxes: true if b's face gave the normal
  ManifoldPoint<Real> points[2];
};

/// Circle against circle: along the line of centres.
template <class Real>
Manifold<Real> collide_circles(const SolidShape<Real>& a, const Placement<Real>& at_a,
                               const SolidShape<Real>& b, const Placement<Real>& at_b);

/// Box a against circle b: from the box's point nearest to the centre, or from its nearest face if the centre
/// is inside.
template <class Real>
Manifold<Real> collide_box_circle(const SolidShape<Real>& a, const Placement<Real>& at_a,
                                  const SolidShape<Real>& b, const Placement<Real>& at_b);

/// Box against box: the axis of greatest separation (separating axes), then the other's facing edge clipped
/// to the reference face. Points separated by more than `reach` are left out.
template <class Real>
Manifold<Real> collide_boxes(const SolidShape<Real>& a, const Placement<Real>& at_a,
                             const SolidShape<Real>& b, const Placement<Real>& at_b, Real reach);

/// Any two shapes.
template <class Real>
Manifold<Real> collide(const SolidShape<Real>& a, const Placement<Real>& at_a, const SolidShape<Real>& b,
                       const Placement<Real>& at_b, Real reach);

}  // namespace plumb
