#include "engine/world/step/speculative_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/distance/time_of_impact.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/internal_edges.h"
#include "engine/world/step/expected_impacts.h"
#include "engine/world/step/pushers.h"

namespace plumb {
namespace {

// Returns an upper bound of the speed of a body's points, m/s.
template <class Real>
Real max_point_speed(Vec2<Real> velocity, Real rotation_speed) {
  return std::abs(velocity.x) + std::abs(velocity.y) + rotation_speed;
}

// Returns an upper bound of the speed of a body's points relative to its centre of mass, m/s.
template <class Real>
Real rotation_speed(const WorldData<Real>& w, int body) {
  return std::abs(w.motion[body].angular_velocity) * w.extents[body];
}

// Returns true if continuous collision will treat the body as fast.
template <class Real>
bool is_fast(const WorldData<Real>& w, int body, Real dt) {
  return w.is_dynamic(body) && dt * max_point_speed(w.motion[body].velocity, rotation_speed(w, body)) >
                                   Real(tuning::kFastFraction) * w.bodies[body].half_width;
}

// Returns true if the body is in free flight, as far as this is known before the step is solved.
template <class Real>
bool is_unsupported(const WorldData<Real>& w, int body) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.type != BodyType::Dynamic || record.first_joint != kNone) return false;
  return w.scratch.narrow_phase.has_contact_load[body] == 0;
}

// Returns by how much dynamic bodies that press on one of two bodies may still push it off its predicted
// path, m: by no more than they move relative to it. Returns infinity if such bodies press on both: in a
// crowd, what drives two bodies together hands on more pushes in the step than their velocities show.
template <class Real>
Real push_of_neighbours(const WorldData<Real>& w, int a, int b, Real dt) {
  const bool pushed_a = is_pressed_by_third(w, a, b), pushed_b = is_pressed_by_third(w, b, a);
  if (pushed_a && pushed_b) return std::numeric_limits<Real>::infinity();
  if (!pushed_a && !pushed_b) return 0;
  const int body = pushed_a ? a : b, partner = pushed_a ? b : a;
  const auto speed_of = [&](int pusher) {
    return max_point_speed(w.motion[pusher].velocity - w.motion[body].velocity,
                           rotation_speed(w, pusher) + rotation_speed(w, body));
  };
  if (const int only = w.scratch.narrow_phase.pushers[body]; only != kSeveralPushers)
    return dt * speed_of(only);
  Real fastest = 0;
  any_pusher(w, body, [&](int other) {
    if (other != partner) fastest = std::max(fastest, speed_of(other));
    return false;
  });
  return dt * fastest;
}

// Returns the body's motion in the step, relative to `origin`.
template <class Real>
Sweep<double> sweep_of(const WorldData<Real>& w, int body, Vec2d origin, double dt) {
  const SolverBody<Real>& motion = w.motion[body];
  const Rotation<Real> q = w.rotation[body];
  const Vec2d curve = is_unsupported(w, body) ? (0.5 * dt * dt) * free_acceleration(w, body) : Vec2d{};
  return {w.position[body] - origin, dt * motion.velocity.template as<double>(),
          Rotation<double>{static_cast<double>(q.c), static_cast<double>(q.s)},
          dt * static_cast<double>(motion.angular_velocity), curve};
}

// Returns true if the bodies' relative displacement and rotations may carry a point across its contact plane.
// A point that nearly touches must cross the plane by more than a recycled manifold tolerates; otherwise it
// rests.
template <class Real>
bool may_cross_plane(const WorldData<Real>& w, const ContactRecord& contact,
                     const ContactManifold<Real>& manifold, Vec2<Real> displacement, Real angle_a,
                     Real angle_b, Real smaller) {
  const Real tolerance = Real(tuning::kRecycleDistance) * smaller;
  const Rotation<Real> q = w.rotation[contact.body_a];
  const Vec2<Real> n = q * manifold.normal;
  const Vec2<Real> a_to_b = (w.position[contact.body_b] - w.position[contact.body_a]).template as<Real>();
  // Bound of the distance of a rotating point from its tangent.
  const Real tangent_deviation = Real(0.5) * (angle_a * angle_a * w.extents[contact.body_a] +
                                              angle_b * angle_b * w.extents[contact.body_b]);
  // Manifolds omit points beyond the speculative margin, which is limited. With larger displacements any
  // point of the shape may come first.
  const Real rotation_distance =
      std::abs(angle_a) * w.extents[contact.body_a] + std::abs(angle_b) * w.extents[contact.body_b];
  const bool any_point = std::abs(displacement.x) + std::abs(displacement.y) + rotation_distance >
                         Real(tuning::kMaxSpeculativeApproach) * smaller;
  for (int i = 0; i < manifold.count; ++i) {
    const Vec2<Real> arm = q * manifold.points[i].point;
    const Real separation = manifold.points[i].separation;
    const Real rotational =
        any_point ? -rotation_distance : cross(arm - a_to_b, n) * angle_b - cross(arm, n) * angle_a;
    const Real end = separation + dot(n, displacement) + rotational;
    if (end < (separation > tolerance ? tangent_deviation : -tolerance)) return true;
  }
  return false;
}

