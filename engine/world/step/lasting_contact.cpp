#include "engine/world/step/lasting_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/math/small_rotation.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/internal_edges.h"
#include "engine/world/step/common_rotation.h"
#include "engine/world/step/speculative_contact.h"

namespace plumb {
namespace {

// Largest deviation of a rotating body's points from their tangents in half a step, as a fraction of its half
// width, for which contacts are evaluated at the middle of the step. Continuous collision stops bodies that
// are deeper than half of it between the step's ends. With values from 1/256 to 1/16 all scenarios keep their
// bounds, and blocks that tip over and discs that roll off change their errors by less than a factor of 2.
constexpr double kLastingBend = 1.0 / 64;

// Returns the contact at the middle of the step, if the bodies rotate little enough. `displacement`: m,
// of b relative to a until then; `common`: rad, rotation that they have in common until then.
template <class Real>
SpeculativeContact<Real> contact_at_middle(const WorldData<Real>& w, const ContactRecord& contact,
                                           Vec2<Real> displacement, Real common, Real dt) {
  SpeculativeContact<Real> at;
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Real half = Real(0.5) * dt;
  at.displacement = displacement;
  at.delta_angle_a = half * a.angular_velocity, at.delta_angle_b = half * b.angular_velocity;
  const auto deviates = [&](int body, Real turned) {
    const Real turn = turned - common;
    return w.is_dynamic(body) &&
           Real(0.5) * turn * turn * w.extents[body] > Real(kLastingBend) * w.bodies[body].half_width;
  };
  if (deviates(contact.body_a, at.delta_angle_a) || deviates(contact.body_b, at.delta_angle_b)) return at;
  at.a_to_b = centres_a_to_b(w, contact) + at.displacement;
  at.rotation = rotated_by(w.rotation[contact.body_a], at.delta_angle_a);
  const Rotation<Real> to_a = at.rotation.inverse(),
                       q = rotated_by(w.rotation[contact.body_b], at.delta_angle_b);
  const Pose<Real> b_in_a{to_a * at.a_to_b, {to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s}};
  const Real margin =
      speculative_margin(a, b, w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent, dt);
  at.manifold = collide_shapes(w, contact, b_in_a, margin, l1_norm(at.displacement));
  return at;
}

// Motion in a step, in extents of the smaller shape, from which the segments of a chain ahead are searched. A
// slower body stays over the segments that it touches. With 0 discs in bowls do the same, and bodies at rest
// pay for the search; with 1 a disc of 50 mm in a bowl of 63 mm segments gains energy again.
constexpr double kSegmentTravel = 0.25;

// 1 - the cosine up to which a normal is that of the segment, but for rounding.
template <class Real>
constexpr Real kOwnNormal = 16 * std::numeric_limits<Real>::epsilon();

// Returns the contact after a time, s, in which the bodies keep their velocities.
template <class Real>
SpeculativeContact<Real> contact_after(const WorldData<Real>& w, const ContactRecord& contact, Real time,
                                       Real margin) {
  SpeculativeContact<Real> at;
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  at.displacement = time * (b.velocity - a.velocity);
  at.delta_angle_a = time * a.angular_velocity, at.delta_angle_b = time * b.angular_velocity;
  at.a_to_b = centres_a_to_b(w, contact) + at.displacement;
  at.rotation = rotated_by(w.rotation[contact.body_a], at.delta_angle_a);
  const Rotation<Real> to_a = at.rotation.inverse(),
                       q = rotated_by(w.rotation[contact.body_b], at.delta_angle_b);
  const Pose<Real> b_in_a{to_a * at.a_to_b, {to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s}};
  at.manifold = collide_shapes(w, contact, b_in_a, margin, l1_norm(at.displacement));
  return at;
}

// Returns the contact at the middle of the step, without points if it does not last.
template <class Real>
SpeculativeContact<Real> lasting_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                         const ContactConstraint<Real>& c, Real dt) {
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Real half = Real(0.5) * dt,
             tolerance = Real(tuning::kRecycleDistance / tuning::kDepenetrationSpeed) * c.depenetration_speed;
  const Real along = half * dot(c.normal, b.velocity - a.velocity);
  bool lasts = false;
  Real deepest = 0;
  for (int i = 0; i < c.count; ++i) {
    deepest = std::min(deepest, c.current_separation[i]);
    if (c.current_separation[i] > tolerance) continue;
    const Real change = along + half * (c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity);
    if (std::abs(change) > tolerance) return {};
    lasts = true;
  }
  if (!lasts) return {};
  SpeculativeContact<Real> at = contact_at_middle(w, contact, half * (b.velocity - a.velocity), Real(0), dt);
  for (int i = 0; i < at.manifold.count; ++i)
    if (at.manifold.points[i].separation < deepest - tolerance) return {};
  return at;
}

// Returns true if shapes without a contact may touch at the middle of the step while sliding rather than
// approaching. Their distance along the present normal is a lower bound. Without points they are farther
// apart than their approach, unless the speculative margin is too small for it.
template <class Real>
bool may_arrive(const WorldData<Real>& w, const ContactRecord& contact, const ContactManifold<Real>& manifold,
                Real tolerance, Real dt) {
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Vec2<Real> displacement = Real(0.5) * dt * (b.velocity - a.velocity);
  const Real turned = Real(0.5) * dt *
                      (std::abs(a.angular_velocity) * w.extents[contact.body_a] +
                       std::abs(b.angular_velocity) * w.extents[contact.body_b]);
  if (manifold.count == 0)
    return l1_norm(displacement) + turned >
           Real(0.5 * tuning::kMaxSpeculativeApproach / tuning::kRecycleDistance) * tolerance;
  Real separation = manifold.points[0].separation;
  if (manifold.count == 2) separation = std::min(separation, manifold.points[1].separation);
  const Real along = dot(w.rotation[contact.body_a] * manifold.normal, displacement);
  return std::abs(along) <= tolerance + turned && separation <= tolerance + turned;
}

}  // namespace

