#include "harness/thresholds/finding.h"

#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/table.h"

namespace plumb::harness::thresholds {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kOutcomes[] = {"found", "always", "never", "refused", "unclear"};

Finding::Outcome outcome_from(const std::string& name) {
  for (std::size_t i = 0; i < std::size(kOutcomes); ++i)
    if (kOutcomes[i] == name) return static_cast<Finding::Outcome>(i);
  throw Error(Error::Kind::Syntax, "a threshold", "outcome", name, "is not an outcome of a threshold");
}

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::optional<double> optional_from(const Json& json) {
  return json.is_number() ? std::optional(json.get<double>()) : std::nullopt;
}

Finding from(const Json& json) {
  const auto text = [&](const char* name) { return json.at(name).get<std::string>(); };
  Finding out{.name = text("name"),
              .title = text("title"),
              .quantity = text("quantity"),
              .unit = text("unit"),
              .source = text("source"),
              .judged = text("judged"),
              .holds_below = text("holds") == "below",
              .exact = optional_from(json.at("exact")),
              .engine = text("engine"),
              .engine_version = text("engine_version"),
              .setting = text("setting"),
              .digits = json.at("digits").get<int>(),
              .outcome = outcome_from(text("outcome")),
              .found = optional_from(json.at("found")),
              .low = json.at("low").get<double>(),
              .high = json.at("high").get<double>(),
              .reason = text("reason"),
              .runs = json.at("runs").get<int>(),
              .seconds = json.at("seconds").get<double>()};
  for (const auto& [name, value] : json.at("settings").items())
    out.settings.emplace_back(name, value.get<std::string>());
  return out;
}

}  // namespace

std::optional<double> Finding::relative_difference() const {
  if (!found || !exact || *exact == 0) return {};
  return *found / *exact - 1;
}

std::string_view name_of(Finding::Outcome outcome) { return kOutcomes[static_cast<std::size_t>(outcome)]; }

std::string to_json(const Finding& finding) {
  Json settings = Json::object();
  for (const auto& [name, value] : finding.settings) settings[name] = value;
  const Json json{{"kind", "threshold"},
                  {"name", finding.name},
                  {"title", finding.title},
                  {"quantity", finding.quantity},
                  {"unit", finding.unit},
                  {"holds", finding.holds_below ? "below" : "above"},
                  {"exact", number_or_null(finding.exact)},
                  {"source", finding.source},
                  {"judged", finding.judged},
                  {"engine", finding.engine},
                  {"engine_version", finding.engine_version},
                  {"setting", finding.setting},
                  {"settings", settings},
                  {"digits", finding.digits},
                  {"found", number_or_null(finding.found)},
                  {"low", finding.low},
                  {"high", finding.high},
                  {"outcome", name_of(finding.outcome)},
                  {"reason", finding.reason},
                  {"runs", finding.runs},
                  {"seconds", finding.seconds}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Finding finding_from_json(std::string_view text) {
  try {
    return from(Json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw Error(Error::Kind::Syntax, "a threshold", "", "", error.what());
  }
}

std::string finding_csv_header() {
  return "name,unit,exact,engine,engine_version,setting,outcome,found,low,high,runs,reason";
}

std::string to_csv(const Finding& finding) {
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string();
  };
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", csv_field(finding.name), csv_field(finding.unit),
                     number(finding.exact), csv_field(finding.engine), csv_field(finding.engine_version),
                     csv_field(finding.setting), name_of(finding.outcome), number(finding.found), finding.low,
                     finding.high, finding.runs, csv_field(finding.reason));
}

}  // namespace plumb::harness::thresholds
