#include "harness/result.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/environment.h"

namespace plumb::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kStatusNames[] = {"ok", "skipped", "failed", "crashed", "timeout", "diverged"};
constexpr Oracle kOracles[] = {Oracle::Exact, Oracle::Discrete, Oracle::Invariant, Oracle::Consensus,
                               Oracle::Self};

template <class Enum, class Names>
Enum parse(const std::string& name, const Names& all) {
  for (const Enum value : all)
    if (name_of(value) == name) return value;
  throw Error(Error::Kind::Syntax, "a result", "", name, "is not a member of a result");
}

double number(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

Json cost_json(const Cost& cost) {
  return {{"ns_per_step", cost.ns_per_step},
          {"ns_per_step_low", cost.ns_per_step_low},
          {"ns_per_step_high", cost.ns_per_step_high},
          {"ns_per_simulated_second", cost.ns_per_simulated_second},
          {"setup_ns", cost.setup_ns},
          {"repetitions", cost.repetitions},
          {"steps", cost.steps},
          {"each_ns_per_step", cost.each_ns_per_step}};
}

Json asked_json(const reference::StepSettings& asked) {
  Json json{{"dt", asked.dt}};
  if (asked.substeps) json["substeps"] = *asked.substeps;
  if (asked.tolerance) json["tolerance"] = *asked.tolerance;
  if (!asked.options.empty()) json["options"] = asked.options;
  return json;
}

reference::StepSettings asked_from(const Json& json) {
  reference::StepSettings asked{.dt = number(json.at("dt"))};
  if (json.contains("substeps")) asked.substeps = json.at("substeps").get<int>();
  if (json.contains("tolerance")) asked.tolerance = number(json.at("tolerance"));
  if (json.contains("options")) asked.options = json.at("options").get<std::map<std::string, std::string>>();
  return asked;
}

Json checks_json(const std::vector<Check>& checks) {
  Json array = Json::array();
  for (const Check& check : checks) {
    Json json{{"name", check.name},
              {"oracle", name_of(check.oracle)},
              {"value", check.value},
              {"tolerance", check.tolerance},
              {"pass", check.pass}};
    if (!check.known_limit.empty()) json["known_limit"] = check.known_limit;
    array.push_back(std::move(json));
  }
  return array;
}

Json result_json(const Result& result) {
  Json settings = Json::object(), metrics = Json::object();
  for (const auto& [name, value] : result.settings) settings[name] = value;
  for (const MetricField& field : kMetricFields) {
    const auto& value = result.metrics.*field.value;
    metrics[std::string(field.name)] = value ? Json(*value) : Json(nullptr);
  }
  const std::optional<bool> agrees = result.agrees_with_truth();
  Json json{{"scenario", result.scenario},
            {"variant", result.variant},
            {"size", result.size},
            {"label", result.label},
            {"engine", result.engine},
            {"engine_version", result.engine_version},
            {"precision", result.precision},
            {"dt", result.dt},
            {"sample", result.sample > 0 ? result.sample : result.dt},
            {"duration", result.duration},
            {"truth", result.truth},
            {"asked", asked_json(result.asked)},
            {"settings", settings},
            {"status", name_of(result.status)},
            {"reason", result.reason},
            {"metrics", metrics},
            {"cost", result.cost ? cost_json(*result.cost) : Json(nullptr)},
            {"checks", checks_json(result.checks)},
            {"agrees_with_truth", agrees ? Json(*agrees) : Json(nullptr)},
            {"agrees_with", result.agrees_with},
            {"disagrees_with", result.disagrees_with},
            {"unexpected", result.unexpected}};
  for (const MetricField& field : kMetricFields)
    if (const auto& value = result.truth_within.*field.value)
      json["truth_within"][std::string(field.name)] = *value;
  if (result.truth_asked) json["truth_asked"] = asked_json(*result.truth_asked);
  if (!result.cost_reason.empty()) json["cost_reason"] = result.cost_reason;
  if (result.foreign_cost) json["foreign_cost"] = true;
  if (!result.excused.empty()) json["excused"] = result.excused;
  return json;
}

// Replaces invalid bytes: engines' messages may hold anything, JSON holds only UTF-8.
std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Cost cost_from(const Json& json) {
  return {number(json.at("ns_per_step")),      number(json.at("ns_per_step_low")),
          number(json.at("ns_per_step_high")), number(json.at("ns_per_simulated_second")),
          number(json.at("setup_ns")),         json.at("repetitions").get<int>(),
          json.at("steps").get<int>(),         json.value("each_ns_per_step", std::vector<double>{})};
}

Result result_from(const Json& json) {
  Result result;
  result.scenario = json.at("scenario");
  result.variant = json.at("variant");
  result.size = json.at("size");
  result.label = json.at("label");
  result.engine = json.at("engine");
  result.engine_version = json.at("engine_version");
  result.precision = json.at("precision");
  result.dt = number(json.at("dt"));
  result.sample = json.contains("sample") ? number(json.at("sample")) : result.dt;
  result.duration = number(json.at("duration"));
  result.truth = json.at("truth");
  result.asked =
      json.contains("asked") ? asked_from(json.at("asked")) : reference::StepSettings{.dt = result.dt};
  for (const auto& [name, value] : json.at("settings").items()) result.settings.emplace_back(name, value);
  static constexpr Status kStatuses[] = {Status::Ok,      Status::Skipped, Status::Failed,
                                         Status::Crashed, Status::Timeout, Status::Diverged};
  result.status = parse<Status>(json.at("status"), kStatuses);
  result.reason = json.at("reason");
  for (const MetricField& field : kMetricFields) {
    const Json& value =
        json.at("metrics").value(std::string(field.name), Json());  // older results lack the newest
    if (!value.is_null()) result.metrics.*field.value = value.get<double>();
  }
  if (const auto within = json.find("truth_within"); within != json.end())
    for (const MetricField& field : kMetricFields)
      if (const auto value = within->find(std::string(field.name)); value != within->end())
        result.truth_within.*field.value = number(*value);
  if (json.contains("truth_asked")) result.truth_asked = asked_from(json.at("truth_asked"));
  if (!json.at("cost").is_null()) result.cost = cost_from(json.at("cost"));
  for (const Json& check : json.at("checks")) {
    result.checks.push_back({check.at("name"), parse<Oracle>(check.at("oracle"), kOracles),
                             number(check.at("value")), number(check.at("tolerance")), check.at("pass"),
                             check.value("known_limit", "")});
  }
  result.agrees_with = json.at("agrees_with").get<std::vector<std::string>>();
  result.disagrees_with = json.at("disagrees_with").get<std::vector<std::string>>();
  result.unexpected = json.at("unexpected").get<std::vector<std::string>>();
  if (const auto where = json.find("environment"); where != json.end() && where->is_object())
    result.machine = where->value("machine", where->value("cpu", ""));
  result.cost_reason = json.value("cost_reason", "");
  result.foreign_cost = json.value("foreign_cost", false);
  result.excused = json.value("excused", "");
  return result;
}

}  // namespace

std::string_view name_of(Status status) { return kStatusNames[static_cast<int>(status)]; }

const Check* Result::find_check(std::string_view name) const {
  for (const Check& check : checks)
    if (check.name == name) return &check;
  return nullptr;
}

std::optional<bool> Result::agrees_with_truth() const {
  if (!ran()) return std::nullopt;
  return status == Status::Ok && std::ranges::all_of(checks, [](const Check& check) { return check.pass; });
}

std::string to_json(const Result& result) { return dump(result_json(result)); }

std::string to_json_with_environment(const Result& result) {
  const Environment where = environment();
  Json json = result_json(result);
  json["environment"] = {{"plumb_version", where.plumb_version},
                         {"commit", where.commit},
                         {"compiler", where.compiler},
                         {"flags", where.flags},
                         {"build_type", where.build_type},
                         {"cpu", where.cpu},
                         {"os", where.os},
                         {"date", where.date}};
  return dump(json);
}

Result result_from_json(std::string_view text) {
  try {
    return result_from(Json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw Error(Error::Kind::Syntax, "a result", "", std::string(text.substr(0, 80)),
                fmt::format("cannot be read: {}", error.what()));
  }
}

}  // namespace plumb::harness
