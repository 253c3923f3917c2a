#include "engine/world/contact_solver/restitution_contacts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "engine/world/contact_solver/locked_axes.h"

namespace plumb {
namespace {

// Exchanges the contact's masses with the stored ones.
template <class Real>
void swap_masses(RestitutionContact<Real>& bounce) {
  ContactConstraint<Real>& c = *bounce.contact;
  std::swap(bounce.masses[0], c.mass[0]), std::swap(bounce.masses[1], c.mass[1]);
  std::swap(bounce.masses[2], c.inverse_pp), std::swap(bounce.masses[3], c.inverse_pq);
  std::swap(bounce.masses[4], c.inverse_qq);
}

// Disables the contact: without masses it gives no impulses.
template <class Real>
void let_through(RestitutionContact<Real>& bounce) {
  assert(!bounce.passes || bounce.contact != nullptr);
  bounce.passes = true;
  for (Real& mass : bounce.masses) mass = 0;
  swap_masses(bounce);
}

// Updates the effective masses of two discs, whose normal has turned: with a locked axis they depend on it.
template <class Real>
void update_masses(const SolverBody<Real>& a, const SolverBody<Real>& b, ContactConstraint<Real>& c) {
  const auto mass = [&](Vec2<Real> row, Real arm_a, Real arm_b) {
    const Real inverse = linear_response(a, b, c.locks, row, row, true) + a.inverse_inertia * arm_a * arm_a +
                         b.inverse_inertia * arm_b * arm_b;
    return inverse > 0 ? 1 / inverse : Real(0);
  };
  c.mass[0] = c.inverse_pp = mass(c.normal, c.arm_a[0], c.arm_b[0]);
  c.tangent_mass = mass({c.normal.y, -c.normal.x}, c.arm_tangent_a, c.arm_tangent_b);
}

}  // namespace

template <class Real>
void face(const SolverBody<Real>* motion, RestitutionContact<Real>& bounce, Real h, Real from) {
  ContactConstraint<Real>& c = *bounce.contact;
  if (bounce.radii == 0 || c.normal_impulse[0] > 0) return;
  const SolverBody<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  const Vec2<Real> p = bounce.between + (b.delta_position - a.delta_position), v = b.velocity - a.velocity;
  const Real vv = dot(v, v), pv = dot(p, v), open = dot(p, p) - bounce.radii * bounce.radii;
  Real t = from;
  if (open > 0 && pv < 0) {
    const Real d = pv * pv - vv * open;
    t = std::clamp(d > 0 ? open / (std::sqrt(d) - pv) : -pv / vv, from, h);
  }
  const Vec2<Real> there = p + t * v;
  const Real length = std::sqrt(dot(there, there));
  if (!(length > 0)) return;
  c.normal = (1 / length) * there;
  if (c.locks != 0) update_masses(a, b, c);
  c.separation[0] = dot(c.normal, bounce.between) - bounce.radii;
  c.now[0] = dot(c.normal, p) - bounce.radii;
}

template <class Real>
bool note_approaches(const SolverBody<Real>* motion, std::span<RestitutionContact<Real>> bounces,
                     const ContactStep<Real>& step) {
  bool parted = false;
  for (RestitutionContact<Real>& bounce : bounces) {
    ContactConstraint<Real>& c = *bounce.contact;
    if (bounce.radii != 0) face(motion, bounce, step.h, Real(0));
    bool parts = c.restitution > 0;
    for (int i = 0; i < c.count; ++i) {
      bounce.before[i] = velocity_along_normal(motion, c, i);
      parts = parts && bounce.before[i] > Real(0.5) * c.restitution * step.bounce_threshold;
    }
    if (!parts) continue;
    parted = parted || c.normal_impulse[0] > 0 || c.normal_impulse[1] > 0;
    c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
  }
  return parted;
}

template <class Real>
bool schedule_impacts(const SolverBody<Real>* motion, std::span<RestitutionContact<Real>> bounces,
                      const ContactStep<Real>& step) {
  const Real h = step.h;
  bool any = false;
  for (RestitutionContact<Real>& bounce : bounces) {
    ContactConstraint<Real>& c = *bounce.contact;
    bounce.closes = false;
    bool arrives = false;
    for (int i = 0; i < c.count; ++i) {
      const Real closing = -velocity_along_normal(motion, c, i), s = std::max(c.now[i], Real(0));
      bounce.closes = bounce.closes || closing > step.bounce_threshold;
      // Err on the side of "in time" (factor 0.999): the solved impulse decides in the end, and rounding must
      // not exclude an impact.
      const bool in_time = closing * h > Real(0.999) * s;
      arrives = arrives || in_time;
      bounce.strikes[i] = false;
      if (!in_time) continue;
      const Real u = -bounce.before[i], a = (closing - u) * step.inverse_h;
      const Real strike = std::sqrt(std::max(u * u + 2 * a * s, Real(0)));
      bounce.strikes[i] = strike > step.bounce_threshold;
      if (!bounce.strikes[i]) continue;
      any = true;
      if (bounce.radii > 0 && c.watched != Watch::Off) note_approach(c, i, -strike);
      const Real left = u + strike > 0 ? std::max(h - 2 * s / (u + strike), Real(0)) : Real(0);
      const Real rebound = c.restitution * strike;
      bounce.speed[i] = std::max(rebound - a * left, Real(0));
    }
    bounce.closes = bounce.closes && !arrives;
  }
  return any;
}

template <class Real>
void let_pass(std::span<RestitutionContact<Real>> bounces) {
  for (RestitutionContact<Real>& bounce : bounces) {
    const ContactConstraint<Real>& c = *bounce.contact;
    bounce.passes = bounce.closes && !bounce.strikes[0] && !bounce.strikes[1] && c.normal_impulse[0] == 0 &&
                    c.normal_impulse[1] == 0;
    if (bounce.passes) let_through(bounce);
  }
}

template <class Real>
void hold_again(std::span<RestitutionContact<Real>> bounces) {
  for (RestitutionContact<Real>& bounce : bounces) {
    if (!bounce.passes) continue;
    bounce.passes = false;
    swap_masses(bounce);
  }
}

#define PLUMB_FOR(Real)                                                                        \
  template void face(const SolverBody<Real>*, RestitutionContact<Real>&, Real, Real);          \
  template bool note_approaches(const SolverBody<Real>*, std::span<RestitutionContact<Real>>,  \
                                const ContactStep<Real>&);                                     \
  template bool schedule_impacts(const SolverBody<Real>*, std::span<RestitutionContact<Real>>, \
                                 const ContactStep<Real>&);                                    \
  template void let_pass(std::span<RestitutionContact<Real>>);                                 \
  template void hold_again(std::span<RestitutionContact<Real>>);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
