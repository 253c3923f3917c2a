#pragma once

namespace plumb {

/// Up to two points of one contact at the time of impact, in contact coordinates: component 2 p is the normal
/// velocity of point p, 2 p + 1 its tangential one.
template <class Real>
struct Impact {
  int points = 0;
  Real restitution = 0;
  Real friction = 0;
  Real velocity[4] = {};     ///< m/s, before
  Real response[4][4] = {};  ///< 1/kg: change of component i for a unit impulse along j
};

/// Solves for the impulses, N s, of Newton's law of restitution (v_n >= -e v_n before) and Coulomb friction
/// (tangential restitution 0), which only push. Iterates projected Gauss-Seidel to rounding.
template <class Real>
void solve_impact(const Impact<Real>& impact, Real (&impulse)[4]);

}  // namespace plumb
