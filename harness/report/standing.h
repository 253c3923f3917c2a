#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/result.h"
#include "harness/sweep/front.h"

namespace plumb::harness::report {

/// How plumb stands to one rival on one scene, by the scene's headline metric.
struct Standing {
  sweep::Dominance dominance;
  const MetricField* metric = nullptr;
  int worse = 0;          ///< the rival's points that no setting of plumb dominates
  int clearly_worse = 0;  ///< of these: the costs differ by more than the noise
  /// Of the rival's points, the median of: the cost of plumb's cheapest point that is at least as accurate,
  /// over the point's; the error of plumb's most accurate point that is at least as cheap, over the point's.
  std::optional<double> cost_ratio{}, error_ratio{};
  int unreached = 0;       ///< the rival's points that are more accurate than any of plumb's
  std::string why_none{};  ///< where the rival has no point: skipped, failed, ...
};

/// A row a scene and a rival. First where plumb is worse: by the share of points that are clearly worse,
/// then by the share that is not dominated, then by what plumb pays.
std::vector<Standing> standings(std::span<const Result> rows);

}  // namespace plumb::harness::report
