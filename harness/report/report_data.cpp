#include "harness/report/report_data.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/scene/json.h"
#include "harness/report/stage.h"
#include "harness/report/standing.h"
#include "harness/sweep/rows.h"
#include "harness/sweep/space.h"
#include "harness/sweep/trade.h"

namespace plumb::harness::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFrames = 241;                   // of the truth's motion
constexpr std::size_t kLargestMotion = 40000;  // poses per scene: scenes of many bodies have fewer frames

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json standing_json(const Standing& row) {
  Json exceptions = Json::array();
  for (const sweep::Dominance::Exception& point : row.dominance.exceptions)
    exceptions.push_back({{"settings", point.settings},
                          {"error", point.error},
                          {"cost", point.cost},
                          {"cost_ratio", point.cost_ratio > 0 ? Json(point.cost_ratio) : Json(nullptr)},
                          {"error_ratio", point.error_ratio > 0 ? Json(point.error_ratio) : Json(nullptr)},
                          {"noise", point.noise}});
  return {{"label", row.dominance.label},
          {"rival", row.dominance.rival},
          {"metric", row.metric->name},
          {"unit", row.metric->unit},
          {"points", row.dominance.points},
          {"worse", row.worse},
          {"clearly_worse", row.clearly_worse},
          {"failed", row.dominance.failed},
          {"unreached", row.unreached},
          {"cost_ratio", optional_json(row.cost_ratio)},
          {"error_ratio", optional_json(row.error_ratio)},
          {"why_none", row.why_none},
          {"exceptions", exceptions}};
}

Json environment_json(const EnvironmentUse& use) {
  const Environment& where = use.where;
  return {{"plumb_version", where.plumb_version},
          {"commit", where.commit},
          {"compiler", where.compiler},
          {"flags", where.flags},
          {"build_type", where.build_type},
          {"cpu", where.cpu},
          {"os", where.os},
          {"first", where.date},
          {"last", use.last},
          {"runs", use.runs}};
}

Json missed_json(const Result& row) {
  Json out = Json::array();
  for (const Check& check : row.checks) {
    if (check.pass) continue;
    out.push_back({{"name", check.name},
                   {"oracle", name_of(check.oracle)},
                   {"value", check.value},
                   {"tolerance", check.tolerance},
                   {"known_limit", check.known_limit}});
  }
  return out;
}

Json row_json(const Result& row) {
  Json settings = Json::object(), metrics = Json::object();
  for (const auto& [name, value] : row.settings) settings[name] = value;
  for (const MetricField& field : kMetricFields)
    if (const auto& value = row.metrics.*field.value) metrics[std::string(field.name)] = *value;
  Json json{{"engine", row.engine},
            {"version", row.engine_version},
            {"precision", row.precision},
            {"dt", row.dt},
            {"asked", sweep::settings_text(row.asked)},
            {"settings", settings},
            {"status", name_of(row.status)},
            {"reason", row.reason},
            {"metrics", metrics},
            {"checks", row.checks.size()},
            {"missed", missed_json(row)},
            {"unexpected", row.unexpected},
            {"disagrees_with", row.disagrees_with}};
  if (row.cost_left_out) json["cost_left_out"] = true;
  if (row.cost)
    json["cost"] = {{"step", row.cost->ns_per_step},      {"low", row.cost->ns_per_step_low},
                    {"high", row.cost->ns_per_step_high}, {"second", row.cost->ns_per_simulated_second},
                    {"setup", row.cost->setup_ns},        {"repetitions", row.cost->repetitions}};
  return json;
}

// Rounds a number of a replay for drawing, to 7 digits.
double drawn(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 6);
  return std::round(value / unit) * unit;
}

Json motion_json(const Stage& stage) {
  Json frames = Json::array();
  for (const std::vector<Pose>& poses : stage.truth) {
    Json frame = Json::array();
    for (const Pose& pose : poses)
      for (const double value : {pose.x, pose.y, pose.angle})
        frame.push_back(static_cast<float>(drawn(value)));
    frames.push_back(std::move(frame));
  }
  return {{"times", stage.times}, {"poses", frames}};
}

Json scene_json(std::span<const Result> rows, const std::map<std::string, std::string>& replays) {
  const sweep::SceneTrade trade = sweep::trade_of(rows, nullptr);
  Json json{{"label", trade.label},
            {"truth", rows.front().truth},
            {"duration", rows.front().duration},
            {"metric", trade.metric->name}};
  Json list = Json::array(), orders = Json::array();
  for (const Result& row : rows) {
    list.push_back(row_json(row));
    if (const auto found = replays.find(sweep::key_of(row)); found != replays.end())
      list.back()["replay"] = Json::parse(found->second);
  }
  for (const sweep::EngineTrade& engine : trade.engines)
    if (engine.order)
      orders.push_back(
          {{"engine", engine.engine}, {"order", engine.order->order}, {"pairs", engine.order->pairs}});
  json["rows"] = list;
  json["orders"] = orders;
  if (std::optional<Stage> stage = stage_of(trade.label, 2)) {
    const std::size_t bodies = std::max<std::size_t>(1, stage->problem.scene.bodies.size());
    const std::size_t frames =
        std::min<std::size_t>(kFrames, std::max<std::size_t>(2, kLargestMotion / bodies));
    stage = stage_of(trade.label, static_cast<int>(frames));
    json["summary"] = stage->summary;
    json["scene"] = Json::parse(to_json(stage->problem.scene, -1));
    if (!stage->truth.empty()) json["motion"] = motion_json(*stage);
  }
  return json;
}

}  // namespace

std::string report_data(const std::string& title, std::span<const Result> rows,
                        const std::vector<EnvironmentUse>& environments,
                        const std::map<std::string, std::string>& replays, const Extremes& extremes) {
  Json json{{"title", title}, {"engines", sweep::engines_of(rows)}};
  json["metrics"] = Json::object();
  for (const MetricField& field : kMetricFields) json["metrics"][std::string(field.name)] = field.unit;
  json["environments"] = Json::array();
  for (const EnvironmentUse& use : environments) json["environments"].push_back(environment_json(use));
  json["standings"] = Json::array();
  for (const Standing& row : standings(rows)) json["standings"].push_back(standing_json(row));
  json["scenes"] = Json::array();
  for (const std::vector<Result>& scene : sweep::by_label(rows))
    json["scenes"].push_back(scene_json(scene, replays));
  json["extremes"] = Json::parse(extremes_data(extremes));
  // A "<" occurs only in strings, where \u003c means the same.
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    c == '<' ? out.append("\\u003c") : out.append(1, c);
  return out;
}

}  // namespace plumb::harness::report
