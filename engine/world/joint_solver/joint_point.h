#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/joint_solver/joint_rule.h"
#include "engine/world/joint_solver/joint_velocities.h"

namespace plumb {

/// A symmetric 2x2 matrix.
template <class Real>
struct Symmetric2 {
  Real xx = 0, xy = 0, yy = 0;
  [[gnu::always_inline]] friend Vec2<Real> operator*(Symmetric2 m, Vec2<Real> v) {
    return {m.xx * v.x + m.xy * v.y, m.xy * v.x + m.yy * v.y};
  }
};

/// Inverse effective mass of a point that two bodies share:
///     K = m 1 + i_a p_a p_a^T + i_b p_b p_b^T,  m = m_a + m_b, p = (-arm.y, arm.x).
/// Its determinant m^2 + m (i_a |p_a|^2 + i_b |p_b|^2) + i_a i_b (p_a x p_b)^2 is a sum of squares: nothing
/// cancels.
template <class Number>
struct PointResponse {
  Number xx, xy, yy, determinant;
};

template <class Number>
[[gnu::always_inline]] inline PointResponse<Number> point_response(const JointVelocities<Number>& v,
                                                                   Vec2<Number> arm_a, Vec2<Number> arm_b) {
  const Number m = v.m_a + v.m_b;
  const Vec2<Number> a = v.i_a * arm_a, b = v.i_b * arm_b;
  const Number xx = m + (a.y * arm_a.y + b.y * arm_b.y);
  const Number yy = m + (a.x * arm_a.x + b.x * arm_b.x);
  const Number xy = -(a.x * arm_a.y + b.x * arm_b.y);
  return {xx, xy, yy, m * (xx + (yy - m)) + cross(a, arm_b) * cross(arm_a, b)};
}

/// Returns `factor` times the effective mass, the inverse of K. If the determinant vanishes to rounding (only
/// rotation is free, about one arm), it divides by the trace instead: a short step.
template <class Real>
[[gnu::always_inline]] inline Symmetric2<Real> mass_of(const PointResponse<Real>& k, Real factor) {
  const Real trace = k.xx + k.yy;
  const Real inverse = factor / k.determinant;
  const Symmetric2<Real> mass{inverse * k.yy, -inverse * k.xy, inverse * k.xx};
  const auto regular = k.determinant > std::numeric_limits<Scalar<Real>>::epsilon() * (trace * trace);
  if (all(regular)) [[likely]]
    return mass;
  const Real by_trace = select(trace > Real(0), Real(factor / trace), Real(0));
  return {select(regular, mass.xx, by_trace), select(regular, mass.xy, Real(0)),
          select(regular, mass.yy, by_trace)};
}

/// Two anchors that coincide: both components of the gap between them, solved together.
template <class Real>
struct RigidPoint {
  Vec2<Real> impulse{};  ///< N s, on b
  AnchorPoint<Real> point{};
  Symmetric2<Real> mass{};

  static constexpr bool rigid() { return true; }

  /// Writes single components: a pair stored by halves and loaded as one would stall.
  [[gnu::always_inline]] void evaluate(const AnchorPoint<Real>& at, const JointVelocities<Real>& v,
                                       const JointStep<Scalar<Real>>&, UnderRelaxation<Real> relaxation) {
    point.gap.x = at.gap.x, point.gap.y = at.gap.y;
    point.arm_a.x = at.arm_a.x, point.arm_a.y = at.arm_a.y;
    point.arm_b.x = at.arm_b.x, point.arm_b.y = at.arm_b.y;
    const Symmetric2<Real> response = mass_of(point_response(v, at.arm_a, at.arm_b), relaxation.factor);
    mass.xx = response.xx, mass.xy = response.xy, mass.yy = response.yy;
  }
  [[gnu::always_inline]] void warm_start(JointVelocities<Real>& v) const {
    v.apply(impulse, point.arm_a, point.arm_b);
  }
  [[gnu::always_inline]] void solve(JointVelocities<Real>& v, const Softness<Scalar<Real>>& soft,
                                    JointPass pass, Real factor) {
    const Vec2<Real> rate = v.at(point.arm_a, point.arm_b);
    Vec2<Real> delta;
    if (pass == kRelax) {
      delta = -(mass * rate);
    } else {
      Vec2<Real> bias = (factor * Real(soft.bias_rate)) * point.gap;
      limit_closing(v, point, bias);
      delta = -(Real(soft.mass_scale) * (mass * (rate + bias)) + Real(soft.impulse_scale) * impulse);
    }
    impulse += delta;
    v.apply(delta, point.arm_a, point.arm_b);
  }
};

/// Both components of the gap between two anchors, solved together, by a rule that bounds the vector's
/// length. Not side by side.
template <class Real>
struct SoftPoint {
  SolverRule<Real> rule{};  ///< without sign and origin
  Vec2<Real> impulse{};     ///< N s, on b
  Vec2<Real> drift{};       ///< m, see SolverRule
  AnchorPoint<Real> point{};
  Symmetric2<Real> mass{};
  Real compliance = 0;  ///< 1/kg, of a spring that is not too stiff: the same in all directions
  Vec2<Real> bias[2]{};
  Real mass_scale[2]{1, 1}, impulse_scale[2]{};

