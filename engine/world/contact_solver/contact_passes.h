#pragma once

#include <algorithm>

#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/contact_solver/contact_step.h"

/// The laws of a contact in soft steps (normals, friction, rolling resistance), as three passes: warm_start,
/// solve, relax. Each is for one contact, or for several in SIMD lanes (ContactBlock).
namespace plumb {

// s: gap up to which a contact counts as closed, as a time at the depenetration speed. Gaps closed to 0 are 0
// only to rounding, and both signs must be treated alike.
inline constexpr double kClosed = 1e-8;
// Upper limit of the depenetration speed added by loads, in depenetration speeds: bodies that cannot move are
// not squeezed ever harder.
inline constexpr double kLoadedPush = 3;

/// Returns the part of the depenetration speed that a load adds, m/s: a fraction of the velocity change by
/// the last substep's impulse.
template <class Number, class Contact, class Real>
[[gnu::always_inline]] inline Number load_push_share(const Contact& c, const Number& inverse_mass,
                                                     const ContactStep<Real>& step) {
  using std::min;
  if (c.hardness != ContactHardness::Soft) return Number(0);
  const Number loaded = (c.normal_impulse[0] + c.normal_impulse[1]) * inverse_mass;
  return min(Number(step.load_push_share * loaded), Number(Real(kLoadedPush) * c.push_speed));
}

/// Returns the bias velocity of a point at the separation s, and its softness. The bias is the maximum of
/// three values: gaps may close, overlaps are pushed out, and no faster than `-fastest`.
template <class Number, class Real>
[[gnu::always_inline]] inline Demand<Number> demand_at(const Number& s, const Number& closed,
                                                       const Number& fastest, const Softness<Real> (&soft)[2],
                                                       Real inverse_h) {
  using std::max;
  const auto is_gap = s > closed;
  return {max(Number(s * inverse_h), max(Number(s * soft[0].bias_rate), fastest)),
          select(is_gap, Number(soft[1].mass_scale), Number(soft[0].mass_scale)),
          select(is_gap, Number(soft[1].impulse_scale), Number(soft[0].impulse_scale))};
}

template <class Number, class Pair, class Contact, class Real>
[[gnu::always_inline]] inline void solve_contact(Pair& pair, Contact& c, const ContactStep<Real>& step) {
  using std::min;
  const Softness<Real>(&soft)[2] = step.softness[static_cast<int>(c.hardness)];
  const Number closed = Real(kClosed) * c.push_speed;
  Number fastest = -c.push_speed;
  if (const auto deep = min(c.now[0], c.now[1]) * soft[0].bias_rate < fastest; any(deep)) [[unlikely]] {
    const Number inverse_mass = pair.a.inverse_mass + pair.b.inverse_mass;
    fastest = select(deep, Number(fastest - load_push_share<Number>(c, inverse_mass, step)), fastest);
  }
  if (c.count == 2) {
    press(pair, c, demand_at<Number>(c.now[0], closed, fastest, soft, step.inverse_h),
          demand_at<Number>(c.now[1], closed, fastest, soft, step.inverse_h));
  } else {
    press_one(pair, c, demand_at<Number>(c.now[0], closed, fastest, soft, step.inverse_h));
  }
  if (c.watched != Watch::Off) note_peaks(c);
}

/// Returns the target of point i without bias, at its current separation, which is updated to first order
/// from the start of the step.
template <class Number, class Pair, class Contact, class Real>
[[gnu::always_inline]] inline Demand<Number> demand_now(const Pair& pair, Contact& c, int i,
                                                        const Number& closed, Real inverse_h) {
  using std::max;
  const Number s =
      c.separation[i] + (closed + (c.arm_b[i] * pair.b.delta_angle - c.arm_a[i] * pair.a.delta_angle));
  c.now[i] = s;
  const Number gap = max(s, Number(0));
  return {gap * inverse_h, 1, 0, select(c.normal_impulse[i] > Number(0), Number(0), gap)};
}

/// Solves friction within Coulomb's bound: |lambda_t| <= mu lambda_n.
template <class Number, class Pair, class Contact>
[[gnu::always_inline]] inline void rub_within_bound(Pair& pair, Contact& c, const Number& tangent_mass) {
  using std::max, std::min;
  const Number before = c.tangent_impulse, most = c.friction * normal_sum(c);
  const Number wanted = before - tangent_mass * (pair.along_tangent(c) - c.surface_speed);
  c.tangent_impulse = max(Number(-most), min(wanted, most));
  pair.rub(c, c.tangent_impulse - before);
}

/// Solves normals and friction of a contact together, in the `fresh` lanes, where friction begins to act.
/// Solved one after the other, friction would stop only part of the sliding (as if the body were free to
/// rotate about the contact) and rotate the body. If the load is close to the limit of friction, the rest of
/// the sliding takes long to stop: a block would slide for millimetres. A block near its tipping point would
/// begin to rock.
template <class Number, class Real, class Pair, class Contact, class Mask>
[[gnu::always_inline]] inline void begin_friction(Pair& pair, Contact& c, const Mask& fresh,
                                                  const Demand<Number>& at_p, const Demand<Number>& at_q) {
  using std::max, std::min;
  // The first normal solve may release a point, on which friction's effective mass depends. The last one
  // updates the normals, from which the bound on friction follows.
  constexpr int kRounds = 3;
  const auto coupling = [&](int i) {
    return Number(pair.a.inverse_inertia * (c.arm_a[i] * c.arm_tangent_a) +
                  pair.b.inverse_inertia * (c.arm_b[i] * c.arm_tangent_b));
  };
  const Number k_p = coupling(0), k_q = c.count == 2 ? coupling(1) : Number(0);
  // The fraction of the tangential mobility that the pressing points have: both, or one of them.
  const Number by_both =
      k_p * (c.inverse_pp * k_p + c.inverse_pq * k_q) + k_q * (c.inverse_pq * k_p + c.inverse_qq * k_q);
  const Number by_p = k_p * k_p * c.mass[0], by_q = k_q * k_q * c.mass[1];
  // Limit it by the mobility along t without rotation: the inverse for two points close together is dominated
  // by rounding.
  constexpr Real kLeast = Real(1) / 64;
  const Number straight = c.tangent_mass * (pair.a.inverse_mass + pair.b.inverse_mass);
  const Number p = c.normal_impulse[0], q = c.normal_impulse[1], f = c.tangent_impulse;
  Pair then = pair;
  for (int round = 0; round < kRounds; ++round) {
    const auto p_presses = c.normal_impulse[0] > Number(0), q_presses = c.normal_impulse[1] > Number(0);
    const Number yields =
        select(p_presses, select(q_presses, by_both, by_p), select(q_presses, by_q, Number(0)));
    const Number gives = max(Number(1) - c.tangent_mass * yields, straight);
    rub_within_bound(then, c, c.tangent_mass / max(gives, Number(kLeast)));
    if (c.count == 2) {
      press(then, c, at_p, at_q);
    } else {
      press_one(then, c, at_p);
    }
  }
  const auto take = [&](const Number& now, const Number& old) { return select(fresh, now, old); };
  c.normal_impulse[0] = take(c.normal_impulse[0], p), c.normal_impulse[1] = take(c.normal_impulse[1], q);
  c.tangent_impulse = take(c.tangent_impulse, f);
  pair.va = {take(then.va.x, pair.va.x), take(then.va.y, pair.va.y)};
  pair.vb = {take(then.vb.x, pair.vb.x), take(then.vb.y, pair.vb.y)};
  pair.wa = take(then.wa, pair.wa), pair.wb = take(then.wb, pair.wb);
}

template <class Number, class Pair, class Contact, class Real>
[[gnu::always_inline]] inline void relax_contact(Pair& pair, Contact& c, const ContactStep<Real>& step) {
  using std::max, std::min;
  const Number closed = dot(pair.n, pair.b.delta_position - pair.a.delta_position);
  const Demand<Number> at_p = demand_now<Number>(pair, c, 0, closed, step.inverse_h);
  Demand<Number> at_q{};
  if (c.count == 2) {
    at_q = demand_now<Number>(pair, c, 1, closed, step.inverse_h);
    press(pair, c, at_p, at_q);
  } else {
    press_one(pair, c, at_p);
  }
  if (c.watched != Watch::Off) note_peaks(c);
  const Number before = c.tangent_impulse;
  rub_within_bound(pair, c, c.tangent_mass);
  // Friction begins to act if it grows by more than its previous value and by a sixteenth of the load.
  // Smaller growth is resolved within a few substeps. From a 64th to a sixteenth no scenario's error of
  // position changes by more than 1 % (speeds of what has just been laid down fall from 5e-4 to 3e-5 m/s); at
  // a tenth, a block within 1 % of its tipping point begins to rock; at a quarter two scenarios miss their
  // bounds.
  // It ends likewise where the load has shrunk, as after an impact, below what the previous value needs: of
  // 1,170 squares that strike a floor by a corner without restitution 170 rebounded without it, 8 with it.
  const Number load = normal_sum(c), some = Real(0.0625) * load, most = c.friction * load + some;
  const Number change = c.tangent_impulse - before, kept = before * before;
  const Number begins = change * change - (kept + some * some), ends = kept - most * most;
  if (const auto fresh = max(begins, ends) > Number(0); any(fresh)) [[unlikely]]
    begin_friction<Number, Real>(pair, c, fresh, at_p, at_q);
  const Number pressure = normal_sum(c);
  if (c.watched != Watch::Off) c.step_impulse += pressure;
  if (rolls(c)) {
    const Number inverse_spin_mass = pair.a.inverse_inertia + pair.b.inverse_inertia;
    const Number spin_mass = select(inverse_spin_mass > Number(0), Number(1 / inverse_spin_mass), Number(0));
    const Number rolled = c.rolling_impulse, most_torque = c.rolling_arm * pressure;
    const Number held = rolled - spin_mass * (pair.wb - pair.wa);
    c.rolling_impulse = max(min(held, most_torque), Number(-most_torque));
    pair.roll(c.rolling_impulse - rolled);
  }
}

/// Applies the impulses of the last substep.
template <class Number, class Pair, class Contact>
[[gnu::always_inline]] inline void warm_start_contact(Pair& pair, const Contact& c) {
  const Number p = c.normal_impulse[0], q = c.normal_impulse[1], f = c.tangent_impulse;
  const Vec2<Number> n = pair.n;
  const Vec2<Number> impulse{(p + q) * n.x + f * n.y, (p + q) * n.y - f * n.x};
  pair.va -= pair.free.of_a(pair.a.inverse_mass * impulse);
  pair.vb += pair.free.of_b(pair.b.inverse_mass * impulse);
  pair.wa -= pair.a.inverse_inertia * (c.arm_a[0] * p + c.arm_a[1] * q + c.arm_tangent_a * f);
  pair.wb += pair.b.inverse_inertia * (c.arm_b[0] * p + c.arm_b[1] * q + c.arm_tangent_b * f);
  if (rolls(c)) pair.roll(c.rolling_impulse);
}

/// Scales the impulses of the last substep to another length of substeps.
template <class Contact, class Real>
[[gnu::always_inline]] inline void scale_impulses(Contact& c, Real ratio) {
  c.normal_impulse[0] *= ratio, c.normal_impulse[1] *= ratio;
  c.load_estimate[0] *= ratio, c.load_estimate[1] *= ratio;
  c.tangent_impulse *= ratio, c.rolling_impulse *= ratio;
}

}  // namespace plumb
