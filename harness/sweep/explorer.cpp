#include "harness/sweep/explorer.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "harness/sweep/front.h"

namespace plumb::harness::sweep {
namespace {

// Width assigned to the ends of a front, in powers of two: that of about two halvings of a first-order
// method's step.
constexpr double kEnd = 3;
// Number of tries without any effect on the error after which an axis is not tried again.
constexpr int kIdle = 2;
// Factor on the best cost up to which settings are tried, because expected costs are uncertain.
constexpr double kMargin = 1.1;
// Number of points below a goal whose neighbours are tried, because the neighbours of the nearest one may all
// be worse.
constexpr std::size_t kLefts = 3;

}  // namespace

std::vector<Explorer::Point> Explorer::front() const {
  std::vector<Point> all;
  for (const auto& [place, known] : points_)
    if (known.ok) all.push_back({place, known.error, known.cost});
  std::stable_sort(all.begin(), all.end(), [](const Point& a, const Point& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.error < b.error;
  });
  std::vector<Point> out;
  for (Point& point : all)
    if (out.empty() || point.error < out.back().error) out.push_back(std::move(point));
  return out;
}

bool Explorer::idle(int axis) const {
  const auto found = axes_.find(axis);
  return found != axes_.end() && found->second.second == 0 && found->second.first >= kIdle;
}

void Explorer::weigh_axes(const Space::Place& place, double error) {
  for (const Space::Neighbour& neighbour : space_.neighbours(place)) {
    const auto found = points_.find(neighbour.place);
    if (found == points_.end() || !found->second.ok || neighbour.axis == 0) continue;
    auto& [without, with] = axes_[neighbour.axis];
    ++(found->second.error == error ? without : with);
  }
}

void Explorer::tell(const Space::Place& place, double error, double cost) {
  if (!std::isfinite(error) || !std::isfinite(cost)) return fail(place);
  error = std::max(error, kErrorFloor);
  weigh_axes(place, error);
  points_[place] = {true, error, cost};
}

std::optional<Space::Place> Explorer::next(double dearest) {
  const std::vector<Point> known = front();
  for (const std::vector<Space::Place> seeds = space_.seeds(); seed_ < seeds.size();) {
    const Space::Place& place = seeds[seed_++];
    // Seeds are ordered from coarse to fine; steps finer than those of a point at the error floor are
    // useless.
    const bool exact =
        !known.empty() && known.back().error <= kErrorFloor && place[0] > known.back().place[0];
    const double steps =
        known.empty() ? 0 : std::ldexp(known.front().cost, place[0] - known.front().place[0]);
    if (exact || steps > dearest || points_.contains(place)) continue;
    points_[place] = {};
    return place;
  }
  const auto gap = [&](std::size_t i) {
    return std::log2(known[i].error / known[i + 1].error) + std::log2(known[i + 1].cost / known[i].cost);
  };
  double best = 0;
  std::optional<Space::Place> chosen;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const double left = i == 0 ? kEnd : gap(i - 1);
    const double right = i + 1 == known.size() ? (known[i].error > kErrorFloor ? kEnd : 0) : gap(i);
    const std::vector<Space::Neighbour> all = space_.neighbours(known[i].place);
    const auto tried = std::count_if(all.begin(), all.end(),
                                     [&](const auto& other) { return points_.contains(other.place); });
    for (const Space::Neighbour& neighbour : all) {
      if (points_.contains(neighbour.place) || idle(neighbour.axis)) continue;
      if (known[i].cost * neighbour.cost_factor > dearest) continue;
      const double worth = (0.1 + std::max(left, right)) / (1 + static_cast<double>(tried));
      if (worth <= best) continue;
      best = worth;
      chosen = neighbour.place;
    }
  }
  if (chosen) points_[*chosen] = {};
  return chosen;
}

// Takes the cheapest untried neighbour of `point`.
std::optional<Space::Place> Explorer::step_from(const Point& point, double least_factor, double most_cost) {
  std::optional<Space::Neighbour> best;
  for (Space::Neighbour& neighbour : space_.neighbours(point.place)) {
    if (points_.contains(neighbour.place) || idle(neighbour.axis) || neighbour.cost_factor < least_factor ||
        point.cost * neighbour.cost_factor > most_cost)
      continue;
    if (!best || neighbour.cost_factor < best->cost_factor) best = std::move(neighbour);
  }
  if (!best) return {};
  points_[best->place] = {};
  return best->place;
}

std::optional<Space::Place> Explorer::next_towards(const Goal& goal, double dearest) {
  // There are few seeds that differ in more than the step; they help to leave local optima near the start.
  for (const Space::Place& seed : space_.seeds()) {
    if (seed[0] != space_.start()[0] || points_.contains(seed)) continue;
    points_[seed] = {};
    return seed;
  }
  const std::vector<Point> known = front();
  // For an error goal, the first point that meets it; for a cost goal, the first point that exceeds it.
  const auto met = std::find_if(known.begin(), known.end(), [&](const Point& point) {
    return goal.error ? point.error <= *goal.error : point.cost > *goal.cost;
  });
  const Point* right = met == known.end() ? nullptr : &*met;
  const std::span<const Point> before(known.data(), static_cast<std::size_t>(met - known.begin()));
  const std::span<const Point> lefts = before.last(std::min(before.size(), kLefts));
  if (known.empty()) {
    // No setting has run to its end so far, but finer steps may.
    for (const Space::Place& seed : space_.seeds()) {
      if (points_.contains(seed)) continue;
      points_[seed] = {};
      return seed;
    }
    return {};
  }
  if (goal.error) {
    // If no point meets the goal, a finer step may. Otherwise, settings that cost more than the point that
    // meets it are useless.
    const double most = right != nullptr ? right->cost * kMargin : dearest;
    if (right != nullptr)
      if (auto place = step_from(*right, 0, most)) return place;
    for (auto left = lefts.rbegin(); left != lefts.rend(); ++left)
      if (auto place = step_from(*left, 1, std::min(most, dearest))) return place;
    return {};
  }
  const double most = *goal.cost * kMargin;
  for (auto left = lefts.rbegin(); left != lefts.rend(); ++left)
    if (auto place = step_from(*left, 0, std::min(most, dearest))) return place;
  return right != nullptr ? step_from(*right, 0, std::min(std::max(most, right->cost), dearest))
                          : std::nullopt;
}

}  // namespace plumb::harness::sweep
