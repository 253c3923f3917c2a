#include "engine/world/contact_solver/soft_contacts.h"

#include <algorithm>

#include "engine/world/contact_solver/contact_pair.h"

namespace plumb {
namespace {

// s: gap up to which a contact counts as closed, as a time at the depenetration speed. Gaps closed to 0 are 0
// only to rounding, and both signs must be treated alike.
constexpr double kClosed = 1e-8;
// Upper limit of the depenetration speed added by loads, in depenetration speeds: bodies that cannot move are
// not squeezed ever harder.
constexpr double kLoadedPush = 3;

// Returns the depenetration speed that a load adds, m/s: a fraction of the velocity change by the last
// substep's impulse.
template <class Real>
[[gnu::noinline]] Real push_with_load(const ContactConstraint<Real>& c, Real inverse_mass,
                                      const ContactStep<Real>& step) {
  if (c.hardness != ContactHardness::Soft) return 0;
  const Real loaded = (c.normal_impulse[0] + c.normal_impulse[1]) * inverse_mass;
  return std::min(step.push_with_load * loaded, Real(kLoadedPush) * c.push_speed);
}

template <class Real>
[[gnu::always_inline]] inline void solve_one(BodyMotion<Real>* motion, ContactConstraint<Real>& c,
                                             const ContactStep<Real>& step) {
  const Softness<Real>* soft = step.softness[static_cast<int>(c.hardness)];
  Pair<Real> pair(motion, c);
  const Real closed = Real(kClosed) * c.push_speed;
  Real fastest = -c.push_speed;
  if (std::min(c.now[0], c.now[1]) * soft[0].bias_rate < fastest) [[unlikely]]
    fastest -= push_with_load(c, pair.a.inverse_mass + pair.b.inverse_mass, step);
  // The bias is the maximum of three: gaps may close, overlaps are pushed out, and at most at that speed.
  const auto demand = [&](Real s) {
    const Softness<Real>& at = soft[s > closed];
    return Demand<Real>{std::max(s * step.inverse_h, std::max(s * soft[0].bias_rate, fastest)), at.mass_scale,
                        at.impulse_scale};
  };
  if (c.count == 2) {
    press(pair, c, demand(c.now[0]), demand(c.now[1]));
  } else {
    press_one(pair, c, demand(c.now[0]));
  }
  if (c.watched) note_peaks(c);
  pair.store();
}

template <class Real>
[[gnu::always_inline]] inline void relax_one(BodyMotion<Real>* motion, ContactConstraint<Real>& c,
                                             const ContactStep<Real>& step) {
  Pair<Real> pair(motion, c);
  // Present separation of the points, updated from the start of the step to first order.
  const Real closed = dot(c.normal, pair.b.moved - pair.a.moved);
  const auto demand = [&](int i) {
    const Real s = c.separation[i] + (closed + (c.arm_b[i] * pair.b.turned - c.arm_a[i] * pair.a.turned));
    c.now[i] = s;
    return Demand<Real>{std::max(s, Real(0)) * step.inverse_h, 1, 0};
  };
  if (c.count == 2) {
    const Demand<Real> at_p = demand(0);
    const Demand<Real> at_q = demand(1);
    press(pair, c, at_p, at_q);
  } else {
    press_one(pair, c, demand(0));
  }
  if (c.watched) note_peaks(c);
  // Coulomb: |lambda_t| <= mu lambda_n.
  const Real pressure = c.normal_impulse[0] + c.normal_impulse[1];
  const Real before = c.tangent_impulse, most = c.friction * pressure;
  const Real wanted = before - c.tangent_mass * (pair.along_tangent(c) - c.surface_speed);
  c.tangent_impulse = std::max(-most, std::min(wanted, most));
  pair.rub(c, c.tangent_impulse - before);
  if (c.rolling_arm > 0) {
    const Real inverse_spin_mass = pair.a.inverse_inertia + pair.b.inverse_inertia;
    const Real spin_mass = inverse_spin_mass > 0 ? 1 / inverse_spin_mass : 0;
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
  pair.va -= pair.a.inverse_mass * impulse;
  pair.vb += pair.b.inverse_mass * impulse;
  pair.wa -= pair.a.inverse_inertia * (c.arm_a[0] * p + c.arm_a[1] * q + c.arm_tangent_a * f);
  pair.wb += pair.b.inverse_inertia * (c.arm_b[0] * p + c.arm_b[1] * q + c.arm_tangent_b * f);
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
      c.expected_impulse[0] *= ratio, c.expected_impulse[1] *= ratio;
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

#define PLUMB_FOR(Real)                                                                                \
  template void warm_start_contacts(BodyMotion<Real>*, ContactGraph<Real>&, const ContactStep<Real>&); \
  template void solve_contacts(BodyMotion<Real>*, ContactGraph<Real>&, const ContactStep<Real>&);      \
  template void relax_contacts(BodyMotion<Real>*, ContactGraph<Real>&, const ContactStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
