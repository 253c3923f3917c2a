#include "harness/sweep/front.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "harness/cost.h"
#include "harness/sweep/rows.h"
#include "harness/sweep/space.h"

namespace plumb::harness::sweep {
namespace {

const MetricField& field(std::string_view name) {
  return *std::find_if(kMetricFields.begin(), kMetricFields.end(),
                       [&](const MetricField& metric) { return metric.name == name; });
}

// Returns the value at x of the line through (a, fa) and (b, fb), all in logarithms.
double log_interpolate(double a, double fa, double b, double fb, double x) {
  const double share = std::log(x / a) / std::log(b / a);
  return std::exp(std::log(fa) + share * std::log(fb / fa));
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

// Returns the cheapest point that is at least as accurate: a front is sorted by cost.
const Point* cheapest_with(std::span<const Point> front, double error) {
  for (const Point& point : front)
    if (point.error <= error) return &point;
  return nullptr;
}

Dominance::Exception exception_of(const Point& rival, std::span<const Point> plumb,
                                  const MetricField& metric) {
  Dominance::Exception out{.settings = settings_text(rival.row->asked),
                           .metric = std::string(metric.name),
                           .error = rival.error,
                           .cost = rival.cost};
  if (const auto cost = cost_at_error(plumb, rival.error)) out.cost_ratio = *cost / rival.cost;
  if (const auto error = error_at_cost(plumb, rival.cost)) out.error_ratio = *error / rival.error;
  if (const Point* point = cheapest_with(plumb, rival.error); point != nullptr)
    out.noise = !clearly_differ(*point->row->cost, *rival.row->cost);
  return out;
}

Dominance compare_with(std::span<const Result> rows, const std::string& rival, const MetricField& metric,
                       std::span<const Point> plumb) {
  Dominance out{.label = rows.front().label, .rival = rival};
  std::vector<Point> points;
  for (const Point& point : points_of(rows, metric))
    if (point.row->engine == rival) points.push_back(point);
  for (const Result& row : rows)
    if (row.engine == rival && row.status != Status::Ok && row.status != Status::Skipped) ++out.failed;
  const auto dominated = [&](const Point& point) {
    const Point* best = cheapest_with(plumb, point.error);
    return best != nullptr && best->cost <= point.cost;
  };
  out.points = static_cast<int>(points.size());
  out.compared = std::ranges::all_of(points, [&](const Point& point) {
    return std::ranges::all_of(
        plumb, [&](const Point& other) { return comparable(*point.row, *other.row, metric); });
  });
  if (!out.compared) return out;
  for (const Point& point : points) {
    if (dominated(point)) {
      ++out.dominated;
    } else {
      out.exceptions.push_back(exception_of(point, plumb, metric));
    }
  }
  const std::vector<Point> front = front_of(points);
  out.front = static_cast<int>(front.size());
  out.front_dominated = static_cast<int>(std::count_if(front.begin(), front.end(), dominated));
  return out;
}

}  // namespace

std::optional<double> known_error(const Result& row, const MetricField& metric) {
  const auto &error = row.metrics.*metric.value, &least = row.truth_within.*metric.value;
  return error ? error : least;
}

bool comparable(const Result& a, const Result& b, const MetricField& metric) {
  return !metric.against_truth || a.truth == b.truth;
}

std::vector<Point> points_of(std::span<const Result> rows, const MetricField& metric) {
  std::vector<Point> out;
  for (const Result& row : rows) {
    const auto& value = row.metrics.*metric.value;
    if (row.status != Status::Ok || !row.cost || !value || !std::isfinite(*value)) continue;
    if (!(row.cost->ns_per_simulated_second > 0)) continue;
    out.push_back({&row, std::max(*value, kErrorFloor), row.cost->ns_per_simulated_second});
  }
  return out;
}

const MetricField& headline_metric(std::span<const Result> rows) {
  const auto largest = [&](const MetricField& metric) {
    std::optional<double> out;
    for (const Result& row : rows)
      if (const auto& value = row.metrics.*metric.value; row.ran() && value)
        out = std::max(out.value_or(0), *value);
    return out;
  };
  const MetricField &position = field("position_error"), &angle = field("angle_error");
  const auto off = largest(position), turned = largest(angle);
  if (off && *off <= kErrorFloor && turned && *turned > kErrorFloor) return angle;
  if (off) return position;
  for (const MetricField& metric : kMetricFields)
    if (largest(metric)) return metric;
  return position;
}

std::vector<Point> front_of(std::vector<Point> points) {
  std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.error < b.error;
  });
  std::vector<Point> out;
  for (const Point& point : points)
    if (out.empty() || point.error < out.back().error) out.push_back(point);
  return out;
}

