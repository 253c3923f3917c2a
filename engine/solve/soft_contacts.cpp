#include "engine/solve/soft_contacts.h"

#include <algorithm>

namespace plumb {
namespace {

// The velocities of a constraint's two bodies, held in registers through a pass and written back once.
template <class Real>
struct Pair {
  Pair(BodyMotion<Real>* motion, const ContactConstraint<Real>& c)
      : a(motion[c.body_a]),
        b(motion[c.body_b]),
        n(c.normal),
        va(a.velocity),
        vb(b.velocity),
        wa(a.angular_velocity),
        wb(b.angular_velocity),
        ma(a.inverse_mass),
        mb(b.inverse_mass),
        ia(a.inverse_inertia),
        ib(b.inverse_inertia) {}

  Real along_normal(const ContactPoint<Real>& p) const {
    return dot(n, vb - va) + p.arm_normal_b * wb - p.arm_normal_a * wa;
  }
  Real along_tangent(const ContactPoint<Real>& p) const {
    return dot(Vec2<Real>{n.y, -n.x}, vb - va) + p.arm_tangent_b * wb - p.arm_tangent_a * wa;
  }
  void push(const ContactPoint<Real>& p, Real impulse) {
    va -= (ma * impulse) * n;
    vb += (mb * impulse) * n;
    wa -= ia * impulse * p.arm_normal_a;
    wb += ib * impulse * p.arm_normal_b;
  }
  void rub(const ContactPoint<Real>& p, Real impulse) {
    const Vec2<Real> t{n.y, -n.x};
    va -= (ma * impulse) * t;
    vb += (mb * impulse) * t;
    wa -= ia * impulse * p.arm_tangent_a;
    wb += ib * impulse * p.arm_tangent_b;
  }
  void store() {
    a.velocity = va, a.angular_velocity = wa;
    b.velocity = vb, b.angular_velocity = wb;
  }

