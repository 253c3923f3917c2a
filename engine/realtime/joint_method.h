#pragma once

#include <span>

#include "engine/realtime/bodies.h"

namespace plumb {

/// Interface of joint solvers. `hold` acts before bodies move, so that joints are closed at the new
/// positions. `relax` acts afterwards, so that velocities comply: J v = 0. `follow` does both together with
/// feedback of the gap, as the Euler steppers of the course do. One virtual call per iteration over all
/// joints.
template <class Real>
class JointMethod {
 public:
  virtual ~JointMethod() = default;

  /// Called before anything changes in a substep.
  virtual void begin_substep(const Bodies<Real>& bodies, Real h) = 0;

  virtual void begin_hold(Bodies<Real>& bodies, Real h) = 0;
  virtual void sweep_hold(Bodies<Real>& bodies, Real h) = 0;
  virtual void finish_hold(Bodies<Real>& bodies, Real h) = 0;

  /// Closes the joints of bodies that were displaced, by displacing them; velocities stay.
  virtual void settle(Bodies<Real>& bodies) = 0;

  virtual void begin_relax(Bodies<Real>& bodies) = 0;
  virtual void sweep_relax(Bodies<Real>& bodies) = 0;

  virtual void begin_follow(Bodies<Real>& bodies, Real h) = 0;
  virtual void sweep_follow(Bodies<Real>& bodies) = 0;

  /// Returns true if the joints of `body` pass on an impact at once.
  virtual bool passes_on(int body) const = 0;
  /// Adds the joints' response to a jump of velocities, by body: J dv = 0.
  virtual void pass_on(const Bodies<Real>& bodies, std::span<Twist<Real>> jump) = 0;

  /// Clears impulses, after bodies were repositioned.
  virtual void forget() = 0;
  /// Returns the impulses that warm-start the next substep.
  virtual std::span<Real> memory() = 0;
};

}  // namespace plumb