  void load(const RowRule& r) {
    if (r.role != rule.role) impulse = drift = {};
    rule.load(r);
  }
  void set_substep(const RowRule& r, double spring_mobility, double h) {
    rule.set_substep(r, spring_mobility, h);
  }

  /// Records the gap at the end of a substep; the gap at its start is that of `point`.
  [[gnu::always_inline]] void update_drift(Vec2<Real> gap) {
    if (rule.role != RowRole::Motor) return;
    const bool suffices = length_squared(impulse) < rule.max_impulse * rule.max_impulse;
    drift = suffices ? drift + (gap - point.gap) : Vec2<Real>{};
  }

  [[gnu::always_inline]] bool rigid() const {
    return rule.role == RowRole::Rigid && rule.max_impulse == std::numeric_limits<Real>::infinity();
  }

  [[gnu::always_inline]] void evaluate(const AnchorPoint<Real>& at, const JointVelocities<Real>& v,
                                       const JointStep<Real>& step, UnderRelaxation<Real> relaxation) {
    const PointResponse<Real> k = point_response(v, at.arm_a, at.arm_b);
    point = at;
    if (rule.role == RowRole::Spring) return evaluate_spring(k, step, relaxation);
    mass = mass_of(k, Real(1));
    RowTerm<Real> term[2]{};
    rule.drift = 1;
    rule.terms(1, 1, relaxation, step, term);
    for (int pass = 0; pass < 2; ++pass) {
      bias[pass] = term[pass].bias * (rule.role == RowRole::Motor ? drift : at.gap);
      mass_scale[pass] = term[pass].mass;
      impulse_scale[pass] = term[pass].scale;
    }
    if (rule.role == RowRole::Rigid && step.stiff_rate > 0) limit_closing(v, at, bias[kSolve]);
  }
  /// Does the same for a spring beside a rigid angle, which reduces the point's mobility to `constrained`:
  /// its response if the joint is solved alone.
  void evaluate_beside_rigid(const AnchorPoint<Real>& at, const JointVelocities<Real>& v,
                             const PointResponse<Real>& constrained, const JointStep<Real>& step,
                             UnderRelaxation<Real> relaxation) {
    point = at;
    evaluate_spring(relaxation.factor == 1 ? constrained : point_response(v, at.arm_a, at.arm_b), step,
                    relaxation);
  }
  [[gnu::always_inline]] void warm_start(JointVelocities<Real>& v) const {
    v.apply(impulse, point.arm_a, point.arm_b);
  }

  [[gnu::always_inline]] void solve(JointVelocities<Real>& v, const Softness<Real>&, JointPass pass, Real) {
    const Vec2<Real> before = impulse;
    Vec2<Real> rate = v.at(point.arm_a, point.arm_b) + bias[pass];
    if (rule.role == RowRole::Spring) rate += compliance * before;
    impulse = before - mass_scale[pass] * (mass * rate) - impulse_scale[pass] * before;
    const Real size = length_squared(impulse);
    if (size > rule.max_impulse * rule.max_impulse) impulse *= rule.max_impulse / std::sqrt(size);
    v.apply(impulse - before, point.arm_a, point.arm_b);
  }

 private:
  // See SolverRule::terms. The point responds with `k`, the spring has one stiffness in all directions.
  void evaluate_spring(const PointResponse<Real>& k, const JointStep<Real>& step,
                       UnderRelaxation<Real> relaxation) {
    const Real factor = relaxation.factor;
    const SpringTerm<Real>& spring = rule.spring;
    const Real trace = k.xx + k.yy;
    // Stiffness counts in the direction in which the bodies are lightest.
    const Real difference = k.xx - k.yy;
    const Real max_mobility = Real(0.5) * (trace + std::sqrt(difference * difference + 4 * k.xy * k.xy));
    constexpr Real kMaxStiffnessRatio = Real(1e12);  // beyond it a spring is rigid to rounding
    compliance = std::max(spring.compliance, max_mobility / kMaxStiffnessRatio);
    if (!(max_mobility > relaxation.max_stiffness(step.max_stiffness) * compliance)) {
      // The determinant of K + compliance 1: nothing cancels.
      const Real determinant = k.determinant + compliance * (trace + compliance);
      mass = mass_of({k.xx + compliance, k.xy, k.yy + compliance, determinant}, Real(1));
      bias[kRelax] = bias[kSolve];
      bias[kSolve] = spring.rate * point.gap;
      mass_scale[kSolve] = mass_scale[kRelax] = 1;
      impulse_scale[kSolve] = impulse_scale[kRelax] = 0;
      return;
    }
    // Held like a rigid point: in proportion to the effective mass, of which the average counts.
    const bool regular = k.determinant > std::numeric_limits<Real>::epsilon() * (trace * trace);
    const Real mean = regular ? 2 * k.determinant / trace : trace;
    const StiffSpring<Real> stiff(spring, mean / compliance, factor, step);
    compliance = 0;
    mass = mass_of(k, factor);
    bias[kSolve] = (factor * stiff.rate) * point.gap;
    bias[kRelax] = {};
    mass_scale[kSolve] = stiff.mass_scale, impulse_scale[kSolve] = stiff.impulse_scale;
    mass_scale[kRelax] = 1, impulse_scale[kRelax] = 0;
  }
};

}  // namespace plumb
