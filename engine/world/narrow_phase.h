#pragma once

#include <limits>

#include "engine/world/world_data.h"

namespace plumb {

/// Returns Newton's coefficient for two shapes, by the world's combine rule.
template <class Real>
Real restitution_between(const WorldData<Real>& w, int shape_a, int shape_b);

/// Returns the depth, m, to which rounding may have moved the shapes of a contact into each other.
template <class Real>
Real rounding_between(const WorldData<Real>& w, int body_a, int body_b) {
  return 8 * std::numeric_limits<Real>::epsilon() * (w.extents[body_a] + w.extents[body_b]);
}

/// Returns the constraint of two shapes at their bodies' present poses, without impulses; without points if
/// they do not touch.
template <class Real>
ContactConstraint<Real> constraint_between(const WorldData<Real>& w, const ContactRecord& contact);

/// Returns true if two shapes touch, or nearly so, at their present poses: a contact would have points.
template <class Real>
bool meet_now(const WorldData<Real>& w, int shape_a, int shape_b);

/// Sets the coefficients of a contact's constraint from the shapes' materials.
template <class Real>
void mix_materials(const WorldData<Real>& w, const ContactRecord& contact, ContactConstraint<Real>& c);

}  // namespace plumb
