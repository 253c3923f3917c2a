#pragma once

#include <algorithm>

#include "engine/world/contact_solver/body_motion.h"
#include "engine/world/contact_solver/contact_constraint.h"

/// Building blocks of the passes over contacts. They are inlined into each pass, which costs little more than
/// the latency of its few operations.
namespace plumb {

/// The two bodies of a constraint, held in registers through a pass. Their velocities are written back once.
template <class Real>
struct Pair {
  Pair(BodyMotion<Real>* motion, const ContactConstraint<Real>& c)
      : a(motion[c.body_a]),
        b(motion[c.body_b]),
        n(c.normal),
        va(a.velocity),
        vb(b.velocity),
        wa(a.angular_velocity),
        wb(b.angular_velocity) {}

  Real along_normal() const { return dot(n, vb - va); }
  Real along_tangent(const ContactConstraint<Real>& c) const {
    return dot(Vec2<Real>{n.y, -n.x}, vb - va) + (c.arm_tangent_b * wb - c.arm_tangent_a * wa);
  }
  void push(Real impulse, Real angular_a, Real angular_b) {
    va -= (a.inverse_mass * impulse) * n;
    vb += (b.inverse_mass * impulse) * n;
    wa -= a.inverse_inertia * angular_a;
    wb += b.inverse_inertia * angular_b;
  }
  void rub(const ContactConstraint<Real>& c, Real impulse) {
    const Vec2<Real> t{n.y, -n.x};
    va -= (a.inverse_mass * impulse) * t;
    vb += (b.inverse_mass * impulse) * t;
    wa -= a.inverse_inertia * (impulse * c.arm_tangent_a);
    wb += b.inverse_inertia * (impulse * c.arm_tangent_b);
  }
  void roll(Real impulse) {
    wa -= a.inverse_inertia * impulse;
    wb += b.inverse_inertia * impulse;
  }
  void store() {
    a.velocity = va, a.angular_velocity = wa;
    b.velocity = vb, b.angular_velocity = wb;
  }

  BodyMotion<Real>&a, &b;
  Vec2<Real> n, va, vb;
  Real wa, wb;
};

/// Bias and softness of a point: v_n + bias = 0, softened.
template <class Real>
struct Demand {
  Real bias = 0, mass_scale = 1, impulse_scale = 0;
};

/// Solves lambda >= 0 with v_n + bias = 0 at both points together, softened around the expected impulse
/// lambda_0: d = -mass_scale K^-1 (v + bias) - impulse_scale (lambda - lambda_0). The points are coupled by
/// the bodies' rotation; solved one after the other they would need several iterations. A point that would
/// have to pull gets no impulse, and the other one is solved alone.
template <class Real>
[[gnu::always_inline]] inline void press(Pair<Real>& pair, ContactConstraint<Real>& c,
                                         const Demand<Real>& at_p, const Demand<Real>& at_q) {
  const Real v = pair.along_normal();
  const Real p = c.normal_impulse[0], q = c.normal_impulse[1];
  const Real rate_p = v + (c.arm_b[0] * pair.wb - c.arm_a[0] * pair.wa + at_p.bias);
  const Real rate_q = v + (c.arm_b[1] * pair.wb - c.arm_a[1] * pair.wa + at_q.bias);
  Real new_p = (p - at_p.impulse_scale * (p - c.expected_impulse[0])) -
               at_p.mass_scale * (c.inverse_pp * rate_p + c.inverse_pq * rate_q);
  Real new_q = (q - at_q.impulse_scale * (q - c.expected_impulse[1])) -
               at_q.mass_scale * (c.inverse_pq * rate_p + c.inverse_qq * rate_q);
  // A gap is not softened. Next to a point that is, its impulse follows from the other's: so it closes.
  if (at_p.impulse_scale != at_q.impulse_scale) [[unlikely]] {
    if (at_q.impulse_scale == 0) {
      new_q = q - c.mass[1] * (rate_q + c.between * (new_p - p));
    } else {
      new_p = p - c.mass[0] * (rate_p + c.between * (new_q - q));
    }
  }
  if (std::min(new_p, new_q) < 0) {
    const auto alone = [&](const Demand<Real>& at, int i, Real rate, Real impulse) {
      const Real yield = at.impulse_scale * (impulse - c.expected_impulse[i]);
      return std::max((impulse - yield) - at.mass_scale * c.mass[i] * rate, Real(0));
    };
    if (new_p < new_q) {
      new_p = 0;
      new_q = alone(at_q, 1, rate_q - c.between * p, q);
    } else {
      new_q = 0;
      new_p = alone(at_p, 0, rate_p - c.between * q, p);
    }
  }
  c.normal_impulse[0] = new_p, c.normal_impulse[1] = new_q;
  const Real dp = new_p - p, dq = new_q - q;
  pair.push(dp + dq, c.arm_a[0] * dp + c.arm_a[1] * dq, c.arm_b[0] * dp + c.arm_b[1] * dq);
}

template <class Real>
[[gnu::always_inline]] inline void press_one(Pair<Real>& pair, ContactConstraint<Real>& c,
                                             const Demand<Real>& at) {
  const Real p = c.normal_impulse[0];
  const Real rate = pair.along_normal() + (c.arm_b[0] * pair.wb - c.arm_a[0] * pair.wa + at.bias);
  const Real yield = at.impulse_scale * (p - c.expected_impulse[0]);
  const Real new_p = std::max((p - yield) - at.mass_scale * c.mass[0] * rate, Real(0));
  c.normal_impulse[0] = new_p;
  const Real d = new_p - p;
  pair.push(d, c.arm_a[0] * d, c.arm_b[0] * d);
}

/// Records the largest impulses of a step.
template <class Real>
void note_peaks(ContactConstraint<Real>& c) {
  for (int i = 0; i < 2; ++i) c.peak_impulse[i] = std::max(c.peak_impulse[i], c.normal_impulse[i]);
}

}  // namespace plumb
