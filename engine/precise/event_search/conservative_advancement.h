#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/precise/dynamics/feature_shape.h"
#include "engine/precise/event_search/motion_bounds.h"

namespace plumb::precise {

/// Indices of two shapes, a < b.
struct ShapePair {
  std::size_t a = 0, b = 0;
  friend auto operator<=>(const ShapePair&, const ShapePair&) = default;
};

/// Returns how long f + f' s - A s^2 / 2 stays above zero, s.
double time_above_zero(double f, double rate, double max_fall);

/// Finds when two shapes first touch during a step, by conservative advancement with acceleration bounds.
/// Along a separating direction every corner's height f obeys f(t + s) >= f + f' s - A s^2 / 2, where A is a
/// bound on f'' from the step's polynomials. So no touch is missed at any speed or spin.
class ConservativeAdvancement {
 public:
  /// `steps`: limit on the steps of one search; beyond it, `Error` (Run).
  ConservativeAdvancement(std::span<const FeatureShape> shapes, const StepMotionBounds& bounds,
                          long steps = 200000)
      : shapes_(shapes), bounds_(bounds), max_steps_(steps) {}

  /// Returns the first time in [from, until] at which the pair is `tolerance` (m) or closer.
  std::optional<double> first_touch(const ShapePair& pair, double from, double until, double tolerance) const;

  /// For a pair that touches at the step's start without being held: `apart` is the time within the step, if
  /// any, at which its separation exceeds `tolerance`. `pressed` is set if the overlap grows by `tolerance`
  /// before that.
  struct Departure {
    std::optional<double> apart, pressed;
  };
  enum class Overlap { Pressed, Allowed };
  Departure departure(const ShapePair& pair, double until, double tolerance,
                      Overlap overlap = Overlap::Pressed) const;

  /// Returns the separation at a time.
  double distance(const ShapePair& pair, double time) const;

 private:
  std::span<const FeatureShape> shapes_;
  const StepMotionBounds& bounds_;
  long max_steps_;
};

/// Returns the pairs whose boxes overlap and for which `may_collide` is true, in ascending order, by sweep
/// and prune along x.
template <class MayCollide>
std::vector<ShapePair> sweep_and_prune(std::span<const Aabb<double>> boxes, const MayCollide& may_collide) {
  std::vector<std::size_t> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return boxes[i].lower.x != boxes[j].lower.x ? boxes[i].lower.x < boxes[j].lower.x : i < j;
  });
  std::vector<ShapePair> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].lower.x <= boxes[order[i]].upper.x; ++j) {
      if (!boxes[order[i]].overlaps(boxes[order[j]])) continue;
      const auto [a, b] = std::minmax(order[i], order[j]);
      if (may_collide(a, b)) pairs.push_back({a, b});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace plumb::precise
