#pragma once

#include "engine/world/step/speculative_contact.h"

namespace plumb {

/// Rebuilds a contact with points at the middle of the step, if its bodies keep their velocities and the
/// contact lasts: points that press then neither separate nor approach by more than a recycled manifold
/// tolerates. Returns false, and changes nothing, if it does not last. The new impulses are written to
/// `c.now`. Normal and arms rotate within the step, as where a disc rolls over another or a block pivots on
/// its corner. Those of the middle leave an error of second order; with those of the start, forces would lag
/// by half a step.
template <class Real>
bool rebuild_lasting_contact(const WorldData<Real>& w, const ContactRecord& contact, Real dt,
                             ContactConstraint<Real>& c);

/// Rebuilds a contact with points whose bodies rotate together (common_rotation.h), unless they approach by
/// more than their rotation explains. Returns false, and changes nothing, if they do, or if no point touches.
/// `manifold`: at the start of the step. The new impulses are written to `c.now`.
template <class Real>
bool rebuild_rotating_contact(const WorldData<Real>& w, const ContactRecord& contact,
                              const ContactManifold<Real>& manifold, Real dt, ContactConstraint<Real>& c);

/// Returns the contact with a surface that a loaded body slides onto, at the middle of the step: it then
/// supports the body together with the lasting contacts of that time. Without points if there is none.
/// `manifold`: at the start of the step.
template <class Real>
SpeculativeContact<Real> arriving_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                          const ContactManifold<Real>& manifold, Real dt);

/// Returns the contact with a segment of a chain that a body reaches within the step, without points if it
/// reaches none. Segments may be far shorter than the body's motion in a step: those that it touches at the
/// start do not hold it until the end. So each segment is searched at the ends of all substeps, at the
/// bodies' present velocities, and its contact taken where it lies deepest: the body is then held by the
/// planes of all segments on its way, and sinks into none. `manifold`: at the start of the step; if it has
/// points, they must be in front of the segment. `h`: s, of a substep.
template <class Real>
SpeculativeContact<Real> segment_ahead(const WorldData<Real>& w, const ContactRecord& contact,
                                       const ContactManifold<Real>& manifold, Real dt, Real h);

}  // namespace plumb
