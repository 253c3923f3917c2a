#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/metrics.h"
#include "harness/result.h"
#include "harness/summary.h"

/// Analysis of the trade-off between accuracy and cost in results. Pure functions over rows; nothing here
/// runs.
namespace plumb::harness::sweep {

/// Floor of errors, in the metric's unit: smaller errors are rounding in double.
inline constexpr double kErrorFloor = kRoundingFloor;

/// A setting of an engine on one scene, as a point of the work-precision plane.
struct Point {
  const Result* row = nullptr;
  double error = 0;  ///< of the metric, in its unit, at least `kErrorFloor`
  double cost = 0;   ///< ns per simulated second
};

/// Returns the error of a row, or the accuracy of its truth where the error is below that; nullopt if neither
/// is known.
std::optional<double> known_error(const Result& row, const MetricField& metric);

/// Returns true if the errors of two rows in `metric` are distances from the same thing, so that they rank
/// engines: not if each engine has a limit of its own.
bool comparable(const Result& a, const Result& b, const MetricField& metric);

/// Returns the rows that ran to their end with a known metric and a measured cost.
std::vector<Point> points_of(std::span<const Result> rows, const MetricField& metric);

/// Returns the default metric of a scene: `position_error`. It is `angle_error` if no position error exceeds
/// rounding, as in pure spin; without a truth, the first known drift.
const MetricField& headline_metric(std::span<const Result> rows);

/// Returns the Pareto front, from cheap to accurate: costs rise, errors fall.
std::vector<Point> front_of(std::vector<Point> points);

/// Returns the cost at which the front reaches `error`, ns per simulated second; a point that is better at
/// the same cost counts too. Interpolates linearly in log-log between neighbours; returns nullopt beyond the
/// most accurate point. An error larger than that of the cheapest point costs as much as that point.
std::optional<double> cost_at_error(std::span<const Point> front, double error);

/// Returns the error that the front reaches at `cost`, interpolated in the same way; nullopt below its
/// cheapest point's cost.
std::optional<double> error_at_cost(std::span<const Point> front, double cost);

/// Observed order of convergence in the step.
struct Order {
  double order = 0;  ///< median slope of log error against log dt over neighbouring steps
  int pairs = 0;     ///< number of pairs in that median
};

/// Computes the order from points that differ in dt alone. Leaves out pairs whose finer error is within
/// `kPlateau` of the smallest error, because rounding dominates there.
std::optional<Order> observed_order(std::span<const Point> points);

inline constexpr double kPlateau = 4;

/// Comparison of plumb's points with those of one rival on one scene, where both have errors against the same
/// truth.
struct Dominance {
  std::string label, rival;
  int points = 0;           ///< the rival's
  int dominated = 0;        ///< those that some point of plumb equals or beats in accuracy and cost
  int front = 0;            ///< number of points on the rival's own front
  int front_dominated = 0;  ///< of these
  int failed = 0;           ///< runs of the rival that crashed, hung or diverged, and so have no point
  bool compared = true;     ///< false: its errors are distances from another truth than plumb's
  struct Exception {
    std::string settings;    ///< text of `settings_text`
    std::string metric;      ///< metric by which the scene is judged
    double error = 0;        ///< in the metric's unit
    double cost = 0;         ///< ns per simulated second
    double cost_ratio = 0;   ///< plumb's cost of this error over the rival's; 0: never reached
    double error_ratio = 0;  ///< plumb's error at this cost over the rival's; 0: nothing is as cheap
    bool noise = false;      ///< the two costs do not differ significantly
  };
  std::vector<Exception> exceptions{};  ///< the rival's points that are not dominated
};

/// Returns true for plumb's own engines: "plumb" or "plumb-...".
bool is_plumb(std::string_view engine);

/// Returns one row per scene and rival, scenes in the order of the rows. `metric` null: each scene's
/// headline.
std::vector<Dominance> dominance(std::span<const Result> rows, const MetricField* metric = nullptr);

}  // namespace plumb::harness::sweep
