#pragma once

#include "engine/collide/contact_manifold.h"
#include "engine/world/world_data.h"

namespace plumb {

/// The manifold of a contact as the shapes beside its own leave it: where what is touched is made of several
/// shapes, a normal that belongs to none but the seam between them is replaced by the surface's, or the
/// contact has no points. `b_in_a` and `reach` are those that the manifold was found with, after its bodies
/// have moved by no more than `way` (m). Two points far apart are no seam's.
template <class Real>
ContactManifold<Real> across_seams(const WorldData<Real>& w, const ContactRecord& contact,
                                   const Pose<Real>& b_in_a, Real reach,
                                   const ContactManifold<Real>& manifold, Real way = 0);

/// Returns the manifold of a contact's two shapes, b's body at `b_in_a`, with what seams make of it; `way` as
/// above.
template <class Real>
ContactManifold<Real> collide_shapes(const WorldData<Real>& w, const ContactRecord& contact,
                                     const Pose<Real>& b_in_a, Real reach, Real way = 0) {
  const Convex<Real> shape_a = w.convex(contact.shape_a), shape_b = w.convex(contact.shape_b);
  const Corner<Real>* chain = shape_a.corners;
  const ContactManifold<Real> manifold =
      w.forms[contact.shape_a].chain
          ? collide_chain_segment(shape_a, chain[-1].point, chain[2].point, shape_b, b_in_a, reach)
          : collide_convex(shape_a, shape_b, b_in_a, reach);
  return manifold.count > 0 ? across_seams(w, contact, b_in_a, reach, manifold, way) : manifold;
}

}  // namespace plumb
