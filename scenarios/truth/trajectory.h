#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "scenarios/truth/motion.h"

namespace plumb::scenarios::truth {

/// Solution of y' = f(y) from y(0), at any time, to the last few digits of extended precision: the
/// eighth-order Runge-Kutta-Fehlberg method of Boost.Odeint with error control. States are kept on a grid,
/// extended when needed; a time in between is integrated from the grid point before it. So the answer does
/// not depend on the order of the calls. Not thread-safe.
class Trajectory {
 public:
  using State = std::vector<Real>;
  using Law = std::function<void(const State& y, State& rate)>;

  /// 1e-15, or the smallest tolerance above the rounding errors of `Real`.
  static constexpr Real kTolerance =
      std::max<Real>(Real(1e-15L), 4096 * std::numeric_limits<Real>::epsilon());

  /// `spacing` of the grid, s; also the largest step. `tolerance` is the local error per step, relative to 1
  /// + |y|.
  Trajectory(State start, Law law, Real spacing, Real tolerance = kTolerance);

  State at(Real time) const;

 private:
  void advance(State& y, Real from, Real to) const;

  Law law_;
  Real spacing_, tolerance_;
  mutable std::vector<State> grid_;
};

}  // namespace plumb::scenarios::truth
