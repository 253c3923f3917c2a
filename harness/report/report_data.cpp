#include "harness/report/report_data.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/json.h"
#include "harness/agreement.h"
#include "harness/report/shown_rows.h"
#include "harness/report/stage.h"
#include "harness/report/standing.h"
#include "harness/sweep/rows.h"
#include "harness/sweep/space.h"
#include "harness/sweep/trade.h"

namespace plumb::harness::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFrames = 241;                   // frames of the truth's motion
constexpr std::size_t kLargestMotion = 40000;  // poses per scene; scenes of many bodies have fewer frames
// Size limit of a page, so that browsers open it within three seconds and mail can carry it: 20 MB with the
// charts' library. A run takes about 450 bytes; each kind of settings is stored once. Motions get the space
// that runs leave.
constexpr std::size_t kRoom = 18'000'000;  // bytes
constexpr std::size_t kShown = 14'000;     // runs
constexpr std::size_t kShownOfAnEngine =
    4;  // least number of runs per engine and scene: default, best, two of the front
constexpr std::size_t kExceptions = 3000;  // points of rivals that plumb does not dominate
constexpr std::size_t kFailureKinds = 50;  // kinds of failures of a scene

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

// Returns at most `most` of the points at which a rival beats plumb by most, in the order of the sweep.
std::vector<sweep::Dominance::Exception> worst(const Standing& row, std::size_t most) {
  std::vector<sweep::Dominance::Exception> out = row.dominance.exceptions;
  if (out.size() <= most) return out;
  const auto badness = [](const sweep::Dominance::Exception& point) {
    return point.noise ? 0 : point.cost_ratio > 0 ? point.cost_ratio : INFINITY;
  };
  std::vector<double> all;
  for (const auto& point : out) all.push_back(badness(point));
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(most), all.end(), std::greater<>());
  const double bound = all[most];
  std::size_t room = most;
  std::erase_if(out, [&](const auto& point) {
    if (room == 0 || badness(point) < bound) return true;
    --room;
    return false;
  });
  return out;
}

Json standing_json(const Standing& row, std::size_t most) {
  Json exceptions = Json::array();
  for (const sweep::Dominance::Exception& point : worst(row, most))
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

// Rounds a number to 7 digits for drawing. Only these digits are written.
double drawn(double value) {
  return std::isfinite(value) ? std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr) : value;
}

/// Effective settings; each kind is stored once, because settings take more space than the rest of a run.
class SettingsTable {
 public:
  std::size_t place_of(const Result& row) {
    Json one = Json::object();
    for (const auto& [name, value] : row.settings)
      if (name != "dt" || value != fmt::format("{}", row.dt)) one[name] = value;
    const auto [place, fresh] =
        places_.try_emplace(one.dump(-1, ' ', false, Json::error_handler_t::replace), places_.size());
    if (fresh) json_.push_back(std::move(one));
    return place->second;
  }
  const Json& json() const { return json_; }

 private:
  std::map<std::string, std::size_t> places_;
  Json json_ = Json::array();
};

Json row_json(const Result& row, SettingsTable& settings) {
  Json metrics = Json::object();
  for (const MetricField& field : kMetricFields)
    if (const auto& value = row.metrics.*field.value) metrics[std::string(field.name)] = drawn(*value);
  Json json{{"engine", row.engine},
            {"version", row.engine_version},
            {"precision", row.precision},
            {"dt", row.dt},
            {"asked", sweep::settings_text(row.asked)},
            {"settings", settings.place_of(row)},
            {"status", name_of(row.status)},
            {"reason", row.reason},
            {"metrics", metrics},
            {"missed", missed_json(row)},
            {"unexpected", row.unexpected}};
  if (row.cost_left_out) json["cost_left_out"] = true;
  if (row.cost)
    json["cost"] = {
        {"step", drawn(row.cost->ns_per_step)},      {"low", drawn(row.cost->ns_per_step_low)},
        {"high", drawn(row.cost->ns_per_step_high)}, {"second", drawn(row.cost->ns_per_simulated_second)},
        {"setup", drawn(row.cost->setup_ns)},        {"repetitions", row.cost->repetitions}};
  return json;
}

