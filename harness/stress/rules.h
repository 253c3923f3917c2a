#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "harness/stress/family.h"

/// What judges are put together from: figures with bounds.
namespace plumb::harness::stress {

/// A figure of a run, its bound, and what it is called to miss it.
struct Rule {
  std::string measure{};
  std::string unit{};
  double bound = 0;
  Verdict beyond = Verdict::Drifts;                           ///< above `sane`
  double explodes = std::numeric_limits<double>::infinity();  ///< from there on it is an explosion
  double sane = std::numeric_limits<double>::quiet_NaN();     ///< NaN: ten times the bound
  std::function<double(double time, std::span<const BodyState> states)> figure{};
};

/// What `figure`, the largest of a run, amounts to.
Verdict grade(const Rule& rule, double figure);

/// Takes the largest figure of each rule over the samples; finds the worst, by verdict, then by how often the
/// bound goes into it.
std::unique_ptr<Judge> judge_by(std::vector<Rule> rules);

// In the following, `scene` must outlive the rule.

/// Shapes (circles and boxes) that lie in each other: up to `bound`, m.
Rule deepest_overlap(const Scene& scene, double bound);

/// The farthest that a body's centre gets from where it started: up to `bound`, m; an explosion from
/// `explodes`, m.
Rule farthest_from_start(const Scene& scene, double bound, double explodes);

/// The gaps of all joints together: up to `bound`, m; an explosion from `explodes`, m.
Rule sum_of_gaps(const Scene& scene, double bound, double explodes);

/// Energy beyond, and short of, what was there at the start, as shares of `scale`, J. An explosion from ten
/// times the scale on.
Rule energy_gained(const Scene& scene, double scale, double bound);
Rule energy_lost(const Scene& scene, double scale, double bound);

/// The motion of all bodies' centres against the exact one, m.
Rule off_the_path(const Scene& scene, const Motion& exact, double bound, double explodes);

/// Of the way that the first body should have made, the share that it has not, once it should have made
/// `least`, m; up to one half.
Rule way_not_made(const Scene& scene, const Motion& exact, double least);

/// Of body `body`: the share by which it turns at another rate than `rate`, rad/s.
Rule turns_otherwise(std::size_t body, double rate, double bound);

}  // namespace plumb::harness::stress
