#pragma once

#include <span>
#include <string>

#include "harness/style.h"
#include "harness/sweep/front.h"

namespace plumb::harness::sweep {

/// One scene's rows for people: each engine's front with settings, error, cost and observed order; then what
/// each engine pays for errors of a decade, and what it reaches for costs of a decade. `metric` null: the
/// scene's headline.
std::string front_table(std::span<const Result> rows, const MetricField* metric, const Style& style);

/// A row a scene and a rival, an overall row, and below them the rival points that are not dominated.
std::string dominance_table(std::span<const Dominance> rows, const Style& style);

/// The same as data, of all scenes: `format` "json" (one object) or "csv" (a line a point of a front).
std::string trade_data(std::span<const Result> rows, const MetricField* metric, const std::string& format);

/// The share of the rivals' points that plumb dominates, 0 to 1; NaN where there is none.
double overall_share(std::span<const Dominance> rows);

}  // namespace plumb::harness::sweep
