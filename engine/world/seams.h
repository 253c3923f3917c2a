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

}  // namespace plumb