// Returns true if shapes without contact points must be searched for an impact.
template <class Real>
bool needs_impact_search(const WorldData<Real>& w, const ContactRecord& contact, Real smaller, Real dt) {
  const int a = contact.body_a, b = contact.body_b;
  const Real approach = dt * max_point_speed(w.motion[b].velocity - w.motion[a].velocity,
                                             rotation_speed(w, a) + rotation_speed(w, b));
  const Real max_predicted = Real(tuning::kMaxSpeculativeApproach) * smaller;
  if (!(approach > max_predicted) || w.forms[contact.shape_a].chain) return false;
  if (!w.tight_aabbs[contact.shape_a].grown(approach).overlaps(w.tight_aabbs[contact.shape_b])) return false;
  if (is_fast(w, a, dt) || is_fast(w, b, dt)) return false;
  // Two bodies of similar size, neither of them fast, approach by no more than twice `max_predicted`.
  return approach > 2 * max_predicted || restitution_between(w, contact.shape_a, contact.shape_b) > 0 ||
         (is_unsupported(w, a) && is_unsupported(w, b) && are_alone(w, a, b, dt));
}

// Returns the speculative contact at a fraction of the step.
template <class Real>
SpeculativeContact<Real> speculative_contact_at(const WorldData<Real>& w, const ContactRecord& contact,
                                                const Sweep<double>& sweep_a, const Sweep<double>& sweep_b,
                                                double fraction, Real smaller, double dt) {
  const Pose<double> at_a = pose_at(sweep_a, fraction), at_b = pose_at(sweep_b, fraction);
  const Rotation<double> to_a = at_a.rotation.inverse(), q = at_b.rotation;
  const Vec2d a_to_b = at_b.position - at_a.position;
  const auto rounded = [](const Rotation<double>& r) {
    return Rotation<Real>{static_cast<Real>(r.c), static_cast<Real>(r.s)};
  };
  const Pose<Real> b_in_a{(to_a * a_to_b).template as<Real>(),
                          rounded({to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s})};
  SpeculativeContact<Real> at;
  const auto moved = [](const Sweep<double>& sweep) {
    return std::abs(sweep.motion.x) + std::abs(sweep.motion.y) + std::abs(sweep.curve.x) +
           std::abs(sweep.curve.y);
  };
  at.manifold = collide_shapes(w, contact, b_in_a, Real(tuning::kSpeculativeMargin) * smaller,
                               static_cast<Real>(moved(sweep_a) + moved(sweep_b)));
  if (at.manifold.count == 0) return at;
  // Shapes that only just touch have no overlaps: points with overlaps belong to a surface that other shapes
  // continue.
  for (int i = 0; i < at.manifold.count; ++i)
    if (at.manifold.points[i].separation < -Real(tuning::kImpactTolerance) * smaller) return {};
  at.prediction = ImpactPrediction::Hit;
  at.rotation = rounded(at_a.rotation);
  at.a_to_b = a_to_b.template as<Real>();
  at.displacement = (a_to_b - (sweep_b.start - sweep_a.start)).template as<Real>();
  at.delta_angle_a = static_cast<Real>(fraction * sweep_a.delta_angle),
  at.delta_angle_b = static_cast<Real>(fraction * sweep_b.delta_angle);
  const auto velocity = [&](const Sweep<double>& sweep) {
    return sweep.motion + (2 * fraction) * sweep.curve;
  };
  at.velocity = ((1 / dt) * (velocity(sweep_b) - velocity(sweep_a))).template as<Real>();
  return at;
}

}  // namespace

