#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/joints/joint_angle.h"
#include "engine/joints/joint_row.h"
#include "engine/math/lanes.h"
#include "engine/world/contact_solver/solver_body.h"
#include "engine/world/joint_solver/joint_set.h"

namespace plumb {

/// The two solutions of a substep: with bias, or without.
enum JointPass { kSolve = 0, kRelax = 1 };

// These functions of a substep are always inlined, because `Real` may be Lanes: several joints side by side,
// whose rules have the same roles.

/// Coefficients of a row in one solution: delta = -mass (J v + bias) - scale impulse.
template <class Real>
struct RowTerm {
  Real bias = 0, mass = 0, scale = 0;
};

/// Returns `yes` where the mask is set, `no` elsewhere.
template <class Mask, class Real>
[[gnu::always_inline]] inline RowTerm<Real> select_term(const Mask& mask, const RowTerm<Real>& yes,
                                                        const RowTerm<Real>& no) {
  return {select(mask, yes.bias, no.bias), select(mask, yes.mass, no.mass),
          select(mask, yes.scale, no.scale)};
}

/// Under-relaxation of a joint that shares bodies with others.
template <class Real>
struct UnderRelaxation {
  Real factor = 1;        ///< fraction of its impulses that is applied at a time
  bool isolated = false;  ///< no other joint moves its bodies

  [[gnu::always_inline]] Real max_stiffness(Scalar<Real> shared) const {
    return isolated ? Real(std::numeric_limits<Scalar<Real>>::infinity()) : shared * factor;
  }
};

/// A damped spring in a substep h, implicit Euler: J v' + rate C + compliance lambda' = 0 along its row,
/// which is lambda' = -h (k (C + h J v') + c J v').
template <class Real>
struct SpringTerm {
  Real rate = 0;        ///< 1/s: k / (c + h k)
  Real compliance = 0;  ///< 1/kg or 1/(kg m^2): 1 / (h (c + h k))
};

/// Computes it with omega = 2 pi hertz, k = omega^2 / mobility and c = 2 zeta omega / mobility, which are
/// constant: `mobility` is that at the joint's reference (spring_stiffness.h). A spring that moves nothing
/// there yields to anything.
template <class Real>
SpringTerm<Real> spring_term(const Spring& spring, double mobility, double h) {
  constexpr double kMaxCompliance = std::numeric_limits<Real>::max() / 4;  // finite when added to a mobility
  const double omega = kTwoPi * spring.hertz;
  const double a = 2 * spring.damping_ratio + h * omega;
  const double compliance =
      mobility > 0 ? std::min(mobility / (h * omega * a), kMaxCompliance) : kMaxCompliance;
  return {static_cast<Real>(omega / a), static_cast<Real>(compliance)};
}

/// A spring too stiff for sequential impulses: h (c + h k) times the mobility is above
/// `JointStep::max_stiffness`. The error of an iteration would return through the gap with equal force, and
/// grow from substep to substep. So the spring is treated like rigid rows: its bias is limited to theirs, and
/// it is relaxed. While it is softer than they are, it rests at the deflection of its load.
template <class Real>
struct StiffSpring {
  Real rate = 0, mass_scale = 1, impulse_scale = 0;

  [[gnu::always_inline]] StiffSpring(const SpringTerm<Real>& spring, Real stiffness_ratio, Real factor,
                                     const JointStep<Scalar<Real>>& step) {
    using std::max, std::min, std::sqrt;
    const Softness<Scalar<Real>>& rigid = step.softness;
    // h^2 k and h c, times the mobility.
    const Real max_elastic = rigid.impulse_scale > 0
                                 ? step.h * step.stiff_rate * rigid.mass_scale / rigid.impulse_scale
                                 : step.max_stiffness;
    const Real elastic = step.h * spring.rate * stiffness_ratio;
    const Real k = min(elastic, max_elastic);
    // Keeps the settling time c / k if k was reduced.
    const Real damping = select(elastic > Real(0),
                                Real(max(Real(stiffness_ratio - elastic), Real(0)) * (k / elastic)), Real(0));
    // Largest damping for which a star of a hundred is stable.
    constexpr Scalar<Real> kMaxDamping = 10;
    const Real c = select(factor < Real(1), Real(min(damping, Real(2 * kMaxDamping * sqrt(k)))), damping);
    const Real held = max(Real(k + c), Real(k / (step.h * step.stiff_rate)));
    rate = k / (step.h * held);
    mass_scale = held / (1 + held);
    impulse_scale = 1 / (1 + held);
  }
};

/// A rule prepared for its role: parameters rounded to Real, and its spring for the substep.
template <class Real>
struct SolverRule {
  RowRole role = RowRole::Rigid;
  Real sign = 1, origin = 0, speed = 0;
  Real max_impulse = std::numeric_limits<Scalar<Real>>::infinity();  ///< N s or N m s, in a substep
  SpringTerm<Real> spring{};
  Real impulse = 0;
  /// m or rad: deviation of a motor from its target motion, summed while its force suffices.
  Real drift = 0;
  Real last = 0;  ///< of a motor: coordinate at the last update of `drift`

