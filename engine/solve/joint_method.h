#pragma once

#include <span>

#include "engine/solve/bodies.h"

namespace plumb {

/// A way to hold joints. `hold` works before bodies move, so that the joints fit where the bodies arrive;
/// `relax` afterwards, so that the velocities fit as well: J v = 0. `follow` does both at once with feedback
/// of the gap, as the Euler steppers of the course do. One virtual call a sweep over all joints.
template <class Real>
class JointMethod {
 public:
  virtual ~JointMethod() = default;

  /// Before anything changes in a substep.
  virtual void begin_substep(const Bodies<Real>& bodies, Real h) = 0;

  virtual void begin_hold(Bodies<Real>& bodies, Real h) = 0;
  virtual void sweep_hold(Bodies<Real>& bodies, Real h) = 0;
  virtual void finish_hold(Bodies<Real>& bodies, Real h) = 0;

  /// Closes the joints of bodies that were moved, by moving them: velocities stay.
  virtual void settle(Bodies<Real>& bodies) = 0;

  virtual void begin_relax(Bodies<Real>& bodies) = 0;
  virtual void sweep_relax(Bodies<Real>& bodies) = 0;

  virtual void begin_follow(Bodies<Real>& bodies, Real h) = 0;
  virtual void sweep_follow(Bodies<Real>& bodies) = 0;

  /// Whether a sudden impulse on `body` is passed on by its joints at once.
  virtual bool passes_on(int body) const = 0;
  /// Adds to a jump of velocities, by body, what the joints' impulses make of it: J dv = 0.
  virtual void pass_on(const Bodies<Real>& bodies, std::span<Twist<Real>> jump) = 0;

  /// The bodies were put somewhere else.
  virtual void forget() = 0;
  /// Impulses that the next substep starts from.
  virtual std::span<Real> memory() = 0;
};

}  // namespace plumb
