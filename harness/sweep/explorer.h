#pragma once

#include <map>
#include <optional>
#include <vector>

#include "harness/sweep/space.h"

namespace plumb::harness::sweep {

/// Chooses which settings of one engine are worth running next: the seeds, and then neighbours of the front,
/// where it is widest first. Pure bookkeeping: it runs nothing.
class Explorer {
 public:
  explicit Explorer(Space space) : space_(std::move(space)) {}

  const Space& space() const { return space_; }

  /// The next place, which counts as taken from now on; nothing when no neighbour of the front is left.
  /// Places that should cost more than `dearest` are passed over; costs are in the unit of `tell`.
  std::optional<Space::Place> next(double dearest);

  /// What is searched for, in the units of `tell`: the cheapest with at most this error, or else the most
  /// accurate of at most this cost.
  struct Goal {
    std::optional<double> error, cost;
  };
  /// The next place that may be nearer to the goal than the best so far: neighbours of the points of the
  /// front on both sides of it. Nothing when none is left: the goal is met as well as this search can, or
  /// out of reach below `dearest`.
  std::optional<Space::Place> next_towards(const Goal& goal, double dearest);

  /// What a run gave. `error` below `kErrorFloor` counts as that.
  void tell(const Space::Place& place, double error, double cost);
  /// It gave nothing: it crashed, diverged or was refused.
  void fail(const Space::Place& place) { points_[place] = {}; }

  std::size_t tried() const { return points_.size(); }

  struct Point {
    Space::Place place;
    double error = 0, cost = 0;
  };
  /// Those that no other is at least as good as in both, from cheap to accurate.
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
  std::map<int, std::pair<int, int>> axes_;  // changes along an axis: without and with effect on the error
};

}  // namespace plumb::harness::sweep
