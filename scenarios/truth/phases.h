#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/trajectory.h"

namespace plumb::scenarios::truth {

/// Part of a motion that one law governs.
struct Phase {
  Trajectory::Law law;
  /// Positive within the phase, zero or negative after it; absent: the phase does not end.
  std::function<Real(const Trajectory::State&)> until{};
  /// Turns the last state into the first one of the next phase; absent: it is the same.
  std::function<Trajectory::State(const Trajectory::State&)> then{};
};

/// Motion that changes its law at events, each located by bisection on its trajectory.
class Phases {
 public:
  /// `horizon`: time up to which ends of phases are searched for, s. `spacing` of the search: an event
  /// function that is negative for less than that may be missed.
  Phases(Trajectory::State start, std::vector<Phase> phases, Real horizon, Real spacing = 1.0L / 64);

  Trajectory::State at(Real time) const;

  /// Returns the times at which phases end, s.
  const std::vector<double>& ends() const { return ends_; }

  /// Returns those of them at which the state jumps, s.
  const std::vector<double>& jumps() const { return jumps_; }

 private:
  struct Part {
    Real start;
    std::shared_ptr<const Trajectory> path;
  };
  std::vector<Part> parts_;
  std::vector<double> ends_, jumps_;
};

/// Returns the truth of the one dynamic body of `scene`, whose centre moves on a circle about `pivot`: at
/// (angle, rate) = `path` it is at pivot + `arm` rotated by the angle. The body rotates with the arm if
/// `turns`. Its impacts are the jumps of the path.
Truth turning_truth(const Scene& scene, std::string source, const Phases& path, Vec2<Real> pivot,
                    Vec2<Real> arm, bool turns = true);

/// Returns the law of y = (q, q') with q'' = `acceleration`(q, q').
Trajectory::Law second_order_law(std::function<Real(Real q, Real rate)> acceleration);

}  // namespace plumb::scenarios::truth