template <class Real>
bool rebuild_lasting_contact(const WorldData<Real>& w, const ContactRecord& contact, Real dt,
                             ContactConstraint<Real>& c) {
  if (!enabled(Switch::LastingContacts)) return false;
  const SpeculativeContact<Real> lasting = lasting_contact(w, contact, c, dt);
  if (lasting.manifold.count == 0) return false;
  const Real deepest =
      std::min({c.current_separation[0], c.count == 2 ? c.current_separation[1] : Real(0), Real(0)});
  prepare_speculative_contact(w, contact, lasting, c, c.current_separation);
  // The bodies' common rotation curves their paths about each other.
  const Real common = common_rotation(w, contact, centres_a_to_b(w, contact), Real(0.5) * dt);
  const Real curve = Real(0.5) * common * common * dot(c.normal, lasting.a_to_b);
  for (int i = 0; i < c.count; ++i) c.separation[i] += curve;
  // Extrapolated back to the start, points deviate from their tangents. An overlap that may be this deviation
  // is not pushed out.
  const auto bend = [&](int body, int shape, Real turn) {
    return Real(0.5) * turn * turn * std::max(w.extents[body] - w.forms[shape].radius, Real(0));
  };
  const Real deviation = bend(contact.body_a, contact.shape_a, lasting.delta_angle_a) +
                         bend(contact.body_b, contact.shape_b, lasting.delta_angle_b);
  for (int i = 0; i < c.count; ++i)
    if (c.separation[i] < deepest) c.separation[i] = std::min(deepest, c.separation[i] + deviation);
  return true;
}

