#pragma once

#include <span>
#include <vector>

namespace plumb {

/// The linear complementarity problem
///   w = M z + q,   w >= 0,   z >= 0,   w z = 0 in every component,
/// solved by Lemke's method with lexicographic pivots, which cannot cycle (R. W. Cottle, J.-S. Pang, R. E.
/// Stone, The Linear Complementarity Problem, 1992, algorithm 4.4.5 and section 4.9). The solution is basic:
/// the columns of M that belong to its positive components are independent.
struct ComplementaritySolution {
  enum class Status {
    Solved,
    Ray,  ///< ended on a ray: for contacts, there is no solution (Painleve), or the method does not reach it
    Limit,  ///< more than 50 pivots per component
  };
  Status status = Status::Solved;
  std::vector<double> z;
  std::vector<char> basic;  ///< z_i, not w_i, is in the basis; z_i may still be zero
  int pivots = 0;
};

/// Solves the problem. `matrix` is stored row by row; entries of M and q should be of order one. The solution
/// is checked, and after a failure other covering vectors are tried before `Ray` or `Limit` is returned.
ComplementaritySolution solve_complementarity(std::span<const double> matrix, std::span<const double> q);

}  // namespace plumb
