#pragma once

#include <algorithm>

#include "engine/solve/joint_load.h"

namespace plumb {

/// From how many joints of one body on the share of a joint is looked at.
inline constexpr int kManyJoints = 3;

/// Returns the share of its impulses that a joint applies at a time. Sequential impulses that are started
/// from the last ones, and pull errors back, grow without bound where many joints share a light body: each
/// undoes what all the others did. The other joints of a body undo (count - 1) times the body's load; beyond
/// kLoad of that, impulses and the pull are reduced in proportion. The linear model of a star of 3 to 40
/// bodies, hinged or welded to a hub from a thousandth to ten times their mass, with arms of 0.5 to 10 times
/// its radius, is stable up to 2; at 2.5 its spectral radius reaches 1.03. Chains (1) and nets of equal
/// bodies (1.5) are below it.
template <class Real>
Real joint_share(JointLoad<Real> load, int count_a, int count_b) {
  constexpr Real kLoad = Real(1.6);
  const Real most =
      std::max(static_cast<Real>(count_a - 1) * load.a, static_cast<Real>(count_b - 1) * load.b);
  return most > kLoad ? kLoad / most : 1;
}

}  // namespace plumb
