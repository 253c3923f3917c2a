#pragma once

#include <cmath>
#include <limits>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/world/contact_solver/locked_axes.h"
#include "engine/world/world_data.h"

/// Sets up contact constraints from the shapes' geometry, materials and bodies.
namespace plumb {

/// Returns |v.x| + |v.y|, at most 1.42 times the length.
template <class Real>
Real l1_norm(Vec2<Real> v) {
  return std::abs(v.x) + std::abs(v.y);
}

/// Returns Newton's coefficient for two shapes, by the world's combine rule.
template <class Real>
Real restitution_between(const WorldData<Real>& w, int shape_a, int shape_b);

/// Sets the coefficients of a contact's constraint from the shapes' materials.
template <class Real>
void mix_materials(const WorldData<Real>& w, const ContactRecord& contact, ContactConstraint<Real>& c);

/// Returns why the solver must record approach and largest impulses. A touching contact that neither bounces
/// nor is reported needs neither.
template <class Real>
ImpactTracking tracking_of(const ContactRecord& contact, const ContactConstraint<Real>& c) {
  if (!c.touching || c.restitution > 0) return ImpactTracking::Motion;
  return contact.hit_events || contact.pre_solve ? ImpactTracking::Reports : ImpactTracking::Off;
}

/// Returns an upper bound of the overlap, m, that rounding alone may have caused between the shapes of a
/// contact.
template <class Real>
Real rounding_overlap(const WorldData<Real>& w, int body_a, int body_b) {
  return 8 * std::numeric_limits<Real>::epsilon() * (w.extents[body_a] + w.extents[body_b]);
}

/// Returns true if two AABBs are farther apart than `margin`. Far from the origin both are rounded as
/// coarsely as positions, so a rounding margin is added.
template <class Real>
bool aabbs_apart(const WorldData<Real>& w, int shape_a, int shape_b, Real margin) {
  const Aabb<Real>& box = w.tight_aabbs[shape_a];
  const Real rounding = 4 * std::numeric_limits<Real>::epsilon() * (l1_norm(box.lower) + l1_norm(box.upper));
  return !box.grown(margin + rounding).overlaps(w.tight_aabbs[shape_b]);
}

/// Returns the manifold of two shapes at their bodies' present poses, with points up to `margin` apart, in
/// the frame of body a.
template <class Real>
ContactManifold<Real> manifold_of(const WorldData<Real>& w, const ContactRecord& contact, Real margin);

/// Returns which axes of the two bodies are locked, as bits of ContactLock.
template <class Real>
unsigned locks_of(const WorldData<Real>& w, int body_a, int body_b) {
  const auto of = [&](int body) -> unsigned {
    const BodyRecord<Real>& record = w.bodies[body];
    if (!w.is_dynamic(body) || record.lock_x == record.lock_y) return 0;
    return record.lock_x ? kLockAX : kLockAY;
  };
  return of(body_a) | of(body_b) * kLockBX;
}

/// Writes the manifold into the constraint, with lever arms and effective masses. Points with a known feature
/// keep their impulses. `q` is the rotation of a, `a_to_b` the vector from its centre of mass to that of b.
template <class Real>
void prepare_contact(const WorldData<Real>& w, const ContactRecord& contact,
                     const ContactManifold<Real>& manifold, Rotation<Real> q, Vec2<Real> a_to_b,
                     ContactConstraint<Real>& c);

/// Does the same, but writes the new normal impulses to `impulse`. Those of the constraint are kept, because
/// other threads may still read them.
template <class Real>
void prepare_contact(const WorldData<Real>& w, const ContactRecord& contact,
                     const ContactManifold<Real>& manifold, Rotation<Real> q, Vec2<Real> a_to_b,
                     ContactConstraint<Real>& c, Real (&impulse)[2]);

/// Returns the vector between the bodies' centres of mass, from a to b, m.
template <class Real>
Vec2<Real> centres_a_to_b(const WorldData<Real>& w, const ContactRecord& contact) {
  return (w.position[contact.body_b] - w.position[contact.body_a]).template as<Real>();
}

/// Prepares a contact at the bodies' present poses.
template <class Real>
void prepare_contact(const WorldData<Real>& w, const ContactRecord& contact,
                     const ContactManifold<Real>& manifold, ContactConstraint<Real>& c) {
  prepare_contact(w, contact, manifold, w.rotation[contact.body_a], centres_a_to_b(w, contact), c);
}

/// Returns the constraint of two shapes at their bodies' present poses, without impulses; without points if
/// they do not touch.
template <class Real>
ContactConstraint<Real> constraint_between(const WorldData<Real>& w, const ContactRecord& contact);

/// Returns true if a contact of two shapes at their current poses would have points: they touch, or nearly.
template <class Real>
bool may_touch_now(const WorldData<Real>& w, int shape_a, int shape_b);

}  // namespace plumb
