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

  Real along_normal() const { return dot(n, vb - va); }
  Real along_tangent(const ContactConstraint<Real>& c) const {
    return dot(Vec2<Real>{n.y, -n.x}, vb - va) + c.arm_tangent_b * wb - c.arm_tangent_a * wa;
  }
  void push(Real impulse, Real angular_a, Real angular_b) {
    va -= (ma * impulse) * n;
    vb += (mb * impulse) * n;
    wa -= ia * angular_a;
    wb += ib * angular_b;
  }
  void rub(const ContactConstraint<Real>& c, Real impulse) {
    const Vec2<Real> t{n.y, -n.x};
    va -= (ma * impulse) * t;
    vb += (mb * impulse) * t;
    wa -= ia * impulse * c.arm_tangent_a;
    wb += ib * impulse * c.arm_tangent_b;
  }
  void roll(Real impulse) {
    wa -= ia * impulse;
    wb += ib * impulse;
  }
  void store() {
    a.velocity = va, a.angular_velocity = wa;
    b.velocity = vb, b.angular_velocity = wb;
  }

  BodyMotion<Real>&a, &b;
  Vec2<Real> n, va, vb;
  Real wa, wb, ma, mb, ia, ib;
};

// What is asked of a point: v_n + bias = 0, softened.
template <class Real>
struct Demand {
  Real bias = 0, mass_scale = 1, impulse_scale = 0;
};

// How far a point is open now: carried on from the step's start to first order. `closed`: the bodies' way
// along n.
template <class Real>
Real separation_now(const Pair<Real>& pair, const ContactConstraint<Real>& c, int i, Real closed) {
  return c.separation[i] + closed + c.arm_b[i] * pair.b.turned - c.arm_a[i] * pair.a.turned;
}

template <class Real>
Real way_along_normal(const Pair<Real>& pair) {
  return dot(pair.n, pair.b.moved - pair.a.moved);
}

// lambda >= 0 with v_n + bias = 0 at both points at once: d = -mass_scale K^-1 (v + bias) - impulse_scale
// lambda. The points pull at each other through the bodies' turning; one after the other they would need
// several sweeps. A point that would have to pull gets nothing, and the other one is solved alone.
template <class Real>
void press(Pair<Real>& pair, ContactConstraint<Real>& c, const Demand<Real> (&demand)[2]) {
  const Real v = pair.along_normal();
  const Real p = c.normal_impulse[0], q = c.normal_impulse[1];
  const Real rate_p = v + c.arm_b[0] * pair.wb - c.arm_a[0] * pair.wa + demand[0].bias;
  const Real rate_q = v + c.arm_b[1] * pair.wb - c.arm_a[1] * pair.wa + demand[1].bias;
  Real dp =
      -demand[0].mass_scale * (c.inverse_pp * rate_p + c.inverse_pq * rate_q) - demand[0].impulse_scale * p;
  Real dq =
      -demand[1].mass_scale * (c.inverse_pq * rate_p + c.inverse_qq * rate_q) - demand[1].impulse_scale * q;
  if (p + dp < 0 || q + dq < 0) {
    const auto alone = [&](int i, Real rate, Real impulse) {
      const Real d = -demand[i].mass_scale * c.mass[i] * rate - demand[i].impulse_scale * impulse;
      return std::max(d, -impulse);
    };
    if (p + dp < q + dq) {
      dp = -p;
      dq = alone(1, rate_q + c.between * dp, q);
    } else {
      dq = -q;
      dp = alone(0, rate_p + c.between * dq, p);
    }
  }
  c.normal_impulse[0] = p + dp, c.normal_impulse[1] = q + dq;
  pair.push(dp + dq, c.arm_a[0] * dp + c.arm_a[1] * dq, c.arm_b[0] * dp + c.arm_b[1] * dq);
}

template <class Real>
void press_one(Pair<Real>& pair, ContactConstraint<Real>& c, const Demand<Real>& demand) {
  const Real p = c.normal_impulse[0];
  const Real rate = pair.along_normal() + c.arm_b[0] * pair.wb - c.arm_a[0] * pair.wa + demand.bias;
  const Real d = std::max(-demand.mass_scale * c.mass[0] * rate - demand.impulse_scale * p, -p);
  c.normal_impulse[0] = p + d;
  pair.push(d, c.arm_a[0] * d, c.arm_b[0] * d);
}

