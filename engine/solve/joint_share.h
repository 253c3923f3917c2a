#pragma once

#include <algorithm>

namespace plumb {

/// From how many joints of one body on the share of a joint is looked at.
inline constexpr int kManyJoints = 3;

/// How much a body and the other one give way at a joint: the parts of J M^-1 J^T.
template <class Real>
struct JointMobility {
  Real a = 0, b = 0;
};

/// The share of its impulses that a joint applies at a time. Sequential impulses that are started from the
/// last ones, and pull errors back, grow without bound where many joints share a light body: each undoes what
/// all the others did. The other joints of a body undo (count - 1) times the body's part of the mobility;
/// beyond kLoad of that, impulses and the pull are reduced in proportion. kLoad is the largest for which the
/// linear model of a star of 3 to 40 bodies, hub a tenth to a hundred times as light, is stable: its spectral
/// radius stays below 1 (at 2 it reaches 1.007). Chains, and nets of equal bodies, are below it.
template <class Real>
Real joint_share(JointMobility<Real> mobility, int count_a, int count_b) {
  constexpr Real kLoad = 1.5;
  const Real sum = mobility.a + mobility.b;
  const Real load =
      std::max(static_cast<Real>(count_a - 1) * mobility.a, static_cast<Real>(count_b - 1) * mobility.b);
  return load > kLoad * sum ? kLoad * sum / load : 1;
}

}  // namespace plumb
