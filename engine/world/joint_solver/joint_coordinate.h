#pragma once

#include <algorithm>

#include "engine/world/joint_solver/joint_rule.h"
#include "engine/world/joint_solver/joint_velocities.h"

namespace plumb {

/// A scalar coordinate with up to four rules. They share one Jacobian, so J v is evaluated once and the
/// impulses are applied once.
template <class Real, bool kAngular>
struct JointCoordinate {
  struct Solved {
    RowTerm<Real> term[2];
  };
  int count = 0;
  Real inverse_mass = 0;  ///< J M^-1 J^T, reduced by rigid rows that hold at the same time
  JointRow<Real> row{};   ///< not used if kAngular
  SolverRule<Real> rule[RowRules::kMost]{};
  Solved solved[RowRules::kMost]{};

  void load(const RowRules& rules) {
    for (int i = 0; i < RowRules::kMost; ++i) {
      if (i >= rules.count) {
        rule[i] = {};
      } else {
        if (i >= count) rule[i] = {};
        rule[i].load(rules.rule[i]);
      }
    }
    count = rules.count;
  }
  void set_substep(const RowRules& rules, double spring_mobility, double h) {
    for (int i = 0; i < count; ++i) rule[i].set_substep(rules.rule[i], spring_mobility, h);
  }
  template <class Visit>
  void for_each_impulse(const Visit& visit) {
    for (int i = 0; i < count; ++i) visit(rule[i].impulse);
  }
  void reset() {
    row = {};
    for (auto& each : rule) each.impulse = each.drift = 0;
  }

  /// Records the coordinate at the start of a step, and at the end of each substep.
  [[gnu::always_inline]] void start_drift(Real q) {
    for (int i = 0; i < count; ++i) rule[i].last = q;
  }
  [[gnu::always_inline]] void update_drift(Real q, Scalar<Real> h) {
    for (int i = 0; i < count; ++i) rule[i].update_drift(q, h);
  }

  /// Returns the sum of all rules' lambda along +q.
  [[gnu::always_inline]] Real impulse() const {
    Real sum = 0;
    for (int i = 0; i < count; ++i) sum += rule[i].sign * rule[i].impulse;
    return sum;
  }

  [[gnu::always_inline]] bool has(RowRole role) const {
    for (int i = 0; i < count; ++i)
      if (rule[i].role == role) return true;
    return false;
  }

  /// Returns J M^-1 J^T.
  [[gnu::always_inline]] Real mobility(const JointVelocities<Real>& v) const {
    if constexpr (kAngular) {
      return v.i_a + v.i_b;
    } else {
      return v.inverse_mass(row, row);
    }
  }

  /// Evaluates the rules at the coordinate `q`, at the pose of `row`.
  [[gnu::always_inline]] void evaluate(Real q, const JointVelocities<Real>& v,
                                       const JointStep<Scalar<Real>>& step,
                                       UnderRelaxation<Real> relaxation) {
    if (count == 0) return;
    inverse_mass = mobility(v);
    evaluate_rules(q, v, step, relaxation);
  }
  /// Does the same for a spring beside rigid rows, which reduce its mobility to `constrained`: its response
  /// if the joint is solved alone, with these rows before and after the spring.
  [[gnu::always_inline]] void evaluate_beside_rigid(Real q, const JointVelocities<Real>& v, Real constrained,
                                                    const JointStep<Scalar<Real>>& step,
                                                    UnderRelaxation<Real> relaxation) {
    inverse_mass = select(relaxation.factor < Real(1), mobility(v), constrained);
    evaluate_rules(q, v, step, relaxation);
  }
  [[gnu::always_inline]] void warm_start(JointVelocities<Real>& v) const {
    if (count > 0) apply(v, impulse());
  }

  [[gnu::always_inline]] void solve(JointVelocities<Real>& v, JointPass pass) {
    if (count == 0) return;
    using std::max, std::min;
    Real rate = along(v), sum = 0;
    for (int i = 0; i < count; ++i) {
      SolverRule<Real>& r = rule[i];
      const RowTerm<Real>& t = solved[i].term[pass];
      const Real wanted = r.impulse - t.mass * (r.sign * rate + t.bias) - t.scale * r.impulse;
      const Real total = min(max(wanted, r.lower()), r.max_impulse);
      const Real delta = r.sign * (total - r.impulse);
      r.impulse = total;
      rate += inverse_mass * delta;
      sum += delta;
    }
    apply(v, sum);
  }

 private:
  [[gnu::always_inline]] void evaluate_rules(Real q, const JointVelocities<Real>& v,
                                             const JointStep<Scalar<Real>>& step,
                                             UnderRelaxation<Real> relaxation) {
    for (int i = 0; i < count; ++i) {
      rule[i].terms(q, inverse_mass, relaxation, step, solved[i].term);
      if (rule[i].role != RowRole::Rigid && rule[i].role != RowRole::Limit) continue;
      if (!(step.stiff_rate > 0)) continue;  // position-based: gaps close without velocity
      Real& bias = solved[i].term[kSolve].bias;
      if constexpr (kAngular) {
        // Both bodies' inertia cancels. A gap to a limit (> 0) may close at any speed.
        using std::max, std::min;
        bias = max(bias, Real(-kMaxClosingSpeed));
        if (rule[i].role == RowRole::Rigid) bias = min(bias, Real(kMaxClosingSpeed));
      } else {
        const Real closing = closing_fraction(v, bias * bias, row);
        bias *= rule[i].role == RowRole::Rigid ? closing : select(bias < Real(0), closing, Real(1));
      }
    }
  }
  [[gnu::always_inline]] Real along(const JointVelocities<Real>& v) const {
    if constexpr (kAngular) {
      return v.w_b - v.w_a;
    } else {
      return v.along(row);
    }
  }
  [[gnu::always_inline]] void apply(JointVelocities<Real>& v, Real impulse) const {
    if constexpr (kAngular) {
      v.w_a -= v.i_a * impulse;
      v.w_b += v.i_b * impulse;
    } else {
      v.apply(row, impulse);
    }
  }
};

}  // namespace plumb