template <class Real>
bool rebuild_rotating_contact(const WorldData<Real>& w, const ContactRecord& contact,
                              const ContactManifold<Real>& manifold, Real dt, ContactConstraint<Real>& c) {
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Vec2<Real> a_to_b = centres_a_to_b(w, contact);
  const Real half = Real(0.5) * dt, turn = common_rotation(w, contact, a_to_b, half);
  if (turn == 0) return false;
  const Real tolerance = Real(tuning::kRecycleDistance / tuning::kDepenetrationSpeed) * c.depenetration_speed;
  const Vec2<Real> displacement = half * (b.velocity - a.velocity);
  // Velocities lie along the last step's contact plane: they lag by up to three half steps behind the middle
  // of this one.
  const Real explained = 3 * std::abs(turn) * l1_norm(displacement) + tolerance;
  const Rotation<Real> q = w.rotation[contact.body_a], turned = rotated_by(Rotation<Real>{1, 0}, turn);
  const Vec2<Real> before = q * manifold.normal, n = turned * before, t{n.y, -n.x};
  bool touches = false;
  for (int i = 0; i < manifold.count; ++i) {
    if (manifold.points[i].separation > tolerance) continue;
    const Vec2<Real> arm = q * manifold.points[i].point;
    const Real turning =
        half * (cross(arm - a_to_b, before) * b.angular_velocity - cross(arm, before) * a.angular_velocity);
    if (dot(n, displacement) + turning < -explained) return false;
    touches = true;
  }
  if (!touches) return false;
  // The contact lets the bodies slide, and keeps them from approaching.
  const Vec2<Real> chord = turned * a_to_b - a_to_b;
  const Real slip = dot(t, displacement - chord);
  // Arms that are off by `slip` let a body sink by 2 turn slip in a step.
  if (std::abs(turn * slip) > Real(0.25) * tolerance) {
    const SpeculativeContact<Real> at = contact_at_middle(w, contact, chord + slip * t, turn, dt);
    if (at.manifold.count > 0) {
      prepare_contact(w, contact, at.manifold, at.rotation, at.a_to_b, c, c.current_separation);
      return true;
    }
  }
  prepare_contact(w, contact, manifold, rotated_by(q, turn), turned * a_to_b, c, c.current_separation);
  return true;
}

template <class Real>
SpeculativeContact<Real> segment_ahead(const WorldData<Real>& w, const ContactRecord& contact,
                                       const ContactManifold<Real>& manifold, Real dt, Real h) {
  const ShapeForm<Real>&segment = w.forms[contact.shape_a], &mover = w.forms[contact.shape_b];
  if (!segment.chain || !enabled(Switch::SegmentsAhead)) return {};
  if (w.scratch.narrow_phase.has_contact_load[contact.body_a] == 0 &&
      w.scratch.narrow_phase.has_contact_load[contact.body_b] == 0)
    return {};
  const Real smaller = std::min(segment.extent, mover.extent);
  const Real tolerance =
      Real(tuning::kRecycleDistance) * smaller + rounding_overlap(w, contact.body_a, contact.body_b);
  for (int k = 0; k < manifold.count; ++k)
    if (!(manifold.points[k].separation > tolerance)) return {};
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  // A disc that turns about its centre carries no point along.
  const Real arm_b = std::max(w.extents[contact.body_b] - mover.radius, Real(0));
  const Vec2<Real> displacement = dt * (b.velocity - a.velocity);
  const Real turning =
      dt * (std::abs(a.angular_velocity) * w.extents[contact.body_a] + std::abs(b.angular_velocity) * arm_b);
  const Real travel = l1_norm(displacement) + turning;
  if (!(travel > Real(kSegmentTravel) * smaller)) return {};
  // However short a segment is, it is a part of a larger surface: the margin is that of the other shape.
  const Real margin = speculative_margin(a, b, mover.extent, mover.extent, dt);
  const Aabb<Real>&box = w.tight_aabbs[contact.shape_b], &of_segment = w.tight_aabbs[contact.shape_a];
  const Real rounding =
      4 * std::numeric_limits<Real>::epsilon() * (l1_norm(of_segment.lower) + l1_norm(of_segment.upper));
  const Aabb<Real> path = merged(box, {box.lower + displacement, box.upper + displacement});
  if (!path.grown(margin + turning + rounding).overlaps(of_segment)) return {};
  const Vec2<Real> own = w.convex(contact.shape_a).corners[0].normal;
  SpeculativeContact<Real> found;
  Real lowest = manifold.count > 0 ? tolerance : std::numeric_limits<Real>::max();
  const int substeps = static_cast<int>(std::round(dt / h));
  for (int i = 1; i <= substeps; ++i) {
    const SpeculativeContact<Real> at = contact_after(w, contact, static_cast<Real>(i) * h, margin);
    // Other normals are those of corners, and hold only where the corner is.
    if (!(dot(at.manifold.normal, own) > 1 - kOwnNormal<Real>)) continue;
    const Vec2<Real> n = at.rotation * at.manifold.normal;
    bool recedes = false;
    Real separation = std::numeric_limits<Real>::max();
    for (int k = 0; k < at.manifold.count; ++k) {
      const Vec2<Real> arm = at.rotation * at.manifold.points[k].point;
      const Real change = dot(n, at.displacement) + cross(arm - at.a_to_b, n) * at.delta_angle_b -
                          cross(arm, n) * at.delta_angle_a;
      recedes |= change > tolerance;
      separation = std::min(separation, at.manifold.points[k].separation);
    }
    // The body would be behind the plane of a segment from which it recedes, as beyond a hump.
    if (!recedes && separation < lowest) found = at, lowest = separation;
  }
  return found;
}

