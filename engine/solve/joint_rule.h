#pragma once

#include <limits>

#include "engine/joints/joint_row.h"
#include "engine/solve/body_motion.h"
#include "engine/solve/joint_set.h"

namespace plumb {

/// Which of the two solutions of a substep: with bias, or without.
enum JointPass { kSolve = 0, kRelax = 1 };

/// What one solution asks of a row: delta = -mass (J v + bias) - scale impulse.
template <class Real>
struct RowTerm {
  Real bias = 0, mass = 0, scale = 0;
};

/// A rule ready for its role: parameters rounded to Real, and its spring for the substep.
template <class Real>
struct SolverRule {
  RowRole role = RowRole::Rigid;
  Real sign = 1, origin = 0, speed = 0;
  Real most = std::numeric_limits<Real>::infinity();  ///< N s or N m s, in a substep
  Softness<Real> spring{};
  Real impulse = 0;

  /// Takes another rule's parameters; the impulse stays where it still means the same.
  void load(const RowRule& rule) {
    const Real new_sign = static_cast<Real>(rule.sign);
    if (rule.role != role || new_sign != sign) impulse = 0;
    role = rule.role;
    sign = new_sign;
    origin = static_cast<Real>(rule.origin);
    speed = static_cast<Real>(rule.speed);
  }
  void set_substep(const RowRule& rule, double h) {
    most = static_cast<Real>(rule.max_force * h);
    if (role == RowRole::Spring) spring = softness<Real>(rule.spring.hertz, rule.spring.damping_ratio, h);
  }

  /// Both terms for a coordinate at `q` whose effective mass is `whole_mass`, at the poses after a substep:
  /// `relax` of this substep, `solve` of the next one. A spring's force belongs to where the substep began.
  void terms(Real q, Real whole_mass, Real share, const JointStep<Real>& step,
             RowTerm<Real> (&term)[2]) const {
    const Real c = sign * (q - origin);
    const Real mass = share * whole_mass;
    // A reduced share must not change what a spring comes to: all of it is reduced.
    const Softness<Real>& rigid = step.softness;
    const RowTerm<Real> pull =
        role == RowRole::Spring
            ? RowTerm<Real>{spring.bias_rate * c, mass * spring.mass_scale, share * spring.impulse_scale}
            : RowTerm<Real>{share * rigid.bias_rate * c, mass * rigid.mass_scale, rigid.impulse_scale};
    const RowTerm<Real> hold{0, mass, 0};
    switch (role) {
      case RowRole::Rigid:
        term[kSolve] = pull, term[kRelax] = hold;
        return;
      case RowRole::Spring:
        term[kRelax] = {term[kSolve].bias, pull.mass, pull.scale}, term[kSolve] = pull;
        return;
      case RowRole::Limit:
        // While it is open it may close within the substep, and no faster.
        if (c > 0) {
          term[kSolve] = term[kRelax] = {c * step.inverse_h, mass, 0};
        } else {
          term[kSolve] = pull, term[kRelax] = hold;
        }
        return;
      case RowRole::Motor:
        term[kSolve] = term[kRelax] = {-speed, mass, 0};
        return;
    }
  }
  Real lower() const { return role == RowRole::Limit ? 0 : -most; }
};

}  // namespace plumb