std::optional<double> cost_at_error(std::span<const Point> front, double error) {
  error = std::max(error, kErrorFloor);
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (front[i].error > error) continue;
    if (i == 0 || front[i].error == error) return front[i].cost;
    return log_interpolate(front[i - 1].error, front[i - 1].cost, front[i].error, front[i].cost, error);
  }
  return {};
}

std::optional<double> error_at_cost(std::span<const Point> front, double cost) {
  if (front.empty() || cost < front.front().cost) return {};
  for (std::size_t i = 1; i < front.size(); ++i) {
    if (front[i].cost < cost) continue;
    return log_interpolate(front[i - 1].cost, front[i - 1].error, front[i].cost, front[i].error, cost);
  }
  return front.back().error;
}

std::optional<Order> observed_order(std::span<const Point> points) {
  std::vector<Point> sorted(points.begin(), points.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Point& a, const Point& b) { return a.row->dt > b.row->dt; });
  if (sorted.empty()) return {};
  // Beyond the smallest error, finer steps only accumulate rounding.
  const auto smallest = std::min_element(sorted.begin(), sorted.end(),
                                         [](const Point& a, const Point& b) { return a.error < b.error; });
  const double least = smallest->error;
  sorted.erase(smallest + 1, sorted.end());
  std::vector<double> slopes;
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
    const Point &coarse = sorted[i], &fine = sorted[i + 1];
    // The finest pair may be below the plateau while its error still falls.
    const bool last =
        i + 2 == sorted.size() && fine.error <= coarse.error / 2 && fine.error > 2 * kErrorFloor;
    if (fine.row->dt == coarse.row->dt || (fine.error < kPlateau * least && !last)) continue;
    slopes.push_back(std::log(coarse.error / fine.error) / std::log(coarse.row->dt / fine.row->dt));
  }
  if (slopes.empty()) return {};
  return Order{median(slopes), static_cast<int>(slopes.size())};
}

bool is_plumb(std::string_view engine) { return engine == "plumb" || engine.starts_with("plumb-"); }

std::vector<Dominance> dominance(std::span<const Result> rows, const MetricField* metric) {
  std::vector<Dominance> out;
  for (const std::vector<Result>& scene : by_label(rows)) {
    const MetricField& judged = metric != nullptr ? *metric : headline_metric(scene);
    std::vector<Point> plumb = points_of(scene, judged);
    std::erase_if(plumb, [](const Point& point) { return !is_plumb(point.row->engine); });
    plumb = front_of(std::move(plumb));
    for (const std::string& engine : engines_of(scene)) {
      // Costs of WebAssembly and JavaScript are not ranked with native ones.
      const bool foreign = std::any_of(scene.begin(), scene.end(), [&](const Result& result) {
        return result.engine == engine && result.foreign_cost;
      });
      if (is_plumb(engine) || foreign) continue;
      Dominance row = compare_with(scene, engine, judged, plumb);
      if (row.points > 0 || row.failed > 0) out.push_back(std::move(row));
    }
  }
  return out;
}

}  // namespace plumb::harness::sweep
