#pragma once

#include <span>
#include <vector>

#include "engine/solve/contact.h"

namespace plumb {

/// What the contact passes need to know besides the bodies.
template <class Real>
struct ContactSettings {
  bool friction = true;            ///< false where no pair has any
  bool two_passes = true;          ///< hold and relax in turn; false: collide alone
  Real gravity = 0;                ///< m/s^2, its size
  Real restitution_threshold = 0;  ///< m/s, slower impacts do not bounce
};

/// Sequential impulses (Catto 2006) on contacts, in three kinds of pass. Each keeps the normal velocity above
/// a bound with impulses that only push, and the tangential one at zero with friction in the Coulomb cone.
///  - hold: before bodies move, so that no separation falls below zero: v_n >= -s/h; overlaps are pushed out.
///  - relax: after they have moved, v_n >= 0 for what touches; takes back the velocity that pushing out gave.
///  The
///    cone and the "only push" hold for the sum of both passes' impulses, which is the substep's.
///  - collide: both at once, with restitution, as the Euler steppers of the course do.
template <class Real>
class ContactSolver {
 public:
  explicit ContactSolver(ContactSettings<Real> settings) : settings_(settings) {}

  void begin_hold(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                  Bodies<Real>& bodies, Real h);
  void sweep_hold(std::vector<Contact<Real>>& contacts, Bodies<Real>& bodies);

  /// Moves bodies apart that overlap, by a share of it. Not their velocities, and nothing is remembered: an
  /// impulse that pushes out and is carried over to the next substep would swing tall stacks. Returns whether
  /// anything moved.
  bool push_out(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                Bodies<Real>& bodies, Real h) const;

  void begin_relax(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                   Bodies<Real>& bodies, Real h);
  void sweep_relax(std::vector<Contact<Real>>& contacts, Bodies<Real>& bodies);
  void begin_collide(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                     Bodies<Real>& bodies, Real h, bool restitution);

  /// Whether any contact is in the present pass.
  bool idle() const { return active_.empty(); }

  /// Approach speed, m/s, above which the pair has an impact.
  Real impact_speed(const Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const;

 private:
  bool bounces(const Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const;
  bool meets(const Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const;
  bool admit(Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const;

  ContactSettings<Real> settings_;
  std::vector<int> active_;  // contacts of the present pass, in order
};

/// When, into a substep of length `h`, point `index` of `contact` reaches separation zero, not before `from`;
/// Newton's method on its separation. A time above `h` where it does not. `contact` is left at that time.
template <class Real>
Real time_of_contact(Contact<Real>& contact, int index, std::span<const SolidShape<Real>> shapes,
                     const Bodies<Real>& bodies, Real from, Real h);

}  // namespace plumb
