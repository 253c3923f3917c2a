#pragma once

#include <algorithm>
#include <cmath>

#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/contact_solver/solver_body.h"

/// Contacts of bodies with one locked axis. Such a body has no velocity along it, and impulses do not change
/// that: the component is 0 in its rows of the Jacobian. Bodies with both axes locked have no inverse mass,
/// and need none of this, unless others drive them (`driver_compliance`).
namespace plumb {

/// Bits of ContactConstraint::locks.
enum ContactLock : unsigned {
  kLockAX = 1,
  kLockAY = 2,
  kLockBX = 4,
  kLockBY = 8,
  kOneFreedom = 16,  ///< the normal's row has what friction does (`update_friction_row`)
  kJams = 32,        ///< they depend on each other, and friction permits no sliding
  kPinned = 64       ///< a body with both axes locked, which only rotates, may be driven
};

/// Returns a direction without the components along the locked axes of body a, or of body b.
template <class Vec>
Vec free_of_a(Vec direction, unsigned locks) {
  if (locks == 0) return direction;
  if ((locks & kLockAX) != 0) direction.x = 0;
  if ((locks & kLockAY) != 0) direction.y = 0;
  return direction;
}
template <class Vec>
Vec free_of_b(Vec direction, unsigned locks) {
  return free_of_a(direction, locks / kLockBX);
}

/// Returns the relative velocity along `row` that a unit impulse along `direction` gives two bodies that do
/// not rotate, 1/kg. Both are unit vectors, either equal or perpendicular.
template <class Number, class Real>
Number linear_response(const SolverBody<Real>& a, const SolverBody<Real>& b, unsigned locks, Vec2<Number> row,
                       Vec2<Number> direction, bool same) {
  if (locks == 0) return same ? Number(a.inverse_mass) + Number(b.inverse_mass) : Number(0);
  return Number(a.inverse_mass) * dot(free_of_a(row, locks), direction) +
         Number(b.inverse_mass) * dot(free_of_b(row, locks), direction);
}

/// Mobility, as a fraction of the largest, up to which a row is blocked or two rows depend on each other: a
/// thousandth of a radian, squared. The rest is mostly rounding of the rows' directions.
inline constexpr double kDependentRows = 1e-6;

/// Returns the mobility, 1/kg, up to which locked axes block a row, given the squares of the arms of
/// its point: a millionth of the largest of any row there. The row is then a thousandth of a radian or less
/// off what is locked, and the rest is mostly rounding of its direction. Its impulse would be up to the
/// inverse of that rounding times the load, and act along what is free.
template <class Real>
Real least_mobility(const SolverBody<Real>& a, const SolverBody<Real>& b, Real arm_a_squared,
                    Real arm_b_squared) {
  return Real(kDependentRows) * (a.inverse_mass + b.inverse_mass + a.inverse_inertia * arm_a_squared +
                                 b.inverse_inertia * arm_b_squared);
}

/// Returns the mobility between a contact's normal and tangent, 1/kg: the relative velocity along one that a
/// unit impulse along the other gives, at a point with the arm `arm_a` and `arm_b` along n.
template <class Real>
Real friction_coupling(const SolverBody<Real>& a, const SolverBody<Real>& b, const ContactConstraint<Real>& c,
                       Real arm_a, Real arm_b) {
  const Vec2<Real> n = c.normal, t{n.y, -n.x};
  return linear_response(a, b, c.locks, n, t, false) + a.inverse_inertia * arm_a * c.arm_tangent_a +
         b.inverse_inertia * arm_b * c.arm_tangent_b;
}

/// Returns true if impulses move a body, or nothing does.
template <class Real>
bool moves_by_impulses_alone(const SolverBody<Real>& body) {
  return is_dynamic(body) || (body.velocity == Vec2<Real>{} && body.angular_velocity == 0);
}

/// Compliance of driven contacts and of corrections, as a fraction of the mobility that a locked axis takes
/// from their row. Of 8,000 boxes with a locked x that a box pushes at v, the fastest gets 500 v without it,
/// 60 v with 0.03, 40 v with 0.05 and 28 v with 0.1. A bead on a rail that a slope of 60 degrees lifts is
/// slower by 3 mm/s with 0.03, 6 mm/s with 0.05 and 12 mm/s with 0.1 than the slope, in substeps of 1/240 s.
inline constexpr double kLockCompliance = 0.05;

enum class ContactRow { Normal, Friction };

/// Returns the compliance of a contact's row if one body has locked axes and the other moves as told, or its
/// surface does, 1/kg: a fraction of the mobility that the locks take from the row. (Of a body that only
/// rotates, that is the mobility across the row.) A rigid row moves the locked body along what is free at the
/// speed of its driver over the sine of the angle between the row and what is locked, and where friction or a
/// second point leaves no freedom, impulses grow from step to step and throw the body once they lose their
/// balance.
template <class Real>
Real driver_compliance(const SolverBody<Real>& a, const SolverBody<Real>& b, const ContactConstraint<Real>& c,
                       ContactRow which) {
  if (c.locks == 0) return 0;
  if (moves_by_impulses_alone(a) && moves_by_impulses_alone(b) && c.surface_speed == 0) return 0;
  const bool normal = which == ContactRow::Normal;
  const Vec2<Real> row = normal ? c.normal : Vec2<Real>{c.normal.y, -c.normal.x};
  Real lost = a.inverse_mass + b.inverse_mass - linear_response(a, b, c.locks, row, row, true);
  if ((c.locks & kPinned) != 0) {
    // The square of the arm across the row, and what a point nearer to the centre lacks of the other one's.
    const auto across = [&](const SolverBody<Real>& body, const Real(&arm)[2], Real arm_tangent) {
      if (body.inverse_mass > 0) return Real(0);
      const Real p = arm[0] * arm[0], q = c.count == 2 ? arm[1] * arm[1] : p;
      return body.inverse_inertia * (normal ? arm_tangent * arm_tangent + std::abs(p - q) : std::max(p, q));
    };
    lost += across(a, c.arm_a, c.arm_tangent_a) + across(b, c.arm_b, c.arm_tangent_b);
  }
  return Real(kLockCompliance) * lost;
}

/// Sets the friction row of a contact, or removes it if the bodies have only one freedom relative to each
/// other, as a bead on a rail has. Normal and friction then act along the same line of it: a body that the
/// normal has stopped does not slide, so friction has nothing left to do but to hold it when it would
/// rebound. If the cone of friction contains the direction that is blocked, the body jams (Painleve) and does
/// not rebound. Both rows together would depend on each other: only their difference acts, while the impulses
/// grow without a bound. Against a body that moves as told, the rows have different velocities: both are
/// kept. `k_n`, `k_t`: mobilities along normal and tangent, 1/kg, 0 if blocked.
template <class Real>
void update_friction_row(const SolverBody<Real>& a, const SolverBody<Real>& b, Real k_n, Real k_t,
                         ContactConstraint<Real>& c) {
  c.tangent_mass = k_t > 0 ? 1 / (k_t + driver_compliance(a, b, c, ContactRow::Friction)) : Real(0);
  unsigned locks = c.locks & ~(kOneFreedom | kJams);
  c.locks = static_cast<std::uint8_t>(locks);
  if (!(k_n > 0 && k_t > 0)) return;
  const Real k_nt = friction_coupling(a, b, c, c.arm_a[0], c.arm_b[0]);
  if (k_n * k_t - k_nt * k_nt > Real(kDependentRows) * k_n * k_t) return;
  if (moves_by_impulses_alone(a) && moves_by_impulses_alone(b) && c.surface_speed == 0) {
    c.tangent_mass = c.tangent_impulse = 0;
    locks |= kOneFreedom;
  }
  if (c.friction * k_t >= std::abs(k_nt)) locks |= kJams;
  c.locks = static_cast<std::uint8_t>(locks);
}

/// Returns the coefficient of restitution of a contact as it is: a jammed one does not rebound.
template <class Real>
Real effective_restitution(const ContactConstraint<Real>& c) {
  return (c.locks & kJams) != 0 ? Real(0) : c.restitution;
}

/// The axes of the bodies of a contact without locks: all are free.
struct AllAxes {
  template <class Vec>
  [[gnu::always_inline]] const Vec& of_a(const Vec& direction) const {
    return direction;
  }
  template <class Vec>
  [[gnu::always_inline]] const Vec& of_b(const Vec& direction) const {
    return direction;
  }
  template <class Number>
  [[gnu::always_inline]] static const Number& along_normal(const Number& rate, const Number&) {
    return rate;
  }
  template <class Number>
  [[gnu::always_inline]] static const Number& along_tangent(const Number& rate, const Number&) {
    return rate;
  }
};
/// The axes of the bodies of a contact with locks.
template <class Real>
struct FreeAxes {
  FreeAxes(const SolverBody<Real>& a, const SolverBody<Real>& b, const ContactConstraint<Real>& c)
      : locks(c.locks),
        normal_compliance(driver_compliance(a, b, c, ContactRow::Normal)),
        tangent_compliance(driver_compliance(a, b, c, ContactRow::Friction)) {}
  unsigned locks;
  Real normal_compliance, tangent_compliance;  ///< 1/kg, `driver_compliance`
  template <class Vec>
  Vec of_a(const Vec& direction) const {
    return free_of_a(direction, locks);
  }
  template <class Vec>
  Vec of_b(const Vec& direction) const {
    return free_of_b(direction, locks);
  }
  /// Returns the rate of a row without what its compliance takes up.
  Real along_normal(Real rate, Real impulse) const { return rate + normal_compliance * impulse; }
  Real along_tangent(Real rate, Real impulse) const { return rate + tangent_compliance * impulse; }
};

}  // namespace plumb
