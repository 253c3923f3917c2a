#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "harness/stress/family.h"

/// Parts of judges: figures with bounds.
namespace plumb::harness::stress {

/// A figure of a run, its bound, and the verdict if it misses the bound.
struct Rule {
  std::string measure{};
  std::string unit{};
  double bound = 0;
  Verdict beyond = Verdict::Drifts;                           ///< verdict above `sane`
  double explodes = std::numeric_limits<double>::infinity();  ///< values from here on count as an explosion
  double sane = std::numeric_limits<double>::quiet_NaN();  ///< limit of Inaccurate; NaN: ten times the bound
  std::function<double(double time, std::span<const BodyState> states)> figure{};
};

/// Returns the verdict on `figure`, the largest of a run.
Verdict grade(const Rule& rule, double figure);

/// Takes the largest figure of each rule over the samples. Reports the worst, by verdict, then by the ratio
/// of figure to bound.
std::unique_ptr<Judge> judge_by(std::vector<Rule> rules);

// In the following, `scene` must outlive the rule.

/// Limits the deepest penetration of two shapes (circles and boxes) to `bound`, m.
Rule deepest_overlap(const Scene& scene, double bound);

/// Limits the distance of a body's centre from its start to `bound`, m; from `explodes`, m, it is an
/// explosion.
Rule farthest_from_start(const Scene& scene, double bound, double explodes);

/// Limits the sum of all joints' gaps to `bound`, m; from `explodes`, m, it is an explosion.
Rule sum_of_gaps(const Scene& scene, double bound, double explodes);

/// Limits the energy gained and lost since the start, as fractions of `scale`, J. A gain of ten times the
/// scale counts as an explosion.
Rule energy_gained(const Scene& scene, double scale, double bound);
Rule energy_lost(const Scene& scene, double scale, double bound);

/// Limits the distance of a body's centre from the exact one, m.
Rule off_the_path(const Scene& scene, const Motion& exact, double bound, double explodes);

/// Once the first body's exact path is at least `least` long, m, limits the missing fraction of its path
/// length to one half.
Rule path_not_covered(const Scene& scene, const Motion& exact, double least);

/// Limits the relative error of body `body`'s angular velocity against `rate`, rad/s.
Rule wrong_angular_velocity(std::size_t body, double rate, double bound);

}  // namespace plumb::harness::stress
