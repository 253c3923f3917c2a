#include "engine/world/contact_solver/restitution_contacts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "engine/world/contact_solver/locked_axes.h"

namespace plumb {
namespace {

// Exchanges the contact's masses with the saved ones.
template <class Real>
void swap_masses(RestitutionContact<Real>& bounce) {
  ContactConstraint<Real>& c = *bounce.contact;
  std::swap(bounce.saved_masses[0], c.mass[0]), std::swap(bounce.saved_masses[1], c.mass[1]);
  std::swap(bounce.saved_masses[2], c.inverse_pp), std::swap(bounce.saved_masses[3], c.inverse_pq);
  std::swap(bounce.saved_masses[4], c.inverse_qq);
}

// Disables the contact: without masses it gives no impulses.
template <class Real>
void disable(RestitutionContact<Real>& bounce) {
  assert(!bounce.deferred || bounce.contact != nullptr);
  bounce.deferred = true;
  for (Real& mass : bounce.saved_masses) mass = 0;
  swap_masses(bounce);
}

// Updates the effective masses of two discs, whose normal has rotated: with a locked axis they depend on it.
template <class Real>
void update_masses(const SolverBody<Real>& a, const SolverBody<Real>& b, ContactConstraint<Real>& c) {
  const Real least =
      least_mobility(a, b, c.arm_tangent_a * c.arm_tangent_a, c.arm_tangent_b * c.arm_tangent_b);
  const auto mobility = [&](Vec2<Real> row, Real arm_a, Real arm_b) {
    const Real k = linear_response(a, b, c.locks, row, row, true) + a.inverse_inertia * arm_a * arm_a +
                   b.inverse_inertia * arm_b * arm_b;
    return k > least ? k : Real(0);
  };
  const Real k_n = mobility(c.normal, c.arm_a[0], c.arm_b[0]),
             k_t = mobility({c.normal.y, -c.normal.x}, c.arm_tangent_a, c.arm_tangent_b);
  c.mass[0] = c.inverse_pp = k_n > 0 ? 1 / (k_n + driver_compliance(a, b, c, ContactRow::Normal)) : Real(0);
  update_friction_row(a, b, k_n, k_t, c);
}

}  // namespace

template <class Real>
void update_circle_normal(const SolverBody<Real>* motion, RestitutionContact<Real>& bounce, Real h,
                          Real from) {
  ContactConstraint<Real>& c = *bounce.contact;
  if (bounce.radius_sum == 0 || c.normal_impulse[0] > 0) return;
  const SolverBody<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  const Vec2<Real> p = bounce.centre_offset + (b.delta_position - a.delta_position),
                   v = b.velocity - a.velocity;
  const Real vv = dot(v, v), pv = dot(p, v), open = dot(p, p) - bounce.radius_sum * bounce.radius_sum;
  Real t = from;
  if (open > 0 && pv < 0) {
    const Real d = pv * pv - vv * open;
    t = std::clamp(d > 0 ? open / (std::sqrt(d) - pv) : -pv / vv, from, h);
  }
  const Vec2<Real> contact_offset = p + t * v;
  const Real length = std::sqrt(dot(contact_offset, contact_offset));
  if (!(length > 0)) return;
  c.normal = (1 / length) * contact_offset;
  if (c.locks != 0) update_masses(a, b, c);
  c.separation[0] = dot(c.normal, bounce.centre_offset) - bounce.radius_sum;
  c.current_separation[0] = dot(c.normal, p) - bounce.radius_sum;
}

template <class Real>
bool record_approaches(const SolverBody<Real>* motion, std::span<RestitutionContact<Real>> bounces,
                       const ContactStep<Real>& step) {
  bool separated = false;
  for (RestitutionContact<Real>& bounce : bounces) {
    ContactConstraint<Real>& c = *bounce.contact;
    if (bounce.radius_sum != 0) update_circle_normal(motion, bounce, step.h, Real(0));
    bool separates = c.restitution > 0;
    for (int i = 0; i < c.count; ++i) {
      bounce.start_velocity[i] = velocity_along_normal(motion, c, i);
      separates = separates && bounce.start_velocity[i] > Real(0.5) * c.restitution * step.bounce_threshold;
    }
    if (!separates) continue;
    separated = separated || c.normal_impulse[0] > 0 || c.normal_impulse[1] > 0;
    c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
  }
  return separated;
}

template <class Real>
bool schedule_impacts(const SolverBody<Real>* motion, std::span<RestitutionContact<Real>> bounces,
                      const ContactStep<Real>& step) {
  const Real h = step.h;
  bool any = false;
  for (RestitutionContact<Real>& bounce : bounces) {
    ContactConstraint<Real>& c = *bounce.contact;
    bounce.impact_pending = false;
    bool touches = false;
    for (int i = 0; i < c.count; ++i) {
      const Real closing_speed = -velocity_along_normal(motion, c, i),
                 s = std::max(c.current_separation[i], Real(0));
      bounce.impact_pending = bounce.impact_pending || closing_speed > step.bounce_threshold;
      // Err on the side of "in time" (factor 0.999): the solved impulse decides in the end, and rounding must
      // not exclude an impact.
      const bool in_time = closing_speed * h > Real(0.999) * s;
      touches = touches || in_time;
      bounce.has_impact[i] = false;
      if (!in_time) continue;
      const Real u = -bounce.start_velocity[i], a = (closing_speed - u) * step.inverse_h;
      const Real impact_speed = std::sqrt(std::max(u * u + 2 * a * s, Real(0)));
      bounce.has_impact[i] = impact_speed > step.bounce_threshold;
      if (!bounce.has_impact[i]) continue;
      any = true;
      if (bounce.radius_sum > 0 && c.tracking != ImpactTracking::Off) record_approach(c, i, -impact_speed);
      const Real time_left =
          u + impact_speed > 0 ? std::max(h - 2 * s / (u + impact_speed), Real(0)) : Real(0);
      const Real rebound = effective_restitution(c) * impact_speed;
      bounce.end_speed[i] = std::max(rebound - a * time_left, Real(0));
    }
    bounce.impact_pending = bounce.impact_pending && !touches;
  }
  return any;
}

template <class Real>
void defer_impacts(std::span<RestitutionContact<Real>> bounces) {
  for (RestitutionContact<Real>& bounce : bounces) {
    const ContactConstraint<Real>& c = *bounce.contact;
    bounce.deferred = bounce.impact_pending && !bounce.has_impact[0] && !bounce.has_impact[1] &&
                      c.normal_impulse[0] == 0 && c.normal_impulse[1] == 0;
    if (bounce.deferred) disable(bounce);
  }
}

template <class Real>
void restore_deferred(std::span<RestitutionContact<Real>> bounces) {
  for (RestitutionContact<Real>& bounce : bounces) {
    if (!bounce.deferred) continue;
    bounce.deferred = false;
    swap_masses(bounce);
  }
}

#define PLUMB_FOR(Real)                                                                               \
  template void update_circle_normal(const SolverBody<Real>*, RestitutionContact<Real>&, Real, Real); \
  template bool record_approaches(const SolverBody<Real>*, std::span<RestitutionContact<Real>>,       \
                                  const ContactStep<Real>&);                                          \
  template bool schedule_impacts(const SolverBody<Real>*, std::span<RestitutionContact<Real>>,        \
                                 const ContactStep<Real>&);                                           \
  template void defer_impacts(std::span<RestitutionContact<Real>>);                                   \
  template void restore_deferred(std::span<RestitutionContact<Real>>);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
