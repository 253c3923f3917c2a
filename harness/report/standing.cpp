#include "harness/report/standing.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "harness/sweep/rows.h"

namespace plumb::harness::report {
namespace {

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  // Values are ratios, so the median of an even number is the geometric mean of the middle two.
  return values.size() % 2 == 1 ? values[middle] : std::sqrt(values[middle - 1] * values[middle]);
}

std::string why_none(std::span<const Result> scene, const std::string& rival) {
  for (const Result& row : scene)
    if (row.engine == rival && row.status != Status::Ok)
      return fmt::format("{}: {}", name_of(row.status), row.reason);
  for (const Result& row : scene)
    if (row.engine == rival && !row.cost) return "no cost was measured";
  return "no figure of this scene is known";
}

// Returns the cost of the cheapest point that is at least as accurate. A front is sorted by cost.
std::optional<double> cost_for(std::span<const sweep::Point> front, double error) {
  for (const sweep::Point& point : front)
    if (point.error <= error) return point.cost;
  return {};
}

// Returns the error of the most accurate point that is at least as cheap.
std::optional<double> error_for(std::span<const sweep::Point> front, double cost) {
  std::optional<double> out;
  for (const sweep::Point& point : front)
    if (point.cost <= cost) out = point.error;
  return out;
}

Standing standing_of(std::span<const Result> scene, const std::string& rival, const MetricField& metric,
                     std::span<const sweep::Point> plumb, const std::vector<sweep::Dominance>& dominances) {
  Standing out{.dominance = {.label = scene.front().label, .rival = rival}, .metric = &metric};
  for (const sweep::Dominance& dominance : dominances)
    if (dominance.rival == rival && dominance.label == out.dominance.label) out.dominance = dominance;
  out.worse = static_cast<int>(out.dominance.exceptions.size());
  out.clearly_worse =
      static_cast<int>(std::count_if(out.dominance.exceptions.begin(), out.dominance.exceptions.end(),
                                     [](const auto& exception) { return !exception.noise; }));
  std::vector<double> costs, errors;
  for (const sweep::Point& point : sweep::points_of(scene, metric)) {
    if (point.row->engine != rival || !out.dominance.compared) continue;
    const auto cost = cost_for(plumb, point.error);
    if (cost) {
      costs.push_back(*cost / point.cost);
    } else {
      ++out.unreached;
    }
    if (const auto error = error_for(plumb, point.cost)) errors.push_back(*error / point.error);
  }
  out.cost_ratio = median(std::move(costs));
  out.error_ratio = median(std::move(errors));
  if (out.dominance.points == 0) out.why_none = why_none(scene, rival);
  if (!out.dominance.compared) {
    out.dominance.points = 0;
    out.why_none = "not compared: against its own limit, not plumb's truth";
  }
  return out;
}

double share(int count, int of) { return of == 0 ? 0 : static_cast<double>(count) / of; }

// Returns the sort key; larger is worse.
auto badness(const Standing& row) {
  const int points = row.dominance.points;
  return std::tuple(share(row.clearly_worse, points), share(row.worse, points), points > 0 ? 1 : 0,
                    row.cost_ratio.value_or(0));
}

}  // namespace

std::vector<Standing> standings(std::span<const Result> rows) {
  std::vector<Standing> out;
  for (const std::vector<Result>& scene : sweep::by_label(rows)) {
    const MetricField& metric = sweep::headline_metric(scene);
    std::vector<sweep::Point> plumb = sweep::points_of(scene, metric);
    std::erase_if(plumb, [](const sweep::Point& point) { return !sweep::is_plumb(point.row->engine); });
    plumb = sweep::front_of(std::move(plumb));
    const std::vector<sweep::Dominance> dominances = sweep::dominance(scene, &metric);
    // Costs of WebAssembly and JavaScript are not ranked with native ones.
    const auto is_foreign = [&](const std::string& engine) {
      return std::any_of(scene.begin(), scene.end(),
                         [&](const Result& row) { return row.engine == engine && row.foreign_cost; });
    };
    for (const std::string& engine : sweep::engines_of(scene))
      if (!sweep::is_plumb(engine) && !is_foreign(engine))
        out.push_back(standing_of(scene, engine, metric, plumb, dominances));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Standing& a, const Standing& b) { return badness(a) > badness(b); });
  return out;
}

}  // namespace plumb::harness::report
