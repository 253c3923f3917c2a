#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/sweep/front.h"

namespace plumb::harness::sweep {

/// Trade-off of one engine on a scene.
struct EngineTrade {
  std::string engine;
  std::vector<Point> points{};  ///< all of them
  std::vector<Point> front{};
  std::string truth{};           ///< that its errors are distances from
  double within = 0;             ///< accuracy of that truth in the metric: no point has a smaller error
  std::string why_none{};        ///< reason for an empty front: skipped or failed, and why
  std::optional<Order> order{};  ///< order in dt, from the series with the most pairs of steps
};

inline constexpr std::string_view kOwnLimits = "each engine's own limit";

/// Trade-off in the rows of one scene. Points refer to the rows from which it was computed.
struct SceneTrade {
  std::string label;
  std::string truth;      ///< of all engines, or `kOwnLimits`
  bool one_truth = true;  ///< false: errors of different engines are distances from different truths
  double duration = 0;    ///< s
  const MetricField* metric = nullptr;
  std::vector<EngineTrade> engines;
  std::vector<double> errors;  ///< decades that some engine's front spans, from large to small
  std::vector<double> costs;   ///< the same for costs, ns per simulated second, from cheap to expensive
};

/// `metric` null: the scene's headline. `rows` are of one label.
SceneTrade trade_of(std::span<const Result> rows, const MetricField* metric);

}  // namespace plumb::harness::sweep
