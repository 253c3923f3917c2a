#pragma once

#include <algorithm>

#include "engine/solve/joint_rule.h"
#include "engine/solve/joint_velocities.h"

namespace plumb {

/// A scalar coordinate and up to four rules on it. They share one Jacobian, so that J v is evaluated once and
/// the impulses are applied once.
template <class Real, bool kAngular>
struct JointCoordinate {
  struct Solved {
    RowTerm<Real> term[2];
  };
  int count = 0;
  Real inverse_mass = 0;  ///< J M^-1 J^T
  JointRow<Real> row{};   ///< of kAngular: not used
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
  void set_substep(const RowRules& rules, double h) {
    for (int i = 0; i < count; ++i) rule[i].set_substep(rules.rule[i], h);
  }
  void scale(Real factor) {
    for (int i = 0; i < count; ++i) rule[i].impulse *= factor;
  }

  /// lambda along +q of all rules.
  Real impulse() const {
    Real sum = 0;
    for (int i = 0; i < count; ++i) sum += rule[i].sign * rule[i].impulse;
    return sum;
  }

  /// `q`: the coordinate, at the pose of `row`.
  void evaluate(Real q, const JointVelocities<Real>& v, const JointStep<Real>& step, Real share) {
    if (count == 0) return;
    if constexpr (kAngular) {
      inverse_mass = v.i_a + v.i_b;
    } else {
      inverse_mass = v.inverse_mass(row, row);
    }
    const Real mass = inverse_mass > 0 ? 1 / inverse_mass : 0;
    for (int i = 0; i < count; ++i) rule[i].terms(q, mass, share, step, solved[i].term);
  }
  void warm_start(JointVelocities<Real>& v) const {
    if (count > 0) apply(v, impulse());
  }

  void solve(JointVelocities<Real>& v, JointPass pass) {
    if (count == 0) return;
    Real rate = along(v), sum = 0;
    for (int i = 0; i < count; ++i) {
      SolverRule<Real>& r = rule[i];
      const RowTerm<Real>& t = solved[i].term[pass];
      const Real wanted = r.impulse - t.mass * (r.sign * rate + t.bias) - t.scale * r.impulse;
      const Real total = std::min(std::max(wanted, r.lower()), r.most);
      const Real delta = r.sign * (total - r.impulse);
      r.impulse = total;
      rate += inverse_mass * delta;
      sum += delta;
    }
    apply(v, sum);
  }

 private:
  Real along(const JointVelocities<Real>& v) const {
    if constexpr (kAngular) {
      return v.w_b - v.w_a;
    } else {
      return v.along(row);
    }
  }
  void apply(JointVelocities<Real>& v, Real impulse) const {
    if constexpr (kAngular) {
      v.w_a -= v.i_a * impulse;
      v.w_b += v.i_b * impulse;
    } else {
      v.apply(row, impulse);
    }
  }
};

}  // namespace plumb
