#include "scenarios/truth/bounces.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace plumb::scenarios::truth {

Bounces::Bounces(Real height, Real gravity, Real e, Real duration) : height_(height), gravity_(gravity) {
  const Real fall = std::sqrt(2 * height / gravity), first = e * gravity * fall;
  // The n-th impact is at the sum of the flight times so far, 2 v/g (1 + e + ... + e^(n - 1)).
  Real power = 1, sum = 0;
  while (fall + 2 * first / gravity * sum < duration) {
    impacts_.push_back({fall + 2 * first / gravity * sum, first * power});
    if (impacts_.back().speed < 1e-9L) break;
    sum += power;
    power *= e;
  }
}

Swing Bounces::at(Real time) const {
  const auto next = std::ranges::upper_bound(impacts_, time, {}, &Impact::time);
  if (next == impacts_.begin()) return {height_ - gravity_ * time * time / 2, -gravity_ * time};
  const Impact& last = *std::prev(next);
  const Real since = time - last.time;
  if (since * gravity_ >= 2 * last.speed) return {};  // the rest of the series, or after it
  return {since * (last.speed - gravity_ * since / 2), last.speed - gravity_ * since};
}

std::vector<double> Bounces::impacts() const {
  std::vector<double> times;
  for (const Impact& impact : impacts_) times.push_back(static_cast<double>(impact.time));
  return times;
}

}  // namespace plumb::scenarios::truth