template <class Real>
void note_peaks(ContactConstraint<Real>& c) {
  if (!c.bounces) return;
  for (int i = 0; i < 2; ++i) c.peak_impulse[i] = std::max(c.peak_impulse[i], c.normal_impulse[i]);
}

template <class Real>
void solve_one(BodyMotion<Real>* motion, ContactConstraint<Real>& c, const ContactStep<Real>& step) {
  const Softness<Real>& soft = step.softness[static_cast<int>(c.hardness)];
  Pair<Real> pair(motion, c);
  const Real closed = way_along_normal(pair);
  const auto demand = [&](int i) {
    const Real s = separation_now(pair, c, i, closed);
    return s > 0 ? Demand<Real>{s * step.inverse_h, 1, 0}
                 : Demand<Real>{std::max(soft.bias_rate * s, -c.push_speed), soft.mass_scale,
                                soft.impulse_scale};
  };
  if (c.count == 2) {
    press(pair, c, {demand(0), demand(1)});
  } else {
    press_one(pair, c, demand(0));
  }
  note_peaks(c);
  pair.store();
}

template <class Real>
void relax_one(BodyMotion<Real>* motion, ContactConstraint<Real>& c, const ContactStep<Real>& step) {
  Pair<Real> pair(motion, c);
  const Real closed = way_along_normal(pair);
  const auto demand = [&](int i) {
    return Demand<Real>{std::max(separation_now(pair, c, i, closed), Real(0)) * step.inverse_h, 1, 0};
  };
  if (c.count == 2) {
    press(pair, c, {demand(0), demand(1)});
  } else {
    press_one(pair, c, demand(0));
  }
  note_peaks(c);
  // Coulomb: |lambda_t| <= mu lambda_n.
  const Real pressure = c.normal_impulse[0] + c.normal_impulse[1];
  const Real before = c.tangent_impulse, most = c.friction * pressure;
  const Real wanted = before - c.tangent_mass * (pair.along_tangent(c) - c.surface_speed);
  c.tangent_impulse = std::clamp(wanted, -most, most);
  pair.rub(c, c.tangent_impulse - before);
  if (c.rolling_arm > 0) {
    const Real spin_mass = pair.ia + pair.ib > 0 ? 1 / (pair.ia + pair.ib) : 0;
    const Real rolled = c.rolling_impulse, most_torque = c.rolling_arm * pressure;
    c.rolling_impulse = std::clamp(rolled - spin_mass * (pair.wb - pair.wa), -most_torque, most_torque);
    pair.roll(c.rolling_impulse - rolled);
  }
  pair.store();
}

template <class Real>
void warm_start_one(BodyMotion<Real>* motion, ContactConstraint<Real>& c) {
  Pair<Real> pair(motion, c);
  const Real p = c.normal_impulse[0], q = c.normal_impulse[1], f = c.tangent_impulse;
  const Vec2<Real> n = c.normal;
  const Vec2<Real> impulse{(p + q) * n.x + f * n.y, (p + q) * n.y - f * n.x};
  pair.va -= pair.ma * impulse;
  pair.vb += pair.mb * impulse;
  pair.wa -= pair.ia * (c.arm_a[0] * p + c.arm_a[1] * q + c.arm_tangent_a * f);
  pair.wb += pair.ib * (c.arm_b[0] * p + c.arm_b[1] * q + c.arm_tangent_b * f);
  if (c.rolling_arm > 0) pair.roll(c.rolling_impulse);
  pair.store();
}

}  // namespace

template <class Real>
void warm_start_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step) {
  const Real ratio = step.warm_start;
  if (ratio != 1) {
    graph.for_each([&](ContactConstraint<Real>& c) {
      c.normal_impulse[0] *= ratio, c.normal_impulse[1] *= ratio;
      c.tangent_impulse *= ratio, c.rolling_impulse *= ratio;
    });
  }
  graph.for_each([&](ContactConstraint<Real>& c) { warm_start_one(motion, c); });
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
      if (c.approach[i] > -step.bounce_threshold || c.peak_impulse[i] == 0) continue;
      const Real p = c.normal_impulse[i];
      const Real rate = pair.along_normal() + c.arm_b[i] * pair.wb - c.arm_a[i] * pair.wa;
      const Real d = std::max(-c.mass[i] * (rate + c.restitution * c.approach[i]), -p);
      c.normal_impulse[i] = p + d;
      pair.push(d, c.arm_a[i] * d, c.arm_b[i] * d);
    }
    note_peaks(c);
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
