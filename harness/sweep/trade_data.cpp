#include <cmath>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/sweep/front_tables.h"
#include "harness/sweep/rows.h"
#include "harness/sweep/space.h"
#include "harness/sweep/trade.h"
#include "harness/table.h"

namespace plumb::harness::sweep {
namespace {

using Json = nlohmann::ordered_json;

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json settings_json(const reference::StepSettings& asked) {
  Json json{{"dt", asked.dt}};
  if (asked.substeps) json["substeps"] = *asked.substeps;
  if (asked.tolerance) json["tolerance"] = *asked.tolerance;
  for (const auto& [name, value] : asked.options) json["options"][name] = value;
  return json;
}

Json engine_json(const SceneTrade& scene, const EngineTrade& engine) {
  Json front = Json::array(), costs = Json::array(), errors = Json::array();
  for (const Point& point : engine.front) {
    const Cost& cost = *point.row->cost;
    front.push_back({{"asked", settings_json(point.row->asked)},
                     {"error", point.error},
                     {"ns_per_simulated_second", point.cost},
                     {"low", cost.ns_per_step_low / point.row->dt},
                     {"high", cost.ns_per_step_high / point.row->dt}});
  }
  for (const double error : scene.errors)
    costs.push_back(
        {{"error", error}, {"ns_per_simulated_second", optional_json(cost_at_error(engine.front, error))}});
  for (const double cost : scene.costs)
    errors.push_back(
        {{"ns_per_simulated_second", cost}, {"error", optional_json(error_at_cost(engine.front, cost))}});
  Json json{{"engine", engine.engine},      {"points", engine.points.size()}, {"front", front},
            {"cost_at_error", costs},       {"error_at_cost", errors},        {"truth", engine.truth},
            {"truth_within", engine.within}};
  json["order"] = engine.order ? Json(engine.order->order) : Json(nullptr);
  if (!engine.why_none.empty()) json["why_none"] = engine.why_none;
  return json;
}

Json dominance_json(const Dominance& row) {
  Json exceptions = Json::array();
  for (const Dominance::Exception& point : row.exceptions)
    exceptions.push_back({{"settings", point.settings},
                          {"metric", point.metric},
                          {"error", point.error},
                          {"ns_per_simulated_second", point.cost},
                          {"cost_ratio", point.cost_ratio > 0 ? Json(point.cost_ratio) : Json(nullptr)},
                          {"error_ratio", point.error_ratio > 0 ? Json(point.error_ratio) : Json(nullptr)},
                          {"noise", point.noise}});
  return {
      {"label", row.label},         {"rival", row.rival},          {"points", row.points},
      {"dominated", row.dominated}, {"front", row.front},          {"front_dominated", row.front_dominated},
      {"failed", row.failed},       {"not_dominated", exceptions}, {"compared", row.compared}};
}

std::string as_json(std::span<const Result> rows, const MetricField* metric) {
  Json scenes = Json::array(), table = Json::array();
  for (const std::vector<Result>& scene : by_label(rows)) {
    const SceneTrade trade = trade_of(scene, metric);
    Json engines = Json::array();
    for (const EngineTrade& engine : trade.engines) engines.push_back(engine_json(trade, engine));
    scenes.push_back({{"label", trade.label},
                      {"metric", trade.metric->name},
                      {"unit", trade.metric->unit},
                      {"truth", trade.truth},
                      {"engines", engines}});
  }
  const std::vector<Dominance> dominated = dominance(rows, metric);
  for (const Dominance& row : dominated) table.push_back(dominance_json(row));
  const double overall = overall_share(dominated);
  const Json json{{"scenes", scenes},
                  {"dominance", table},
                  {"dominated_share", std::isnan(overall) ? Json(nullptr) : Json(overall)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string as_csv(std::span<const Result> rows, const MetricField* metric) {
  std::string out =
      "label,engine,metric,error,ns_per_simulated_second,low,high,settings,truth,truth_within\n";
  for (const std::vector<Result>& scene : by_label(rows)) {
    const SceneTrade trade = trade_of(scene, metric);
    for (const EngineTrade& engine : trade.engines) {
      for (const Point& point : engine.front) {
        const Cost& cost = *point.row->cost;
        out += fmt::format("{},{},{},{},{},{},{},\"{}\",{},{}\n", csv_field(trade.label),
                           csv_field(engine.engine), trade.metric->name, point.error, point.cost,
                           cost.ns_per_step_low / point.row->dt, cost.ns_per_step_high / point.row->dt,
                           settings_text(point.row->asked), csv_field(engine.truth), engine.within);
      }
    }
  }
  return out;
}

}  // namespace

std::string trade_data(std::span<const Result> rows, const MetricField* metric, const std::string& format) {
  return format == "json" ? as_json(rows, metric) : as_csv(rows, metric);
}

}  // namespace plumb::harness::sweep
