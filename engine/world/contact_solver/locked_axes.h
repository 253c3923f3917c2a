#pragma once

#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/contact_solver/solver_body.h"

/// Contacts of bodies with one locked axis. Such a body has no velocity along it, and impulses do not change
/// that: the component is 0 in its rows of the Jacobian. Bodies with both axes locked have no inverse mass,
/// and need none of this.
namespace plumb {

/// Bits of ContactConstraint::locks.
enum ContactLock : unsigned { kLockAX = 1, kLockAY = 2, kLockBX = 4, kLockBY = 8 };

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

/// Returns the mobility, 1/kg, up to which locked axes block a row, given the squares of the arms of
/// its point: a millionth of the largest of any row there. The row is then a thousandth of a radian or less
/// off what is locked, and the rest is mostly rounding of its direction. Its impulse would be up to the
/// inverse of that rounding times the load, and act along what is free.
template <class Real>
Real least_mobility(const SolverBody<Real>& a, const SolverBody<Real>& b, Real arm_a_squared,
                    Real arm_b_squared) {
  return Real(1e-6) * (a.inverse_mass + b.inverse_mass + a.inverse_inertia * arm_a_squared +
                       b.inverse_inertia * arm_b_squared);
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
};
/// The axes of the bodies of a contact with locks.
struct FreeAxes {
  unsigned locks = 0;
  template <class Vec>
  Vec of_a(const Vec& direction) const {
    return free_of_a(direction, locks);
  }
  template <class Vec>
  Vec of_b(const Vec& direction) const {
    return free_of_b(direction, locks);
  }
};

}  // namespace plumb
