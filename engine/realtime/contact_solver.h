#pragma once

#include <span>
#include <vector>

#include "engine/realtime/contact.h"

namespace plumb {

/// Settings of the contact passes.
template <class Real>
struct ContactSettings {
  bool friction = true;            ///< false if no pair has friction
  bool two_passes = true;          ///< hold and relax in turn; false: collide only
  Real gravity = 0;                ///< m/s^2, magnitude
  Real restitution_threshold = 0;  ///< m/s, slower impacts do not bounce
};

/// Sequential impulses (Catto 2006) on contacts, in three kinds of pass. Each keeps the normal velocity above
/// a bound with impulses that only push, and the tangential one at zero with friction in the Coulomb cone.
///  - hold: before bodies move, v_n >= -s/h, so that no separation falls below zero; pushes overlaps out.
///  - relax: after they have moved, v_n >= 0 for touching points; removes the velocity of the push-out.
///  - collide: both together, with restitution, as the Euler steppers of the course do.
/// The cone and "only push" hold for the sum of the impulses of hold and relax, which is the substep's.
template <class Real>
class ContactSolver {
 public:
  explicit ContactSolver(ContactSettings<Real> settings) : settings_(settings) {}

  void begin_hold(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                  Bodies<Real>& bodies, Real h);
  void sweep_hold(std::vector<Contact<Real>>& contacts, Bodies<Real>& bodies);

  /// Moves overlapping bodies apart by a fraction of the overlap. Velocities are not changed and no impulse
  /// is stored: warm starting with these impulses would sway tall stacks. Returns true if anything moved.
  bool push_out(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                Bodies<Real>& bodies, Real h) const;

  void begin_relax(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                   Bodies<Real>& bodies, Real h);
  void sweep_relax(std::vector<Contact<Real>>& contacts, Bodies<Real>& bodies);
  void begin_collide(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                     Bodies<Real>& bodies, Real h, bool restitution);

  /// Returns true if no contact is in the present pass.
  bool idle() const { return active_.empty(); }

  /// Returns the approach speed above which the pair has an impact, m/s.
  Real impact_speed(const Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const;

 private:
  bool bounces(const Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const;
  bool meets(const Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const;
  bool admit(Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const;

  ContactSettings<Real> settings_;
  std::vector<int> active_;  // contacts of the present pass, in order
};

/// Returns the time, into a substep of length `h` and not before `from`, at which point `index` of `contact`
/// reaches separation zero; above `h` if it does not. Uses Newton's method on the separation. `contact` is
/// left at that time.
template <class Real>
Real time_of_contact(Contact<Real>& contact, int index, std::span<const SolidShape<Real>> shapes,
                     const Bodies<Real>& bodies, Real from, Real h);

}  // namespace plumb
