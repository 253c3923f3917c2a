#pragma once

#include <algorithm>

#include "engine/world/joint_solver/mobility_fraction.h"

namespace plumb {

/// Number of joints of one body from which on under-relaxation is considered.
inline constexpr int kUnderRelaxedJoints = 3;

/// Returns the under-relaxation factor of a joint's impulses. Sequential impulses with warm starting and bias
/// grow without bound if many joints share a light body, as each undoes the work of the others. The other
/// joints of a body undo (count - 1) times the body's load; above kMaxLoad, impulses and bias are reduced in
/// proportion. The linear model is a star of 3 to 40 bodies, hinged or welded to a hub. The hub has a
/// thousandth to ten times their mass, and the arms 0.5 to 10 times its radius. It is stable up to a kMaxLoad
/// of 2; at 2.5 its spectral radius reaches 1.03. Chains (1) and nets of equal bodies (1.5) are below it.
template <class Real>
Real under_relaxation_factor(MobilityFraction<Real> load, int count_a, int count_b) {
  constexpr Real kMaxLoad = Real(1.6);
  const Real max_load =
      std::max(static_cast<Real>(count_a - 1) * load.a, static_cast<Real>(count_b - 1) * load.b);
  return max_load > kMaxLoad ? kMaxLoad / max_load : 1;
}

}  // namespace plumb
