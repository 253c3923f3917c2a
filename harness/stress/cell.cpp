#include "harness/stress/cell.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "harness/table.h"

namespace plumb::harness::stress {
namespace {

using Json = nlohmann::ordered_json;

// Returns null for a non-finite value, which JSON cannot hold.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

double number_from(const Json& json) { return json.is_null() ? INFINITY : json.get<double>(); }

Json settings_json(const Cell& cell) {
  Json out{{"dt", cell.dt}};
  for (const auto& [name, value] : cell.settings)
    if (name != "dt") out[name] = value;
  return out;
}

}  // namespace

std::string key_of(std::string_view family, double value, std::string_view engine, std::string_view setting) {
  return fmt::format("{}|{}|{}|{}", family, shortest(value), engine, setting);
}

std::string key_of(const Cell& cell) { return key_of(cell.family, cell.value, cell.engine, cell.setting); }

std::string to_json(const Cell& cell) {
  const Finding& finding = cell.finding;
  const bool measured = !finding.measure.empty();  // else the run ended before its figure was known
  const Json json{{"kind", "cell"},
                  {"family", cell.family},
                  {"title", cell.title},
                  {"axis", cell.axis},
                  {"unit", cell.unit},
                  {"value", cell.value},
                  {"engine", cell.engine},
                  {"setting", cell.setting},
                  {"settings", settings_json(cell)},
                  {"outcome", name_of(finding.verdict)},
                  {"measure", finding.measure},
                  {"figure", measured ? number(finding.figure) : Json(nullptr)},
                  {"figure_unit", finding.unit},
                  {"bound", measured ? number(finding.bound) : Json(nullptr)},
                  {"reason", finding.reason},
                  {"steps", cell.steps},
                  {"seconds", cell.seconds},
                  {"engine_seconds", cell.engine_seconds},
                  {"memory", cell.memory}};
  // Engines' messages need not be UTF-8.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Cell cell_from_json(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    Cell cell{.family = json.at("family"),
              .title = json.at("title"),
              .axis = json.at("axis"),
              .unit = json.at("unit")};
    cell.value = json.at("value");
    cell.engine = json.at("engine");
    cell.setting = json.at("setting");
    for (const auto& [name, value] : json.at("settings").items()) {
      if (name == "dt") cell.dt = value;
      if (name != "dt") cell.settings.emplace_back(name, value);
    }
    cell.finding = {.verdict = verdict_of(json.at("outcome").get<std::string>()),
                    .measure = json.at("measure"),
                    .figure = number_from(json.at("figure")),
                    .unit = json.at("figure_unit"),
                    .bound = number_from(json.at("bound")),
                    .reason = json.at("reason")};
    if (cell.finding.measure.empty()) cell.finding.figure = cell.finding.bound = 0;
    cell.steps = json.at("steps");
    cell.seconds = json.at("seconds");
    cell.engine_seconds = json.at("engine_seconds");
    cell.memory = json.at("memory");
    return cell;
  } catch (const nlohmann::json::exception& error) {
    throw Error(Error::Kind::Syntax, "a cell", "", "", error.what());
  }
}

std::string_view csv_columns() {
  return "family,axis,unit,value,engine,setting,outcome,measure,figure,figure_unit,bound,reason,steps,"
         "seconds,"
         "engine_seconds,memory";
}

std::string to_csv(const Cell& cell) {
  const Finding& finding = cell.finding;
  const bool measured = !finding.measure.empty();
  const auto text = [&](double value) { return measured ? fmt::format("{}", value) : ""; };
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", csv_field(cell.family),
                     csv_field(cell.axis), csv_field(cell.unit), cell.value, csv_field(cell.engine),
                     csv_field(cell.setting), name_of(finding.verdict), csv_field(finding.measure),
                     text(finding.figure), finding.unit, text(finding.bound), csv_field(finding.reason),
                     cell.steps, cell.seconds, cell.engine_seconds, cell.memory);
}

}  // namespace plumb::harness::stress
