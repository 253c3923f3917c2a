#pragma once

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Corrects a contact's manifold at internal edges. If the surface consists of several shapes, the normal of
/// an edge between them is replaced by the surface's normal, or all points are removed. `b_in_a` and `margin`
/// are those of the manifold, after its bodies have moved by at most `displacement` (m). A manifold of two
/// points far apart is not changed.
template <class Real>
ContactManifold<Real> correct_internal_edges(const WorldData<Real>& w, const ContactRecord& contact,
                                             const Pose<Real>& b_in_a, Real margin,
                                             const ContactManifold<Real>& manifold, Real displacement = 0);

/// Returns the point about which impulses between two bodies do not rotate them relative to each other, in
/// a's frame: the mean of their centres of mass, weighted by inverse inertia.
template <class Real>
Vec2<Real> pivot_between(const WorldData<Real>& w, const ContactRecord& contact, const Pose<Real>& b_in_a) {
  const Real inverse_inertia_a = w.motion[contact.body_a].inverse_inertia,
             inverse_inertia_b = w.motion[contact.body_b].inverse_inertia;
  return inverse_inertia_b > 0
             ? (inverse_inertia_b / (inverse_inertia_a + inverse_inertia_b)) * b_in_a.position
             : Vec2<Real>{};
}

/// Returns the manifold of a contact's two shapes, b's body at `b_in_a`, corrected at internal edges;
/// `displacement` as above.
template <class Real>
ContactManifold<Real> collide_shapes(const WorldData<Real>& w, const ContactRecord& contact,
                                     const Pose<Real>& b_in_a, Real margin, Real displacement = 0) {
  const Convex<Real> shape_a = w.convex(contact.shape_a), shape_b = w.convex(contact.shape_b);
  const Corner<Real>* chain = shape_a.corners;
  const Vec2<Real> pivot = pivot_between(w, contact, b_in_a);
  const ContactManifold<Real> manifold =
      w.forms[contact.shape_a].chain
          ? collide_chain_segment(shape_a, chain[-1].point, chain[2].point, shape_b, b_in_a, margin, pivot)
          : collide_convex(shape_a, shape_b, b_in_a, margin, pivot);
  return manifold.count > 0 ? correct_internal_edges(w, contact, b_in_a, margin, manifold, displacement)
                            : manifold;
}

}  // namespace plumb
