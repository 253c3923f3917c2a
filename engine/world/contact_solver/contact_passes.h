#pragma once

#include <algorithm>

#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/contact_solver/contact_step.h"

/// The laws of a contact in soft steps (normals, friction, rolling resistance), as three passes: warm_start,
/// solve, relax. Each is for one contact, or for several in SIMD lanes (ContactBlock).
namespace plumb {

// Gap up to which a contact counts as closed, s at the depenetration speed. A closed gap is 0 only to
// rounding, and both signs must be treated alike.
inline constexpr double kGapTolerance = 1e-8;
// Upper limit of the speed that loads add to the depenetration speed, as a multiple of it. Without the limit,
// bodies that cannot move would be squeezed ever harder.
inline constexpr double kMaxLoadFactor = 3;

/// Returns the speed that a load adds to the depenetration speed, m/s: a fraction of the velocity change by
/// the last substep's impulse.
template <class Number, class Contact, class Real>
[[gnu::always_inline]] inline Number load_depenetration_speed(const Contact& c, const Number& inverse_mass,
                                                              const ContactStep<Real>& step) {
  using std::min;
  if (c.hardness != ContactHardness::Soft) return Number(0);
  const Number load_velocity = (c.normal_impulse[0] + c.normal_impulse[1]) * inverse_mass;
  return min(Number(step.load_push_fraction * load_velocity),
             Number(Real(kMaxLoadFactor) * c.depenetration_speed));
}

/// Returns the bias velocity of a point at the separation s, and its softness. The bias lets gaps close
/// within the substep and removes overlaps, with at most the speed `-min_bias`.
template <class Number, class Real>
[[gnu::always_inline]] inline NormalBias<Number> soft_bias(const Number& s, const Number& gap_tolerance,
                                                           const Number& min_bias,
                                                           const Softness<Real> (&soft)[2], Real inverse_h) {
  using std::max;
  const auto is_gap = s > gap_tolerance;
  return {max(Number(s * inverse_h), max(Number(s * soft[0].bias_rate), min_bias)),
          select(is_gap, Number(soft[1].mass_scale), Number(soft[0].mass_scale)),
          select(is_gap, Number(soft[1].impulse_scale), Number(soft[0].impulse_scale))};
}

/// Lets a driven contact yield to what exceeds its load (solvers/driven_contacts.h).
template <class Number, class Pair, class Contact>
[[gnu::always_inline]] inline void yield_to_excess(Pair& pair, Contact& c) {
  using std::max;
  using Real = Scalar<Number>;
  Number yielded[2];
  for (int i = 0; i < 2; ++i) {
    yielded[i] = Real(-kDrivenYield) * max(c.normal_impulse[i] - c.load_estimate[i], Number(0));
    c.normal_impulse[i] += yielded[i];
  }
  pair.apply_normal(yielded[0] + yielded[1], c.arm_a[0] * yielded[0] + c.arm_a[1] * yielded[1],
                    c.arm_b[0] * yielded[0] + c.arm_b[1] * yielded[1]);
}

template <class Number, class Pair, class Contact, class Real>
[[gnu::always_inline]] inline void solve_contact(Pair& pair, Contact& c, const ContactStep<Real>& step) {
  using std::min;
  const Softness<Real>(&soft)[2] = step.softness[static_cast<int>(c.hardness)];
  const Number gap_tolerance = Real(kGapTolerance) * c.depenetration_speed;
  Number min_bias = -c.depenetration_speed;
  if (const auto deep = min(c.current_separation[0], c.current_separation[1]) * soft[0].bias_rate < min_bias;
      any(deep)) [[unlikely]] {
    const Number inverse_mass = pair.a.inverse_mass + pair.b.inverse_mass;
    min_bias =
        select(deep, Number(min_bias - load_depenetration_speed<Number>(c, inverse_mass, step)), min_bias);
  }
  if (c.count == 2) {
    solve_normal_block(
        pair, c, soft_bias<Number>(c.current_separation[0], gap_tolerance, min_bias, soft, step.inverse_h),
        soft_bias<Number>(c.current_separation[1], gap_tolerance, min_bias, soft, step.inverse_h));
  } else {
    solve_normal(pair, c,
                 soft_bias<Number>(c.current_separation[0], gap_tolerance, min_bias, soft, step.inverse_h));
  }
  if (is_plain(c)) return;
  if (is_driven(c)) yield_to_excess<Number>(pair, c);
  if (c.tracking != ImpactTracking::Off) record_max_impulse(c);
}

/// Updates the separation of point i, to first order from the start of the step. Returns its bias for
/// relaxation: a gap may close within the substep, overlaps have no bias.
template <class Number, class Pair, class Contact, class Real>
[[gnu::always_inline]] inline NormalBias<Number> gap_bias(const Pair& pair, Contact& c, int i,
                                                          const Number& displacement, Real inverse_h) {
  using std::max;
  const Number s =
      c.separation[i] + (displacement + (c.arm_b[i] * pair.b.delta_angle - c.arm_a[i] * pair.a.delta_angle));
  c.current_separation[i] = s;
  const Number gap = max(s, Number(0));
  return {gap * inverse_h, 1, 0, select(c.normal_impulse[i] > Number(0), Number(0), gap)};
}

/// Solves friction within Coulomb's bound: |lambda_t| <= mu lambda_n.
template <class Number, class Pair, class Contact>
[[gnu::always_inline]] inline void solve_friction(Pair& pair, Contact& c, const Number& tangent_mass) {
  using std::max, std::min;
  const Number old_friction = c.tangent_impulse, max_friction = c.friction * normal_sum(c);
  const Number unclamped =
      old_friction -
      tangent_mass * pair.free.along_tangent(pair.tangent_velocity(c) - c.surface_speed, old_friction);
  c.tangent_impulse = max(Number(-max_friction), min(unclamped, max_friction));
  pair.apply_friction(c, c.tangent_impulse - old_friction);
}

/// Solves normals and friction of a contact together, in `lanes`, where friction begins or ends to act.
/// Solved after the normals, friction would stop only part of the sliding (as if the body were free to rotate
/// about the contact) and rotate the body. If the load is close to the limit of friction, the rest of the
/// sliding takes long to stop: a block would slide for millimetres, or near its tipping point begin to rock.
template <class Number, class Real, class Pair, class Contact, class Mask>
[[gnu::always_inline]] inline void solve_coupled_friction(Pair& pair, Contact& c, const Mask& lanes,
                                                          const NormalBias<Number>& bias_p,
                                                          const NormalBias<Number>& bias_q) {
  using std::max, std::min;
  // The first normal solve may release a point, on which friction's effective mass depends. The last one
  // updates the normals, from which the bound on friction follows.
  constexpr int kIterations = 3;
  const auto coupling = [&](int i) {
    return Number(pair.a.inverse_inertia * (c.arm_a[i] * c.arm_tangent_a) +
                  pair.b.inverse_inertia * (c.arm_b[i] * c.arm_tangent_b));
  };
  const Number k_p = coupling(0), k_q = c.count == 2 ? coupling(1) : Number(0);
  // The part of the tangential mobility that the pressing points (both, or one) take away: the Schur
  // complement of the normals is 1 / tangent_mass minus this part.
  const Number by_both =
      k_p * (c.inverse_pp * k_p + c.inverse_pq * k_q) + k_q * (c.inverse_pq * k_p + c.inverse_qq * k_q);
  const Number by_p = k_p * k_p * c.mass[0], by_q = k_q * k_q * c.mass[1];
  // The rest is at least the mobility along t without rotation: for two points close together the inverse
  // is dominated by rounding.
  constexpr Real kMinFraction = Real(1) / 64;
  const Number linear_fraction = c.tangent_mass * (pair.a.inverse_mass + pair.b.inverse_mass);
  const Number p = c.normal_impulse[0], q = c.normal_impulse[1], f = c.tangent_impulse;
  Pair trial = pair;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const auto p_presses = c.normal_impulse[0] > Number(0), q_presses = c.normal_impulse[1] > Number(0);
    const Number coupled =
        select(p_presses, select(q_presses, by_both, by_p), select(q_presses, by_q, Number(0)));
    const Number free_fraction = max(Number(1) - c.tangent_mass * coupled, linear_fraction);
    solve_friction(trial, c, c.tangent_mass / max(free_fraction, Number(kMinFraction)));
    if (c.count == 2) {
      solve_normal_block(trial, c, bias_p, bias_q);
    } else {
      solve_normal(trial, c, bias_p);
    }
  }
  const auto pick = [&](const Number& updated, const Number& old) { return select(lanes, updated, old); };
  c.normal_impulse[0] = pick(c.normal_impulse[0], p), c.normal_impulse[1] = pick(c.normal_impulse[1], q);
  c.tangent_impulse = pick(c.tangent_impulse, f);
  pair.va = {pick(trial.va.x, pair.va.x), pick(trial.va.y, pair.va.y)};
  pair.vb = {pick(trial.vb.x, pair.vb.x), pick(trial.vb.y, pair.vb.y)};
  pair.wa = pick(trial.wa, pair.wa), pair.wb = pick(trial.wb, pair.wb);
}