  BodyMotion<Real>&a, &b;
  Vec2<Real> n, va, vb;
  Real wa, wb, ma, mb, ia, ib;
};

// lambda >= 0 with v_n + bias = 0, softened: lambda' = lambda - m k (v_n + bias) - s lambda.
template <class Real>
Real press(ContactPoint<Real>& p, Real speed, Real mass_scale, Real impulse_scale) {
  const Real before = p.normal_impulse;
  const Real wanted = before - p.normal_mass * mass_scale * speed - impulse_scale * before;
  p.normal_impulse = std::max(wanted, Real(0));
  p.peak_impulse = std::max(p.peak_impulse, p.normal_impulse);
  return p.normal_impulse - before;
}

// How far the bodies have come along the normal at a point since the step's start, to first order.
template <class Real>
Real separation_now(const Pair<Real>& pair, const ContactPoint<Real>& p, Real closed) {
  return p.separation + closed + p.arm_normal_b * pair.b.turned - p.arm_normal_a * pair.a.turned;
}

// What is asked of one point: v_n + bias = 0, yielding by `give` (of the effective mass) to the impulse.
template <class Real>
struct Demand {
  Real bias = 0, give = 0;
};

template <class Real>
void set_impulse(ContactPoint<Real>& p, Real impulse) {
  p.normal_impulse = impulse;
  p.peak_impulse = std::max(p.peak_impulse, impulse);
}

// Two points at once: (K + G) d = -(v + bias) - G lambda, lambda + d >= 0, for the four cases of which points
// press. The points of one contact pull at each other through the body's turning; one after the other they
// would need several sweeps.
template <class Real>
void press_both(Pair<Real>& pair, ContactConstraint<Real>& c, const Demand<Real>* demand) {
  ContactPoint<Real>&p = c.points[0], &q = c.points[1];
  const Real kp = 1 / p.normal_mass, kq = 1 / q.normal_mass;
  const Real between = pair.ma + pair.mb + pair.ia * p.arm_normal_a * q.arm_normal_a +
                       pair.ib * p.arm_normal_b * q.arm_normal_b;
  const Real gp = demand[0].give * kp, gq = demand[1].give * kq;
  const Real before_p = p.normal_impulse, before_q = q.normal_impulse;
  // Residuals with both impulses taken away, so that the unknowns are the impulses themselves.
  const Real rp = pair.along_normal(p) + demand[0].bias - kp * before_p - between * before_q;
  const Real rq = pair.along_normal(q) + demand[1].bias - between * before_p - kq * before_q;
  const Real dp = kp + gp, dq = kq + gq;
  const Real determinant = dp * dq - between * between;
  Real lp = (between * rq - dq * rp), lq = (between * rp - dp * rq);  // times the determinant
  if (lp >= 0 && lq >= 0 && determinant > Real(1e-3) * dp * dq) {
    const Real inverse = 1 / determinant;
    lp *= inverse, lq *= inverse;
  } else if (rp < 0 && rq * dp - between * rp >= 0) {
    lp = -rp / dp, lq = 0;
  } else if (rq < 0 && rp * dq - between * rq >= 0) {
    lp = 0, lq = -rq / dq;
  } else if (rp >= 0 && rq >= 0) {
    lp = lq = 0;
  } else {
    lp = std::max(-rp / dp, Real(0));
    lq = std::max(-(rq + between * lp) / dq, Real(0));
  }
  pair.push(p, lp - before_p);
  pair.push(q, lq - before_q);
  set_impulse(p, lp), set_impulse(q, lq);
}

template <class Real>
void solve_one(BodyMotion<Real>* motion, ContactConstraint<Real>& c, const ContactStep<Real>& step) {
  const Softness<Real>& soft = step.softness[static_cast<int>(c.hardness)];
  Pair<Real> pair(motion, c);
  const Real closed = dot(pair.n, pair.b.moved - pair.a.moved);
  if (c.count == 2) {
    Demand<Real> demand[2];
    for (int i = 0; i < 2; ++i) {
      const Real s = separation_now(pair, c.points[i], closed);
      demand[i] = s > 0 ? Demand<Real>{s * step.inverse_h, 0}
                        : Demand<Real>{std::max(soft.bias_rate * s, -c.push_speed),
                                       soft.impulse_scale / soft.mass_scale};
    }
    press_both(pair, c, demand);
    pair.store();
    return;
  }
  for (int i = 0; i < c.count; ++i) {
    ContactPoint<Real>& p = c.points[i];
    const Real s = separation_now(pair, p, closed);
    const Real v = pair.along_normal(p);
    const Real impulse = s > 0 ? press(p, v + s * step.inverse_h, Real(1), Real(0))
                               : press(p, v + std::max(soft.bias_rate * s, -c.push_speed), soft.mass_scale,
                                       soft.impulse_scale);
    pair.push(p, impulse);
  }
  pair.store();
}

template <class Real>
void relax_one(BodyMotion<Real>* motion, ContactConstraint<Real>& c, const ContactStep<Real>& step) {
  Pair<Real> pair(motion, c);
  const Real closed = dot(pair.n, pair.b.moved - pair.a.moved);
  Real pressure = 0;
  if (c.count == 2) {
    Demand<Real> demand[2];
    for (int i = 0; i < 2; ++i) {
      demand[i].bias = std::max(separation_now(pair, c.points[i], closed), Real(0)) * step.inverse_h;
    }
    press_both(pair, c, demand);
    pressure = c.points[0].normal_impulse + c.points[1].normal_impulse;
  } else
    for (int i = 0; i < c.count; ++i) {
      ContactPoint<Real>& p = c.points[i];
      const Real s = separation_now(pair, p, closed);
      const Real gap_speed = std::max(s, Real(0)) * step.inverse_h;
      pair.push(p, press(p, pair.along_normal(p) + gap_speed, Real(1), Real(0)));
      pressure += p.normal_impulse;
    }
  // Coulomb: |lambda_t| <= mu lambda_n.
  for (int i = 0; i < c.count; ++i) {
    ContactPoint<Real>& p = c.points[i];
    const Real before = p.tangent_impulse, most = c.friction * p.normal_impulse;
    const Real wanted = before - p.tangent_mass * (pair.along_tangent(p) - c.surface_speed);
    p.tangent_impulse = std::clamp(wanted, -most, most);
    pair.rub(p, p.tangent_impulse - before);
  }
  if (c.rolling_arm > 0) {
    const Real spin_mass = pair.ia + pair.ib > 0 ? 1 / (pair.ia + pair.ib) : 0;
    const Real before = c.rolling_impulse, most = c.rolling_arm * pressure;
    c.rolling_impulse = std::clamp(before - spin_mass * (pair.wb - pair.wa), -most, most);
    pair.wa -= pair.ia * (c.rolling_impulse - before);
    pair.wb += pair.ib * (c.rolling_impulse - before);
  }
  pair.store();
}

}  // namespace

template <class Real>
void warm_start_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step) {
  const Real ratio = step.warm_start;
  graph.for_each([&](ContactConstraint<Real>& c) {
    Pair<Real> pair(motion, c);
    for (int i = 0; i < c.count; ++i) {
      ContactPoint<Real>& p = c.points[i];
      p.normal_impulse *= ratio;
      p.tangent_impulse *= ratio;
      pair.push(p, p.normal_impulse);
      pair.rub(p, p.tangent_impulse);
    }
    if (c.rolling_arm > 0) {
      c.rolling_impulse *= ratio;
      pair.wa -= pair.ia * c.rolling_impulse;
      pair.wb += pair.ib * c.rolling_impulse;
    }
    pair.store();
  });
}

template <class Real>
void solve_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) { solve_one(motion, c, step); });
}

template <class Real>
void relax_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) { relax_one(motion, c, step); });
}

template <class Real>
void apply_restitution(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    if (c.restitution == 0) return;
    Pair<Real> pair(motion, c);
    for (int i = 0; i < c.count; ++i) {
      ContactPoint<Real>& p = c.points[i];
      if (p.approach > -step.bounce_threshold || p.peak_impulse == 0) continue;
      pair.push(p, press(p, pair.along_normal(p) + c.restitution * p.approach, Real(1), Real(0)));
    }
    pair.store();
  });
}

#define PLUMB_FOR(Real)                                                                                \
  template void warm_start_contacts(BodyMotion<Real>*, ContactGraph<Real>&, const ContactStep<Real>&); \
  template void solve_contacts(BodyMotion<Real>*, ContactGraph<Real>&, const ContactStep<Real>&);      \
  template void relax_contacts(BodyMotion<Real>*, ContactGraph<Real>&, const ContactStep<Real>&);      \
  template void apply_restitution(BodyMotion<Real>*, ContactGraph<Real>&, const ContactStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
