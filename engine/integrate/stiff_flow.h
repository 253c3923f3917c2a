#pragma once

#include <span>

#include "engine/integrate/flow.h"

namespace plumb {

/// An equation for implicit methods, which provides its Jacobian J = d(rate)/dy, possibly approximate.
class StiffFlow : public Flow {
 public:
  /// The two systems that an implicit method solves: of its stages together, and of its error estimate.
  enum class Use { Stages, Estimate };

  /// Computes J at (time, y).
  virtual void linearise(double time, std::span<const double> y) = 0;

  /// Factorises I - h A (x) J with the matrix `a` of stages x stages numbers, row by row. Returns false if it
  /// is singular.
  virtual bool factor(Use use, std::span<const double> a, int stages, double h) = 0;

  /// Solves x_i - h sum_j a_ij J x_j = r_i in place; x holds stage after stage.
  virtual void solve(Use use, std::span<double> x) = 0;
};

}  // namespace plumb