template <class Number, class Pair, class Contact, class Real>
[[gnu::always_inline]] inline void relax_contact(Pair& pair, Contact& c, const ContactStep<Real>& step) {
  using std::max, std::min;
  const Number displacement = dot(pair.n, pair.b.delta_position - pair.a.delta_position);
  const NormalBias<Number> bias_p = gap_bias<Number>(pair, c, 0, displacement, step.inverse_h);
  NormalBias<Number> bias_q{};
  if (c.count == 2) {
    bias_q = gap_bias<Number>(pair, c, 1, displacement, step.inverse_h);
    solve_normal_block(pair, c, bias_p, bias_q);
  } else {
    solve_normal(pair, c, bias_p);
  }
  if (c.tracking != ImpactTracking::Off) record_max_impulse(c);
  const Number old_friction = c.tangent_impulse;
  solve_friction(pair, c, c.tangent_mass);
  // Friction begins to act if it grows by more than its previous value and by a sixteenth of the load.
  // Smaller growth is resolved within a few substeps. Between a 64th and a sixteenth, no scenario's position
  // error changes by more than 1 % (speeds of bodies just laid down fall from 5e-4 to 3e-5 m/s). At a tenth,
  // a block within 1 % of its tipping point begins to rock; at a quarter two scenarios miss their bounds.
  // Friction ends to act if the load has shrunk, as after an impact, below what the previous value needs.
  // Without this rule, of 1,170 squares that hit a floor with a corner and without restitution, 170
  // rebounded; with it 8.
  const Number load = normal_sum(c), threshold = Real(0.0625) * load, limit = c.friction * load + threshold;
  const Number change = c.tangent_impulse - old_friction, old_squared = old_friction * old_friction;
  const Number begins = change * change - (old_squared + threshold * threshold),
               ends = old_squared - limit * limit;
  if (const auto lanes = max(begins, ends) > Number(0); any(lanes)) [[unlikely]]
    solve_coupled_friction<Number, Real>(pair, c, lanes, bias_p, bias_q);
  if (is_plain(c)) return;
  if (is_driven(c)) yield_to_excess<Number>(pair, c);
  const Number total_normal = normal_sum(c);
  if (c.tracking != ImpactTracking::Off) c.step_impulse += total_normal;
  if (rolls(c)) {
    const Number inverse_rolling_mass = pair.a.inverse_inertia + pair.b.inverse_inertia;
    const Number rolling_mass =
        select(inverse_rolling_mass > Number(0), Number(1 / inverse_rolling_mass), Number(0));
    const Number old_rolling = c.rolling_impulse, max_torque = c.rolling_arm * total_normal;
    const Number unclamped = old_rolling - rolling_mass * (pair.wb - pair.wa);
    c.rolling_impulse = max(min(unclamped, max_torque), Number(-max_torque));
    pair.apply_rolling(c.rolling_impulse - old_rolling);
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
  if (rolls(c)) pair.apply_rolling(c.rolling_impulse);
}

/// Scales the impulses of the last substep to another length of substeps.
template <class Contact, class Real>
[[gnu::always_inline]] inline void scale_impulses(Contact& c, Real ratio) {
  c.normal_impulse[0] *= ratio, c.normal_impulse[1] *= ratio;
  c.load_estimate[0] *= ratio, c.load_estimate[1] *= ratio;
  c.tangent_impulse *= ratio, c.rolling_impulse *= ratio;
}

}  // namespace plumb
