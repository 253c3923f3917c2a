#include "harness/course/likeness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plumb::course {
namespace {

// m, distance from the origin beyond which a path only shows that it diverges.
constexpr double kFar = 30;

constexpr double kMetresPerRadian = 0.5;  // m, per rad of an angle: half the size of the checks' boxes

// Returns the nearest place within the range in which paths are compared.
Vec2d in_range(Vec2d at) {
  const double far = std::hypot(at.x, at.y);
  return far <= kFar ? at : kFar / far * at;
}

bool left_range(std::span<const BodyState> states) {
  return std::any_of(states.begin(), states.end(),
                     [](const BodyState& s) { return !(dot(s.position, s.position) <= kFar * kFar); });
}

// Returns the sum of the squared distances of the bodies' positions, and of their angles unless a body has
// left the range. A NaN is farther than any number.
double square_distance(std::span<const BodyState> a, std::span<const BodyState> b, bool left) {
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const Vec2d way = in_range(a[i].position) - in_range(b[i].position);
    const double turn = left ? 0 : kMetresPerRadian * (a[i].angle - b[i].angle);
    sum += dot(way, way) + turn * turn;
  }
  return std::isnan(sum) ? std::numeric_limits<double>::infinity() : sum;
}

}  // namespace

double distance(const std::vector<Recorded>& seen, const std::vector<Recorded>& a,
                const std::vector<Recorded>& b, std::size_t runs) {
  double sum = 0;
  for (std::size_t r = 0; r < std::min({seen.size(), a.size(), b.size(), runs}); ++r) {
    const auto &range = seen[r].trace.states, &from = a[r].trace.states, &to = b[r].trace.states;
    bool left = false;
    for (std::size_t k = 0; !left && k < std::min({range.size(), from.size(), to.size()}); ++k) {
      left = left_range(range[k]);
      sum += square_distance(from[k], to[k], left);
    }
  }
  return std::sqrt(sum);
}

double Distance::add(std::size_t run, std::size_t state, std::span<const BodyState> states) {
  if (run != run_) ended_ = false;
  run_ = run;
  if (!ended_ && run < std::min(runs_, seen_.size()) && state < seen_[run].trace.states.size()) {
    const std::vector<BodyState>& seen = seen_[run].trace.states[state];
    ended_ = left_range(seen);
    sum_ += square_distance(seen, states, ended_);
  }
  return std::sqrt(sum_);
}

bool same_readings(const Finding& seen, const Finding& predicted) {
  if (seen.readings.size() != predicted.readings.size()) return false;
  Judgement judgement;
  std::vector<double> gives;
  for (std::size_t i = 0; i < seen.readings.size(); ++i) {
    const Reading& r = seen.readings[i];
    judgement.read(r.what, r.unit, r.measured, r.expected, r.tolerance);
    gives.push_back(predicted.readings[i].measured);
  }
  judgement.mistake("this", std::move(gives), "");
  return judgement.finding().mistake == "this";
}

bool same_figures(const Finding& seen, const Finding& predicted) {
  for (std::size_t i = 0; i < std::min(seen.readings.size(), predicted.readings.size()); ++i) {
    const Reading &is = seen.readings[i], &due = predicted.readings[i];
    const double most = std::max(0.01 * std::abs(due.measured - due.expected), 0.1 * due.tolerance);
    if (!(std::abs(is.measured - due.measured) <= most)) return false;
  }
  return true;
}

bool static_moves(const std::vector<Recorded>& runs) {
  for (const Recorded& run : runs)
    for (std::size_t b = 0; b < run.scene.bodies.size(); ++b)
      for (const auto& states : run.trace.states)
        if (run.scene.bodies[b].type == BodyType::Static &&
            (states[b].velocity != Vec2d{} || states[b].position != run.scene.bodies[b].position))
          return true;
  return false;
}

bool pushes_farther(const std::vector<Recorded>& seen, const std::vector<Recorded>& predicted, double share) {
  // Factor of tolerance for contacts that are found at other times, and for several contacts of one pair.
  constexpr double kMore = 1.25;
  for (std::size_t r = 0; r < std::min(seen.size(), predicted.size()); ++r) {
    if (!seen[r].scene.joints.empty()) continue;
    double fastest = 0;
    for (const auto& states : seen[r].trace.states)
      for (const BodyState& s : states) fastest = std::max(fastest, std::hypot(s.velocity.x, s.velocity.y));
    const double overlap =
        std::max(farthest_push(predicted[r].trace, predicted[r].dt) / share, fastest * seen[r].dt);
    if (farthest_push(seen[r].trace, seen[r].dt) > kMore * overlap) return true;
  }
  return false;
}

bool refutes(const Finding& seen, const Finding& predicted) {
  for (std::size_t i = 0; i < std::min(seen.readings.size(), predicted.readings.size()); ++i) {
    const Reading &is = seen.readings[i], &due = predicted.readings[i];
    if (!due.good() && !(std::abs(is.measured - due.measured) < std::abs(due.measured - due.expected) / 2))
      return true;
  }
  return false;
}

bool finite(const Finding& finding) {
  return std::all_of(finding.readings.begin(), finding.readings.end(),
                     [](const Reading& r) { return std::isfinite(r.measured); });
}

}  // namespace plumb::course
