#pragma once

#include "engine/math/vec2.h"

namespace plumb {

/// Force and torque on a body, about its centre of mass.
template <class Real>
struct Wrench {
  Vec2<Real> force{};  ///< N
  Real torque = 0;     ///< N m

  constexpr Wrench& operator+=(const Wrench& b) { return force += b.force, torque += b.torque, *this; }
  friend constexpr Wrench operator*(Real s, const Wrench& a) { return {s * a.force, s * a.torque}; }
};

}  // namespace plumb
