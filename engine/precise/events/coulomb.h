#pragma once

#include <cstddef>
#include <vector>

namespace plumb {

/// Contact points with Coulomb friction as one complementarity problem: at the level of accelerations
/// (forces) or of velocities (impulses). With lambda the normal forces, tau the tangential ones, and a, b the
/// resulting normal and tangential rates,
///     a >= 0,  lambda >= 0,  a lambda = 0,
///     |tau| <= m = m0 + mu sum of lambda;  b > 0 only with tau = -m, b < 0 only with tau = +m.
/// Points of the same two shapes on one tangent line form one patch with one tangential force, because its
/// distribution among them changes nothing. A patch without points is a force of bounded size, such as that
/// of a motor or a brake. A point of a patch without friction is a force that only pushes, such as that of a
/// limit.
struct CoulombProblem {
  struct Patch {
    double friction = 0;     ///< Coulomb's coefficient
    int slip_direction = 0;  ///< +1, -1: slips in this direction for any rate; 0: may stick
    double bound = 0;        ///< m0, N: limit of the tangential force without any normal force
  };
  std::vector<int> patch_of;  ///< by point
  std::vector<Patch> patches;
  /// Points + patches rows and columns: the change of a rate (normals first, then tangents) by a unit force.
  /// Positive semidefinite.
  std::vector<double> response;
  std::vector<double> rate;  ///< by row: without these forces

  std::size_t points() const { return patch_of.size(); }
  std::size_t size() const { return patch_of.size() + patches.size(); }
};

struct CoulombSolution {
  bool solved = false;        ///< false: there is no solution, or none was reached
  std::vector<double> force;  ///< by row: normals first, then tangents
  std::vector<double> rate;   ///< by row: with the forces
  std::vector<char> active;   ///< by point: a = 0 determines its force, which may be zero
  std::vector<int> mode;      ///< by patch: 0 sticks, +1 and -1 slips in that direction
  bool ambiguous = false;     ///< a slipping point responds to its own force in the wrong direction: several
                              ///< solutions may exist
};

/// Solves by Lemke's method (`solve_complementarity`), in quantities scaled by the response of each row.
CoulombSolution solve_coulomb(const CoulombProblem& problem);

}  // namespace plumb
