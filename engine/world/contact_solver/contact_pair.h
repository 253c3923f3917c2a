#pragma once

#include <algorithm>
#include <limits>

#include "engine/math/lanes.h"
#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/contact_solver/locked_axes.h"
#include "engine/world/contact_solver/solver_body.h"

/// Building blocks of the passes over contacts: for one contact, or for several in SIMD lanes if `Number` has
/// lanes. They are inlined, because a pass costs little more than the latency of its few operations.
namespace plumb {

/// The two bodies of a constraint, held in registers through a pass. Their velocities are written back once.
template <class Number, class Body, class Axes = AllAxes>
struct BodyPair {
  Body a, b;
  Vec2<Number> n;
  [[no_unique_address]] Axes free{};
  Vec2<Number> va = a.velocity, vb = b.velocity;
  Number wa = a.angular_velocity, wb = b.angular_velocity;

  [[gnu::always_inline]] Number linear_normal_velocity() const { return dot(n, vb - va); }
  template <class Contact>
  [[gnu::always_inline]] Number tangent_velocity(const Contact& c) const {
    return dot(Vec2<Number>{n.y, -n.x}, vb - va) + (c.arm_tangent_b * wb - c.arm_tangent_a * wa);
  }
  [[gnu::always_inline]] void apply_normal(const Number& impulse, const Number& angular_a,
                                           const Number& angular_b) {
    va -= free.of_a((a.inverse_mass * impulse) * n);
    vb += free.of_b((b.inverse_mass * impulse) * n);
    wa -= a.inverse_inertia * angular_a;
    wb += b.inverse_inertia * angular_b;
  }
  template <class Contact>
  [[gnu::always_inline]] void apply_friction(const Contact& c, const Number& impulse) {
    const Vec2<Number> t{n.y, -n.x};
    va -= free.of_a((a.inverse_mass * impulse) * t);
    vb += free.of_b((b.inverse_mass * impulse) * t);
    wa -= a.inverse_inertia * (impulse * c.arm_tangent_a);
    wb += b.inverse_inertia * (impulse * c.arm_tangent_b);
  }
  [[gnu::always_inline]] void apply_rolling(const Number& impulse) {
    wa -= a.inverse_inertia * impulse;
    wb += b.inverse_inertia * impulse;
  }
};

/// Bias and softness of a point: v_n + bias = 0, softened. A point with `inactive` > 0 has no impulse, and
/// gets none.
template <class Number>
struct NormalBias {
  Number bias = 0, mass_scale = 1, impulse_scale = 0, inactive = 0;
};

/// Returns the impulse lambda >= 0 that solves v_n + bias = 0 at a point alone. `rate`: v_n + bias.
template <class Number>
[[gnu::always_inline]] inline Number solve_point(const NormalBias<Number>& bias, const Number& mass,
                                                 const Number& load_estimate, const Number& rate,
                                                 const Number& impulse) {
  using std::max;
  const Number softening = bias.impulse_scale * (impulse - load_estimate);
  const Number new_impulse = max((impulse - softening) - bias.mass_scale * mass * rate, Number(0));
  return select(bias.inactive > Number(0), Number(0), new_impulse);
}

/// Solves lambda >= 0 with v_n + bias = 0 at both points together, softened around the load estimate
/// lambda_0: d = -mass_scale K^-1 (v + bias) - impulse_scale (lambda - lambda_0). The points are coupled by
/// the bodies' rotation: solved one after the other, they would need several iterations. A point that would
/// have to pull gets no impulse, and the other one is solved alone.
template <class Pair, class Contact, class Number>
[[gnu::always_inline]] inline void solve_normal_block(Pair& pair, Contact& c,
                                                      const NormalBias<Number>& bias_p,
                                                      const NormalBias<Number>& bias_q) {
  using std::min;
  const Number v = pair.linear_normal_velocity();
  const Number p = c.normal_impulse[0], q = c.normal_impulse[1];
  const Number rate_p =
      pair.free.along_normal(v + (c.arm_b[0] * pair.wb - c.arm_a[0] * pair.wa + bias_p.bias), p);
  const Number rate_q =
      pair.free.along_normal(v + (c.arm_b[1] * pair.wb - c.arm_a[1] * pair.wa + bias_q.bias), q);
  Number new_p = (p - bias_p.impulse_scale * (p - c.load_estimate[0])) -
                 bias_p.mass_scale * (c.inverse_pp * rate_p + c.inverse_pq * rate_q);
  Number new_q = (q - bias_q.impulse_scale * (q - c.load_estimate[1])) -
                 bias_q.mass_scale * (c.inverse_pq * rate_p + c.inverse_qq * rate_q);
  // A gap is not softened. If only the other point is softened, compute the gap's impulse from that point's
  // impulse, so that the gap closes exactly.
  const auto p_gap = bias_p.impulse_scale < bias_q.impulse_scale,
             q_gap = bias_q.impulse_scale < bias_p.impulse_scale;
  if (any(p_gap) || any(q_gap)) [[unlikely]] {
    new_q = select(q_gap, Number(q - c.mass[1] * (rate_q + c.k_pq * (new_p - p))), new_q);
    new_p = select(p_gap, Number(p - c.mass[0] * (rate_p + c.k_pq * (new_q - q))), new_p);
  }
  constexpr auto kLowest = std::numeric_limits<Scalar<Number>>::lowest();
  new_p = select(bias_p.inactive > Number(0), Number(kLowest), new_p);
  new_q = select(bias_q.inactive > Number(0), Number(kLowest), new_q);
  if (const auto pulls = min(new_p, new_q) < Number(0); any(pulls)) {
    const auto p_pulls = new_p < new_q;
    const auto zero = []() __attribute__((always_inline)) { return Number(0); };
    const auto p_alone = [&]() __attribute__((always_inline)) {
      return solve_point(bias_p, c.mass[0], c.load_estimate[0], rate_p - c.k_pq * q, p);
    };
    const auto q_alone = [&]() __attribute__((always_inline)) {
      return solve_point(bias_q, c.mass[1], c.load_estimate[1], rate_q - c.k_pq * p, q);
    };
    const Number only_p = choose(p_pulls, zero, p_alone), only_q = choose(p_pulls, q_alone, zero);
    new_p = select(pulls, only_p, new_p), new_q = select(pulls, only_q, new_q);
  }
  c.normal_impulse[0] = new_p, c.normal_impulse[1] = new_q;
  const Number dp = new_p - p, dq = new_q - q;
  pair.apply_normal(dp + dq, c.arm_a[0] * dp + c.arm_a[1] * dq, c.arm_b[0] * dp + c.arm_b[1] * dq);
}

template <class Pair, class Contact, class Number>
[[gnu::always_inline]] inline void solve_normal(Pair& pair, Contact& c, const NormalBias<Number>& bias) {
  const Number p = c.normal_impulse[0];
  const Number rate = pair.free.along_normal(
      pair.linear_normal_velocity() + (c.arm_b[0] * pair.wb - c.arm_a[0] * pair.wa + bias.bias), p);
  const Number new_p = solve_point(bias, c.mass[0], c.load_estimate[0], rate, p);
  c.normal_impulse[0] = new_p;
  const Number d = new_p - p;
  pair.apply_normal(d, c.arm_a[0] * d, c.arm_b[0] * d);
}

/// Returns the normal impulse of both points, N s; 0 for an unused point.
template <class Contact>
[[gnu::always_inline]] inline auto normal_sum(const Contact& c) {
  return c.normal_impulse[0] + c.normal_impulse[1];
}

/// Records the largest normal impulses of a step.
template <class Contact>
[[gnu::always_inline]] inline void record_max_impulse(Contact& c) {
  using std::max;
  for (int i = 0; i < 2; ++i) c.max_normal_impulse[i] = max(c.max_normal_impulse[i], c.normal_impulse[i]);
}

}  // namespace plumb
