#include "harness/sweep/trade.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

#include "harness/sweep/rows.h"

namespace plumb::harness::sweep {
namespace {

// Returns the settings without dt: points that share them are one series.
std::string series_of(const Result& row) {
  Result other = row;
  other.asked.dt = 0;
  return key_of(other);
}

std::optional<Order> order_of(std::span<const Point> points) {
  std::map<std::string, std::vector<Point>> series;
  for (const Point& point : points) series[series_of(*point.row)].push_back(point);
  std::optional<Order> best;
  for (const auto& [name, members] : series) {
    if (members.front().row->asked.tolerance) continue;  // the engine chooses its own steps
    const std::optional<Order> order = observed_order(members);
    if (order && (!best || order->pairs > best->pairs)) best = order;
  }
  return best;
}

std::string why_none(std::span<const Result> rows, const std::string& engine, const MetricField& metric) {
  for (const Result& row : rows)
    if (row.engine == engine && row.status != Status::Ok)
      return fmt::format("{}: {}", name_of(row.status), row.reason);
  const auto measured = std::ranges::find_if(
      rows, [&](const Result& row) { return row.engine == engine && row.metrics.*metric.value; });
  const auto any = std::ranges::find(rows, engine, &Result::engine);
  if (measured == rows.end() && any != rows.end() && any->truth_within.*metric.value)
    return fmt::format("no run can be told from {}", any->truth);
  return "no cost was measured";
}

std::vector<double> decades(double from, double to) {
  std::vector<double> out;
  const int first = static_cast<int>(std::ceil(std::log10(from) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(to) + 1e-9));
  for (int power = first; power <= last; ++power) out.push_back(std::pow(10.0, power));
  return out;
}

}  // namespace

SceneTrade trade_of(std::span<const Result> rows, const MetricField* metric) {
  SceneTrade out;
  out.metric = metric != nullptr ? metric : &headline_metric(rows);
  out.label = rows.front().label;
  const Result* first_row = nullptr;
  double least_error = INFINITY, most_error = 0, least_cost = INFINITY, most_cost = 0;
  const std::vector<Point> all = points_of(rows, *out.metric);
  for (const std::string& engine : engines_of(rows)) {
    EngineTrade trade{.engine = engine};
    std::copy_if(all.begin(), all.end(), std::back_inserter(trade.points),
                 [&](const Point& point) { return point.row->engine == engine; });
    trade.front = front_of(trade.points);
    trade.order = order_of(trade.points);
    if (trade.front.empty()) trade.why_none = why_none(rows, engine, *out.metric);
    if (!trade.front.empty()) {
      const Result& row = *trade.front.front().row;
      trade.truth = row.truth;
      trade.within = (row.truth_within.*out.metric->value).value_or(0);
      if (first_row == nullptr) out.truth = row.truth, first_row = &row;
      out.one_truth = out.one_truth && comparable(row, *first_row, *out.metric);
    }
    for (const Point& point : trade.front) {
      least_error = std::min(least_error, point.error);
      most_error = std::max(most_error, point.error);
      least_cost = std::min(least_cost, point.cost);
      most_cost = std::max(most_cost, point.cost);
      out.duration = point.row->duration;
    }
    out.engines.push_back(std::move(trade));
  }
  if (!out.one_truth) out.truth = kOwnLimits;
  if (most_error > 0) {
    out.errors = decades(least_error, most_error);
    std::reverse(out.errors.begin(), out.errors.end());
    out.costs = decades(least_cost, most_cost);
  }
  return out;
}

}  // namespace plumb::harness::sweep
