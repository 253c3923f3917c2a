#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/result.h"
#include "harness/sweep/front.h"

namespace plumb::harness::report {

/// Comparison of plumb with one rival on one scene, by the scene's headline metric.
struct Standing {
  sweep::Dominance dominance;
  const MetricField* metric = nullptr;
  int worse = 0;          ///< the rival's points that no setting of plumb dominates
  int clearly_worse = 0;  ///< number of these whose costs differ by more than the noise
  /// Medians over the rival's points. `cost_ratio`: cost of plumb's cheapest point that is at least as
  /// accurate, over the cost of the rival's point. `error_ratio`: error of plumb's most accurate point that
  /// is at least as cheap, over the error of the rival's point.
  std::optional<double> cost_ratio{}, error_ratio{};
  int unreached = 0;       ///< the rival's points that are more accurate than any of plumb's
  std::string why_none{};  ///< reason if the rival has no point: skipped, failed, ...
};

/// Returns one row per scene and rival, plumb's worst first: sorted by the fraction of points that are
/// clearly worse, then by the fraction not dominated, then by the cost ratio.
std::vector<Standing> standings(std::span<const Result> rows);

}  // namespace plumb::harness::report
