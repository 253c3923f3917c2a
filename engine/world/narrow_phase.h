#pragma once

#include <limits>

#include "engine/world/world_data.h"

namespace plumb {

/// Newton's coefficient for two shapes, by the world's rule.
template <class Real>
Real restitution_between(const WorldData<Real>& w, int shape_a, int shape_b);

/// m, by which roundings may have brought the shapes of a contact into each other.
template <class Real>
Real rounding_between(const WorldData<Real>& w, int body_a, int body_b) {
  return 8 * std::numeric_limits<Real>::epsilon() * (w.extents[body_a] + w.extents[body_b]);
}

/// The constraint of two shapes where their bodies are now, with the points that they touch at and no
/// impulses; without points when they do not touch.
template <class Real>
ContactConstraint<Real> constraint_between(const WorldData<Real>& w, const ContactRecord& contact);

/// Whether two shapes lie on each other where their bodies are now, or nearly so: a contact would have
/// points.
template <class Real>
bool meet_now(const WorldData<Real>& w, int shape_a, int shape_b);

/// Takes what follows from the shapes' materials into the constraint of a contact.
template <class Real>
void mix_materials(const WorldData<Real>& w, const ContactRecord& contact, ContactConstraint<Real>& c);

}  // namespace plumb
