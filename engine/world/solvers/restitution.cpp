#include "engine/world/solvers/restitution.h"

#include <algorithm>

#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Largest offset of a circle from its body's centre of mass, as a fraction of its radius. Beyond it the
// circle turns about that centre, and its normal is not the line between the bodies.
constexpr double kCentred = 1e-5;

template <class Real>
bool is_centred_disc(const WorldData<Real>& w, int shape) {
  const ShapeForm<Real>& form = w.forms[shape];
  if (form.count != 1 || form.chain) return false;
  const Vec2<Real> centre = w.corners.data()[form.corner].point;
  return std::max(std::abs(centre.x), std::abs(centre.y)) <= Real(kCentred) * form.radius;
}

// Prepares two separated circles: they will touch on the line between their centres at that time.
template <class Real>
void follow_discs(const WorldData<Real>& w, const ContactRecord& contact, RestitutionContact<Real>& bounce) {
  ContactConstraint<Real>& c = *bounce.contact;
  if (c.count != 1 || !(c.separation[0] > 0) || c.normal_impulse[0] > 0) return;
  if (!is_centred_disc(w, contact.shape_a) || !is_centred_disc(w, contact.shape_b)) return;
  const Real radius_a = w.forms[contact.shape_a].radius, radius_b = w.forms[contact.shape_b].radius;
  bounce.radii = radius_a + radius_b;
  bounce.between = (w.position[contact.body_b] - w.position[contact.body_a]).template as<Real>();
  // The future contact point, in the middle of the gap until then.
  const BodyMotion<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  c.arm_tangent_a = -radius_a, c.arm_tangent_b = radius_b;
  const Real inverse = a.inverse_mass + b.inverse_mass + a.inverse_inertia * radius_a * radius_a +
                       b.inverse_inertia * radius_b * radius_b;
  c.tangent_mass = inverse > 0 ? 1 / inverse : Real(0);
}

}  // namespace

template <class Real>
void collect_restitution_contacts(WorldData<Real>& w) {
  w.scratch.bounces.clear();
  for (const int id : w.scratch.bouncing) {
    const ContactRecord& contact = w.contacts[id];
    if (contact.home != ContactHome::Graph) continue;
    RestitutionContact<Real> bounce{.contact = &constraint_of(w, contact)};
    follow_discs(w, contact, bounce);
    if (bounce.contact->restitution > 0 || bounce.radii > 0) w.scratch.bounces.push_back(bounce);
  }
}

template void collect_restitution_contacts(WorldData<float>&);
template void collect_restitution_contacts(WorldData<double>&);

}  // namespace plumb