// Counts all runs of a scene, including those that are not shown.
Json runs_json(std::span<const Result> rows) {
  std::map<std::string, int> statuses;
  std::map<std::string, std::pair<std::string, int>> failures;  // by text: status, runs
  int missed = 0, unexpected = 0, left_out = 0;
  std::size_t checks = 0, held = 0;
  for (const Result& row : rows) {
    const std::string status(name_of(row.status));
    ++statuses[status];
    const auto passed = static_cast<std::size_t>(
        std::count_if(row.checks.begin(), row.checks.end(), [](const Check& check) { return check.pass; }));
    checks += row.checks.size();
    held += passed;
    missed += passed < row.checks.size() ? 1 : 0;
    unexpected += row.unexpected.empty() ? 0 : 1;
    left_out += row.cost_left_out ? 1 : 0;
    const auto fail = [&](const std::string& text, const std::string& kind) {
      ++failures.try_emplace(row.engine + ": " + text, kind, 0).first->second.second;
    };
    if (row.status != Status::Ok) fail(row.reason.empty() ? status : status + ": " + row.reason, status);
    for (const std::string& sentence : row.unexpected) fail(sentence, "failed");
  }
  std::vector<std::pair<std::string, std::pair<std::string, int>>> sorted(failures.begin(), failures.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.second > b.second.second; });
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(sorted.size(), kFailureKinds); ++i)
    list.push_back(
        {{"text", sorted[i].first}, {"status", sorted[i].second.first}, {"runs", sorted[i].second.second}});
  return {{"all", rows.size()},
          {"statuses", statuses},
          {"missed", missed},
          {"unexpected", unexpected},
          {"left_out", left_out},
          {"checks", checks},
          {"held", held},
          {"failures", list},
          {"failure_kinds", sorted.size()}};
}

Json motion_json(const Stage& stage) {
  Json frames = Json::array();
  for (const std::vector<Pose>& poses : stage.truth) {
    Json frame = Json::array();
    for (const Pose& pose : poses)
      for (const double value : {pose.x, pose.y, pose.angle}) frame.push_back(drawn(value));
    frames.push_back(std::move(frame));
  }
  return {{"times", stage.times}, {"poses", frames}};
}

/// Motions of a scene. They are stored separately, because their space is known only when the rest of the
/// scene is.
struct Motions {
  Json truth;                             ///< null if there is none
  std::map<std::size_t, Json> replays{};  ///< by the place of their row
};

std::size_t size_of(const Motions& motions) {
  std::size_t out = motions.truth.dump().size();
  for (const auto& [place, replay] : motions.replays) out += replay.dump().size();
  return out;
}

// Keeps every `every`-th sample of a motion and the last. The figures of a kept sample are the largest since
// the one before.
Json thinned(const Json& motion, std::size_t every) {
  if (every == 1 || !motion.is_object()) return motion;
  const std::size_t count = motion.at("times").size();
  Json out = Json::object();
  for (const auto& [name, values] : motion.items()) {
    const bool largest = name == "errors" || name == "energies";
    Json kept = Json::array(), most;
    for (std::size_t i = 0; i < std::min(count, values.size()); ++i) {
      if (largest && values[i].is_number() && (!most.is_number() || values[i] > most)) most = values[i];
      if (i % every != 0 && i + 1 != count) continue;
      kept.push_back(largest ? most : values[i]);
      most = nullptr;
    }
    out[name] = std::move(kept);
  }
  return out;
}

