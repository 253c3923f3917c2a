#pragma once

#include "scenarios/truth/motion.h"

namespace plumb::scenarios::truth {

/// Position and velocity of one coordinate.
struct Swing {
  Real place = 0, rate = 0;
};

/// Returns the solution of x'' = -w^2 x - 2 zeta w x' from `start`, for any damping ratio `zeta` >= 0. With
/// d = w sqrt|1 - zeta^2|: x = e^(-zeta w t) (x0 c + (v0 + zeta w x0) s), where (c, s) is (cos d t, sin d
/// t/d) below the critical damping, (1, t) at it, and (cosh d t, sinh d t/d) above. Source: any mechanics
/// text, e.g. Taylor, Classical Mechanics, 5.4.
Swing damped_swing(Swing start, Real w, Real zeta, Real time);

/// Returns the displacement of mass `j` from equilibrium, of `count` equal masses between walls, joined by
/// equal springs of k/m = w^2, when the first one is released at `pulled`: the sum of the modes sin(i k
/// pi/(count + 1)) of w_k = 2 w sin(k pi/(2 (count + 1))). Source: Goldstein, Classical Mechanics, ch. 6.
Swing chain_swing(int count, int j, Real w, Real pulled, Real time);

}  // namespace plumb::scenarios::truth