template <class Real>
SpeculativeContact<Real> find_speculative_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                                  const ContactManifold<Real>& closest, bool pressed, Real dt,
                                                  Real substep) {
  const int a = contact.body_a, b = contact.body_b;
  const Real smaller = std::min(w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent);
  if (closest.count == 0 && !needs_impact_search(w, contact, smaller, dt)) return {};
  for (int i = 0; i < closest.count; ++i)
    if (!(closest.points[i].separation > -rounding_overlap(w, a, b))) return {};
  // Joints and other contacts may change the paths of such bodies after an impact: the solver resolves it.
  const bool held = closest.count > 0 && w.is_dynamic(a) && w.is_dynamic(b) &&
                    !(is_unsupported(w, a) && is_unsupported(w, b));
  if (held && pressed) return {};
  const double time = static_cast<double>(dt);
  const Sweep<double> sweep_a = sweep_of(w, a, w.position[a], time),
                      sweep_b = sweep_of(w, b, w.position[a], time);
  if (closest.count > 0) {
    const double ahead = 1 + static_cast<double>(substep) / time;
    const auto displacement = [&](const Sweep<double>& sweep) {
      return ahead * (sweep.motion + ahead * sweep.curve);
    };
    if (!may_cross_plane(w, contact, closest,
                         (displacement(sweep_b) - displacement(sweep_a)).template as<Real>(),
                         static_cast<Real>(ahead * sweep_a.delta_angle),
                         static_cast<Real>(ahead * sweep_b.delta_angle), smaller))
      return {};
  }
  Real may_be_pushed = 0;
  if (held) {
    may_be_pushed = push_of_neighbours(w, a, b, dt);
    for (int i = 0; i < closest.count; ++i)
      if (closest.points[i].separation < may_be_pushed) return {};
  }
  // Search to rounding: with a coarser tolerance, a shape that passes at a smaller distance would count as
  // hit.
  const ImpactResult<Real> impact = time_of_impact(
      w.convex(contact.shape_a), sweep_a, w.convex(contact.shape_b), sweep_b, may_be_pushed, Real(0));
  if (impact.state == ImpactResult<Real>::State::Separated) return {.prediction = ImpactPrediction::Miss};
  if (impact.state != ImpactResult<Real>::State::Hit || held) return {};
  return speculative_contact_at(w, contact, sweep_a, sweep_b, impact.exact_fraction, smaller, time);
}

template <class Real>
void prepare_speculative_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                 const SpeculativeContact<Real>& at, ContactConstraint<Real>& c,
                                 Real (&impulse)[2]) {
  prepare_contact(w, contact, at.manifold, at.rotation, at.a_to_b, c, impulse);
  const Real along_normal = dot(c.normal, at.displacement);
  for (int i = 0; i < c.count; ++i)
    c.separation[i] -= along_normal + (c.arm_b[i] * at.delta_angle_b - c.arm_a[i] * at.delta_angle_a);
}

template <class Real>
void prepare_impact_contact(const WorldData<Real>& w, const ContactRecord& contact,
                            const SpeculativeContact<Real>& at, ContactConstraint<Real>& c,
                            Real (&impulse)[2]) {
  prepare_speculative_contact(w, contact, at, c, impulse);
  for (int i = 0; i < c.count; ++i) c.separation[i] = std::max(c.separation[i], Real(0));
}

#define PLUMB_FOR(Real)                                                                                \
  template SpeculativeContact<Real> find_speculative_contact(                                          \
      const WorldData<Real>&, const ContactRecord&, const ContactManifold<Real>&, bool, Real, Real);   \
  template void prepare_speculative_contact(const WorldData<Real>&, const ContactRecord&,              \
                                            const SpeculativeContact<Real>&, ContactConstraint<Real>&, \
                                            Real(&)[2]);                                               \
  template void prepare_impact_contact(const WorldData<Real>&, const ContactRecord&,                   \
                                       const SpeculativeContact<Real>&, ContactConstraint<Real>&,      \
                                       Real(&)[2]);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