Json scene_json(std::span<const Result> rows, const std::map<std::string, std::string>& replays,
                std::size_t most, SettingsTable& settings, Motions& motions) {
  const sweep::SceneTrade trade = sweep::trade_of(rows, nullptr);
  Json json{{"label", trade.label},
            {"truth", trade.one_truth ? rows.front().truth : std::string(sweep::kOwnLimits)},
            {"one_truth", trade.one_truth},
            {"duration", rows.front().duration},
            {"metric", trade.metric->name},
            {"runs", runs_json(rows)}};
  Json list = Json::array(), orders = Json::array();
  std::vector<const std::string*> replay(rows.size(), nullptr);
  std::vector<bool> kept(rows.size(), false);
  if (!replays.empty()) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto found = replays.find(sweep::key_of(rows[i]));
      if (found == replays.end()) continue;
      replay[i] = &found->second;
      kept[i] = true;
    }
  }
  for (const std::size_t place : shown_rows(rows, *trade.metric, kept, most)) {
    if (replay[place] != nullptr) motions.replays[list.size()] = Json::parse(*replay[place]);
    list.push_back(row_json(rows[place], settings));
  }
  for (const sweep::EngineTrade& engine : trade.engines)
    if (engine.order)
      orders.push_back(
          {{"engine", engine.engine}, {"order", engine.order->order}, {"pairs", engine.order->pairs}});
  if (const std::vector<Agreement> agreement = agreements(rows); !agreement.empty())
    json["agreement"] = Json::parse(agreement_json(agreement.front()));
  json["rows"] = list;
  json["orders"] = orders;
  if (std::optional<Stage> stage = stage_of(trade.label, 2)) {
    const std::size_t bodies = std::max<std::size_t>(1, stage->problem.scene.bodies.size());
    const std::size_t frames =
        std::min<std::size_t>(kFrames, std::max<std::size_t>(2, kLargestMotion / bodies));
    stage = stage_of(trade.label, static_cast<int>(frames));
    json["summary"] = stage->summary;
    json["scene"] = Json::parse(to_json(stage->problem.scene, -1));
    if (!stage->truth.empty()) motions.truth = motion_json(*stage);
  }
  return json;
}

std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

// Adds the motions, all with the largest number of samples for which there is room.
void add_motions(Json& json, std::vector<Motions> motions) {
  const std::size_t others = dump(json).size();
  std::size_t wanted = 0;
  for (const Motions& one : motions) wanted += size_of(one);
  const std::size_t room = std::max(kRoom - std::min(kRoom, others), kRoom / 4);
  const std::size_t every = std::max<std::size_t>(1, (wanted + room - 1) / room);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    Json& scene = json["scenes"][i];
    if (!motions[i].truth.is_null()) scene["motion"] = thinned(motions[i].truth, every);
    for (const auto& [place, replay] : motions[i].replays)
      scene["rows"][place]["replay"] = thinned(replay, every);
  }
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
  const std::vector<Standing> standing = standings(rows);
  std::vector<std::size_t> exceptions, runs;
  for (const Standing& row : standing) exceptions.push_back(row.dominance.exceptions.size());
  json["standings"] = Json::array();
  for (const Standing& row : standing)
    json["standings"].push_back(standing_json(row, fair_share(exceptions, kExceptions, 1)));
  const std::vector<std::vector<Result>> scenes = sweep::by_label(rows);
  for (const std::vector<Result>& scene : scenes) {
    std::map<std::string, std::size_t> engines;
    for (const Result& row : scene) ++engines[row.engine];
    for (const auto& [engine, count] : engines) runs.push_back(count);
  }
  SettingsTable settings;
  std::vector<Motions> motions;
  json["scenes"] = Json::array();
  for (const std::vector<Result>& scene : scenes)
    json["scenes"].push_back(scene_json(scene, replays, fair_share(runs, kShown, kShownOfAnEngine), settings,
                                        motions.emplace_back()));
  json["settings"] = settings.json();
  json["extremes"] = Json::parse(extremes_data(extremes));
  add_motions(json, std::move(motions));
  // A "<" occurs only in strings, where \u003c means the same.
  std::string out;
  for (const char c : dump(json)) c == '<' ? out.append("\\u003c") : out.append(1, c);
  return out;
}

}  // namespace plumb::harness::report
