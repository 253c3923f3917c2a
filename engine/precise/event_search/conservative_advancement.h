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

/// Two outlines by index, a < b.
struct OutlinePair {
  std::size_t a = 0, b = 0;
  friend auto operator<=>(const OutlinePair&, const OutlinePair&) = default;
};

/// Returns how long f + f' s - A s^2 / 2 stays above zero, s.
double lasts(double f, double rate, double most_fall);

/// Finds when two outlines first touch during a step, by conservative advancement with acceleration bounds.
/// Along a separating direction every corner's height f obeys f(t + s) >= f + f' s - A s^2 / 2, where A is a
/// bound on f'' from the step's polynomials. So no touch is missed at any speed or spin.
class ConservativeAdvancement {
 public:
  /// `steps`: limit on the steps of one search; beyond it, `Error` (Run).
  ConservativeAdvancement(std::span<const FeatureShape> outlines, const StepMotionBounds& paths,
                          long steps = 200000)
      : outlines_(outlines), paths_(paths), most_(steps) {}

  /// Returns the first time in [from, until] at which the pair is `near` (m) or closer.
  std::optional<double> first(const OutlinePair& pair, double from, double until, double near) const;

  /// For a pair that touches at the step's start without being held: `apart` is the time within the step, if
  /// any, at which its separation exceeds `near`. `pressed` is set if the overlap grows by `near` before
  /// that.
  struct Departure {
    std::optional<double> apart, pressed;
  };
  enum class Overlap { Pressed, Allowed };
  Departure departure(const OutlinePair& pair, double until, double near,
                      Overlap overlap = Overlap::Pressed) const;

  /// Returns the separation at a time.
  double distance(const OutlinePair& pair, double time) const;

 private:
  std::span<const FeatureShape> outlines_;
  const StepMotionBounds& paths_;
  long most_;
};

/// Returns the pairs whose boxes overlap and for which `may_meet` is true, in ascending order, by sweep and
/// prune along x.
template <class MayMeet>
std::vector<OutlinePair> pairs_of_boxes(std::span<const Aabb<double>> boxes, const MayMeet& may_meet) {
  std::vector<std::size_t> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return boxes[i].lower.x != boxes[j].lower.x ? boxes[i].lower.x < boxes[j].lower.x : i < j;
  });
  std::vector<OutlinePair> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].lower.x <= boxes[order[i]].upper.x; ++j) {
      if (!boxes[order[i]].overlaps(boxes[order[j]])) continue;
      const auto [a, b] = std::minmax(order[i], order[j]);
      if (may_meet(a, b)) pairs.push_back({a, b});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace plumb::precise
