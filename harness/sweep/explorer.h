#pragma once

#include <map>
#include <optional>
#include <vector>

#include "harness/sweep/space.h"

namespace plumb::harness::sweep {

/// Chooses the settings of one engine that are worth running next: first the seeds, then neighbours of the
/// Pareto front, where its gaps are widest first. It does only the bookkeeping and runs nothing.
class Explorer {
 public:
  explicit Explorer(Space space) : space_(std::move(space)) {}

  const Space& space() const { return space_; }

  /// Returns the next setting to try and marks it as tried; nullopt if the front has no untried neighbour.
  /// Settings with an expected cost above `dearest` are skipped; costs are in the unit of `tell`.
  std::optional<Space::Place> next(double dearest);

  /// Goal of a search, in the units of `tell`: the cheapest setting with at most this error, or the most
  /// accurate one with at most this cost.
  struct Goal {
    std::optional<double> error, cost;
  };
  /// Returns the next setting that may be nearer to the goal, among the neighbours of the front's points on
  /// both sides of it. Returns nullopt if none is left: the search cannot improve, or the goal cannot be
  /// reached below `dearest`.
  std::optional<Space::Place> next_towards(const Goal& goal, double dearest);

  /// Records the outcome of a run. Errors below `kErrorFloor` are recorded as `kErrorFloor`.
  void tell(const Space::Place& place, double error, double cost);
  /// Records a run without an outcome: it crashed, diverged or was refused.
  void fail(const Space::Place& place) { points_[place] = {}; }

  std::size_t tried() const { return points_.size(); }

  struct Point {
    Space::Place place;
    double error = 0, cost = 0;
  };
  /// Returns the Pareto front, from cheap to accurate.
  std::vector<Point> front() const;

 private:
  struct Known {
    bool ok = false;
    double error = 0, cost = 0;
  };
  bool idle(int axis) const;
  std::optional<Space::Place> step_from(const Point& point, double least_factor, double most_cost);
  void weigh_axes(const Space::Place& place, double error);

  Space space_;
  std::map<Space::Place, Known> points_;
  std::size_t seed_ = 0;
  std::map<int, std::pair<int, int>> axes_;  // changes by axis: without and with effect on the error
};

}  // namespace plumb::harness::sweep
