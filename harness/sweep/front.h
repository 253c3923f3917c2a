#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/metrics.h"
#include "harness/result.h"
#include "harness/summary.h"

/// What results say about the trade of accuracy for cost. Pure functions over rows; nothing here runs.
namespace plumb::harness::sweep {

/// Errors below count as this: what double rounding leaves. In the metric's unit.
inline constexpr double kErrorFloor = kRoundingFloor;

/// A setting of an engine on one scene, as a point of the work-precision plane.
struct Point {
  const Result* row = nullptr;
  double error = 0;  ///< of the metric, in its unit, at least `kErrorFloor`
  double cost = 0;   ///< ns per simulated second
};

/// Rows that ran to their end, whose metric is known and whose cost was measured.
std::vector<Point> points_of(std::span<const Result> rows, const MetricField& metric);

/// The metric that a scene is judged by where nothing else is asked: `position_error`; `angle_error` where no
/// run is off by more than rounding in position, as in pure spin; where there is no truth, the first drift
/// that is known.
const MetricField& headline_metric(std::span<const Result> rows);

/// The points that no other is at least as good as in both, from cheap to accurate: costs rise, errors fall.
std::vector<Point> front_of(std::vector<Point> points);

/// What the front pays for `error`, ns per simulated second; a point that is better at the same cost serves
/// too. Straight lines in log-log between neighbours; nothing beyond the most accurate point. Errors larger
/// than the cheapest point's cost what that costs.
std::optional<double> cost_at_error(std::span<const Point> front, double error);

/// The error that the front reaches for `cost`, likewise; nothing below its cheapest point's cost.
std::optional<double> error_at_cost(std::span<const Point> front, double cost);

/// How fast errors fall with the step.
struct Order {
  double order = 0;  ///< median slope of log error against log dt over neighbouring steps
  int pairs = 0;     ///< that it is the median of
};

/// From points that differ in dt alone. Pairs are left out whose finer error is within `kPlateau` of the
/// smallest error of all: there rounding, not the step, makes the error.
std::optional<Order> observed_order(std::span<const Point> points);

inline constexpr double kPlateau = 4;

/// How the points of plumb stand to those of one rival on one scene.
struct Dominance {
  std::string label, rival;
  int points = 0;           ///< the rival's
  int dominated = 0;        ///< of these: some point of plumb is at least as accurate and at least as cheap
  int front = 0;            ///< points on the rival's own front
  int front_dominated = 0;  ///< of these
  int failed = 0;           ///< runs of the rival that crashed, hung or diverged: they have no point
  struct Exception {
    std::string settings;    ///< as `settings_text` has them
    std::string metric;      ///< that the scene is judged by
    double error = 0;        ///< in the metric's unit
    double cost = 0;         ///< ns per simulated second
    double cost_ratio = 0;   ///< what plumb pays for this error over what the rival pays; 0: never reached
    double error_ratio = 0;  ///< plumb's error at this cost over the rival's; 0: nothing is as cheap
    bool noise = false;      ///< the two costs cannot be told apart
  };
  std::vector<Exception> exceptions{};  ///< the rival's points that are not dominated
};

/// Whether an engine is one of plumb's own: "plumb" or "plumb-...".
bool is_plumb(std::string_view engine);

/// A row a scene and a rival, scenes in the order of the rows. `metric` null: each scene's headline.
std::vector<Dominance> dominance(std::span<const Result> rows, const MetricField* metric = nullptr);

}  // namespace plumb::harness::sweep
