#pragma once

#include <cstdint>
#include <limits>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Returns true if two shapes are farther apart than `margin` (m) along the normal of a face, as numbered in
/// ContactManifold. A face that separated two shapes in the last step mostly still does. The possible
/// rounding error of the manifold is added: whatever face is tried, a manifold within `margin` is never
/// missed.
template <class Real>
bool are_separated_by(const WorldData<Real>& w, const ContactRecord& contact, std::uint8_t face,
                      Real margin) {
  const bool of_b = face >= kMaxCorners;
  const int edge = of_b ? face - kMaxCorners : face;
  const Convex<Real> own = w.convex(of_b ? contact.shape_b : contact.shape_a),
                     other = w.convex(of_b ? contact.shape_a : contact.shape_b);
  // The contact's number may have belonged to other shapes.
  if (own.count < 2 || edge >= own.count) return false;
  const int body = of_b ? contact.body_b : contact.body_a, others = of_b ? contact.body_a : contact.body_b;
  const Corner<Real>& corner = own.corners[edge];
  const Vec2<Real> to_other = (w.position[others] - w.position[body]).template as<Real>();
  const Vec2<Real> normal = w.rotation[body] * corner.normal,
                   from_other = w.rotation[others].inverse() * normal;
  Real least = dot(from_other, other.corners[0].point);
  for (int i = 1; i < other.count; ++i) {
    const Real along = dot(from_other, other.corners[i].point);
    least = along < least ? along : least;
  }
  const Real apart = dot(normal, to_other) + least - dot(corner.normal, corner.point);
  const Real rounding =
      16 * std::numeric_limits<Real>::epsilon() * (w.extents[body] + w.extents[others] + l1_norm(to_other));
  return apart - (own.radius + other.radius) > margin + rounding;
}

}  // namespace plumb