template <class Real>
SpeculativeContact<Real> arriving_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                          const ContactManifold<Real>& manifold, Real dt) {
  if (!enabled(Switch::LastingContacts)) return {};
  if (w.scratch.narrow_phase.has_contact_load[contact.body_a] == 0 &&
      w.scratch.narrow_phase.has_contact_load[contact.body_b] == 0)
    return {};
  const Real smaller = std::min(w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent);
  const Real tolerance = Real(tuning::kRecycleDistance) * smaller;
  if (!may_arrive(w, contact, manifold, tolerance, dt)) return {};
  const Vec2<Real> relative = w.motion[contact.body_b].velocity - w.motion[contact.body_a].velocity;
  SpeculativeContact<Real> at = contact_at_middle(w, contact, Real(0.5) * dt * relative, Real(0), dt);
  bool touches = false;
  const Vec2<Real> n = at.rotation * at.manifold.normal;
  for (int i = 0; i < at.manifold.count; ++i) {
    const ContactManifoldPoint<Real>& point = at.manifold.points[i];
    if (point.separation > tolerance) continue;
    const Vec2<Real> arm = at.rotation * point.point;
    const Real change = dot(n, at.displacement) + cross(arm - at.a_to_b, n) * at.delta_angle_b -
                        cross(arm, n) * at.delta_angle_a;
    if (std::abs(change) > tolerance || point.separation < -tolerance) return {};
    touches = true;
  }
  return touches ? at : SpeculativeContact<Real>{};
}

#define PLUMB_FOR(Real)                                                                                 \
  template bool rebuild_lasting_contact(const WorldData<Real>&, const ContactRecord&, Real,             \
                                        ContactConstraint<Real>&);                                      \
  template bool rebuild_rotating_contact(const WorldData<Real>&, const ContactRecord&,                  \
                                         const ContactManifold<Real>&, Real, ContactConstraint<Real>&); \
  template SpeculativeContact<Real> arriving_contact(const WorldData<Real>&, const ContactRecord&,      \
                                                     const ContactManifold<Real>&, Real);               \
  template SpeculativeContact<Real> segment_ahead(const WorldData<Real>&, const ContactRecord&,         \
                                                  const ContactManifold<Real>&, Real, Real);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
