#pragma once

#include <cstddef>
#include <vector>

namespace plumb {

/// Points that touch, and Coulomb's law between them, as one complementarity problem: at the level of
/// accelerations (forces) or of velocities (impulses). With lambda the normal forces, tau the tangential ones
/// and a, b the normal and tangential rates that they lead to,
///   a >= 0,  lambda >= 0,  a lambda = 0,
///   |tau| <= m = m0 + mu sum of lambda;  b > 0 only with tau = -m, b < 0 only with tau = +m.
/// Points of the same two shapes that share their tangent line are one patch with one tangential force: how
/// it is divided among them changes nothing. A patch without points is a force of bounded size, as a motor's
/// or a brake's; a point of a patch without friction is a force that pushes, as a limit's.
struct CoulombProblem {
  struct Patch {
    double friction = 0;  ///< Coulomb's coefficient
    int slip = 0;         ///< +1, -1: it slips in this direction, whatever its rate; 0: it may stick
    double bound = 0;     ///< m0, N: what the tangential force may be without any normal force
  };
  std::vector<int> patch_of;  ///< by point
  std::vector<Patch> patches;
  /// Of points + patches rows and columns: the change of a rate (normals first, then tangents) by a unit
  /// force. Positive semidefinite.
  std::vector<double> response;
  std::vector<double> rate;  ///< by row: without any of the forces

  std::size_t points() const { return patch_of.size(); }
  std::size_t size() const { return patch_of.size() + patches.size(); }
};

struct CoulombSolution {
  bool solved = false;        ///< false: there is none, or none was reached
  std::vector<double> force;  ///< by row: normals first, then tangents
  std::vector<double> rate;   ///< by row: with the forces
  std::vector<char> pushes;   ///< by point: its force is determined by a = 0 (and may be zero all the same)
  std::vector<int> mode;      ///< by patch: 0 sticks, +1 and -1 slips in that direction
  bool ambiguous = false;     ///< a slipping point's own response is negative: further solutions may exist
};

/// Pivots by Lemke's method (`solve_complementarity`), in quantities scaled by the response of each row.
CoulombSolution solve_coulomb(const CoulombProblem& problem);

}  // namespace plumb
