#pragma once

#include <span>
#include <string>

#include "harness/style.h"
#include "harness/sweep/front.h"

namespace plumb::harness::sweep {

/// Formats one scene's rows: each engine's front with settings, error, cost and observed order. Then the cost
/// of each engine for each decade of error, and its error for each decade of cost. `metric` null: the scene's
/// headline.
std::string front_table(std::span<const Result> rows, const MetricField* metric, const Style& style);

/// Formats one row per scene and rival, an overall row, and below them the rival points that are not
/// dominated.
std::string dominance_table(std::span<const Dominance> rows, const Style& style);

/// Returns the same as data, of all scenes: `format` "json" (one object) or "csv" (one line per point of a
/// front).
std::string trade_data(std::span<const Result> rows, const MetricField* metric, const std::string& format);

/// Returns the fraction of the rivals' points that plumb dominates, 0 to 1; NaN if there are none.
double overall_share(std::span<const Dominance> rows);

}  // namespace plumb::harness::sweep