  /// Loads another rule's parameters; keeps the impulse if it is still valid.
  void load(const RowRule& rule) {
    const Real new_sign = static_cast<Real>(rule.sign);
    if (rule.role != role || new_sign != sign) impulse = drift = 0;
    role = rule.role;
    sign = new_sign;
    origin = static_cast<Real>(rule.origin);
    speed = static_cast<Real>(rule.speed);
  }
  void set_substep(const RowRule& rule, double spring_mobility, double h) {
    max_impulse = static_cast<Real>(rule.max_force * h);
    if (role == RowRole::Spring) spring = spring_term<Real>(rule.spring, spring_mobility, h);
  }

  /// Updates a motor's drift over a substep that ended at `q`.
  [[gnu::always_inline]] void update_drift(Real q, Scalar<Real> h) {
    if (role != RowRole::Motor) return;
    using std::max;
    const Real size = max(impulse, Real(-impulse));
    drift = select(size < max_impulse, Real(drift + sign * (q - last) - speed * h), Real(0));
    last = q;
  }

  /// Computes both terms for a coordinate at `q` with the given mobility, at the poses after a substep:
  /// `relax` of this substep, `solve` of the next one. A spring's force belongs to the pose at the start of
  /// the substep: one impulse per substep, in both passes.
  [[gnu::always_inline]] void terms(Real q, Real mobility, UnderRelaxation<Real> relaxation,
                                    const JointStep<Scalar<Real>>& step, RowTerm<Real> (&term)[2]) const {
    const Real factor = relaxation.factor;
    const Real c = sign * (q - origin);
    const auto moves = mobility > Real(0);
    const Real mass = select(moves, Real(factor / mobility), Real(0));
    const Softness<Scalar<Real>>& rigid = step.softness;
    const RowTerm<Real> biased{factor * rigid.bias_rate * c, mass * rigid.mass_scale, rigid.impulse_scale};
    const RowTerm<Real> unbiased{0, mass, 0};
    switch (role) {
      case RowRole::Rigid:
        term[kSolve] = biased, term[kRelax] = unbiased;
        return;
      case RowRole::Spring: {
        using std::max;
        constexpr Scalar<Real> kMaxStiffnessRatio =
            Scalar<Real>(1e12);  // beyond it a spring is rigid to rounding
        const Real compliance = max(spring.compliance, Real(mobility / kMaxStiffnessRatio));
        const Real inverse = select(moves, Real(Real(1) / (mobility + compliance)), Real(0));
        term[kRelax] = {term[kSolve].bias, inverse, compliance * inverse};
        term[kSolve] = {spring.rate * c, inverse, compliance * inverse};
        if (const auto is_stiff = mobility > relaxation.max_stiffness(step.max_stiffness) * compliance;
            any(is_stiff)) [[unlikely]] {
          const StiffSpring<Real> stiff(spring, mobility / compliance, factor, step);
          term[kSolve] =
              select_term(is_stiff, {factor * stiff.rate * c, mass * stiff.mass_scale, stiff.impulse_scale},
                          term[kSolve]);
          term[kRelax] = select_term(is_stiff, unbiased, term[kRelax]);
        }
        return;
      }
      case RowRole::Limit: {
        // An open limit may close within the substep, but no faster.
        const auto open = c > Real(0);
        const RowTerm<Real> close{c * step.inverse_h, mass, 0};
        term[kSolve] = select_term(open, close, biased), term[kRelax] = select_term(open, close, unbiased);
        return;
      }
      case RowRole::Motor:
        // As for rigid rows, use decaying impulses and position feedback. With undiminished impulses, legs
        // with many held hips would oscillate with growing amplitude.
        term[kSolve] = term[kRelax] = {-speed, mass, 0};
        if (!relaxation.isolated)
          term[kSolve] = {factor * rigid.bias_rate * drift - speed, biased.mass, biased.scale};
        return;
    }
  }
  [[gnu::always_inline]] Real lower() const { return role == RowRole::Limit ? Real(0) : Real(-max_impulse); }
};

}  // namespace plumb
