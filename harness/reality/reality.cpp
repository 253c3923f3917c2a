#include "harness/reality/reality.h"

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/environment.h"
#include "harness/table.h"

namespace plumb::harness::reality {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Estimate& estimate, const char* name = "median") {
  return {{name, estimate.value}, {"low", estimate.low}, {"high", estimate.high}};
}

Json fitted_json(std::span<const Parameter> parameters, std::span<const Estimate> values) {
  Json out = Json::array();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    out.push_back({{"name", parameters[i].name}, {"unit", parameters[i].unit}});
    out.back().update(json_of(values[i], "value"));
  }
  return out;
}

Json ellipse_json(const EllipseFinding& law) {
  Json out{{"name", law.name}, {"text", law.text}, {"of_this_floor", law.of_this_floor}};
  out["parameters"] = fitted_json(law.parameters, law.fitted);
  out["validated"] = json_of(law.validated);
  out["train"] = json_of(law.train);
  out["test"] = json_of(law.median);
  out["test"]["ninetieth"] = json_of(law.ninetieth, "value");
  return out;
}

Json quantiles_json(const Quantiles& quantiles) {
  Json out = json_of(quantiles.median);
  out["ninetieth"] = json_of(quantiles.ninetieth, "value");
  return out;
}

Json ellipse_engine_json(const EllipseEngine& engine) {
  Json out{{"engine", engine.engine}, {"law", engine.law}, {"dt", engine.dt}};
  if (!engine.why_not.empty()) {
    out["skipped"] = engine.why_not;
    return out;
  }
  out["failed"] = engine.failed;
  out["numerical"] = quantiles_json(engine.numerical);
  out["law_error"] = quantiles_json(engine.of_the_law);
  out["total"] = quantiles_json(engine.measured);
  out["share"] = quantiles_json(engine.share);
  return out;
}

Json differences_json(const Differences& differences) {
  Json out = Json::array();
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    out.push_back({{"after", kTimes[i]},
                   {"position", json_of(differences.position[i])},
                   {"position_ninetieth", json_of(differences.ninetieth[i], "value")},
                   {"angle", json_of(differences.angle[i])},
                   {"angle_ninetieth", json_of(differences.angle_ninetieth[i], "value")}});
  }
  return out;
}

void append(std::vector<Figure>& out, Figure figure, const Differences& differences) {
  const bool share = figure.error == "share";
  figure.body = "square";
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    figure.after = kTimes[i];
    figure.quantity = "position";
    figure.unit = share ? "1" : "m";
    figure.median = differences.position[i];
    figure.ninetieth = differences.ninetieth[i];
    out.push_back(figure);
    figure.quantity = "angle";
    figure.unit = share ? "1" : "rad";
    figure.median = differences.angle[i];
    figure.ninetieth = differences.angle_ninetieth[i];
    out.push_back(figure);
  }
}

void append(std::vector<Figure>& out, const EllipseEngine& engine) {
  Figure figure;
  figure.body = "ellipse";
  figure.law = engine.law;
  figure.engine = engine.engine;
  figure.dt = engine.dt;
  figure.quantity = "velocity";
  figure.unit = "1";
  const auto add = [&](const char* error, const Quantiles& quantiles) {
    figure.error = error;
    figure.median = quantiles.median;
    figure.ninetieth = quantiles.ninetieth;
    out.push_back(figure);
  };
  add("numerical", engine.numerical);
  add("total", engine.measured);
  add("share", engine.share);
}

}  // namespace

Findings examine(const std::string& folder, std::span<const reference::Backend* const> engines,
                 std::uint64_t seed) {
  const std::filesystem::path path(folder);
  Findings out;
  out.seed = seed;
  out.ellipse = examine_ellipse(read_impacts((path / kImpactFile).string()), seed, engines);
  out.drops = examine_drops(read_drops((path / kDropFile).string()), engines, seed);
  return out;
}

std::vector<Figure> figures_of(const Findings& findings) {
  std::vector<Figure> out;
  const auto ellipse = [&](const EllipseFinding& law) {
    out.push_back({.body = "ellipse",
                   .law = law.name,
                   .engine = "",
                   .error = "law",
                   .quantity = "velocity",
                   .unit = "1",
                   .parameters = static_cast<int>(law.parameters.size()),
                   .median = law.median,
                   .ninetieth = law.ninetieth});
  };
  for (const EllipseFinding& law : findings.ellipse.laws) ellipse(law);
  ellipse(findings.ellipse.bound);
  for (const EllipseEngine& engine : findings.ellipse.engines)
    if (engine.why_not.empty()) append(out, engine);
  for (const DropFinding& law : findings.drops.laws) {
    Figure figure;
    figure.law = law.name;
    figure.engine = "plumb-precise";
    figure.error = "law";
    figure.parameters = static_cast<int>(law.parameters.size());
    append(out, figure, law.model);
  }
  for (const EngineFinding& engine : findings.drops.engines) {
    if (!engine.why_not.empty()) continue;
    Figure figure;
    figure.law = engine.law;
    figure.engine = engine.engine;
    figure.dt = engine.dt;
    figure.error = "numerical";
    append(out, figure, engine.numerical);
    figure.error = "total";
    append(out, figure, engine.measured);
    figure.error = "share";
    append(out, figure, engine.share);
  }
  return out;
}

std::string to_csv(const Findings& findings) {
  std::string out =
      "body,law,engine,dt,error,after,quantity,unit,parameters,median,low,high,ninetieth,ninetieth_low,"
      "ninetieth_high\n";
  for (const Figure& f : figures_of(findings)) {
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", f.body, csv_field(f.law),
                       csv_field(f.engine), f.dt, f.error, f.after, f.quantity, f.unit, f.parameters,
                       f.median.value, f.median.low, f.median.high, f.ninetieth.value, f.ninetieth.low,
                       f.ninetieth.high);
  }
  return out;
}

std::string to_json(const Findings& findings) {
  const EllipseFindings& ellipse = findings.ellipse;
  Json laws = Json::array();
  for (const EllipseFinding& law : ellipse.laws) laws.push_back(ellipse_json(law));
  Json impacts = Json::array();
  for (const EllipseEngine& engine : ellipse.engines) impacts.push_back(ellipse_engine_json(engine));
  Json out{{"seed", findings.seed}, {"plumb_version", version()}};
  out["ellipse"] = {{"impacts", ellipse.impacts},
                    {"doubted", ellipse.doubted},
                    {"best", ellipse.laws[ellipse.best].name},
                    {"best_of_all_floors", ellipse.laws[ellipse.best_of_all_floors].name},
                    {"laws", laws},
                    {"bound", ellipse_json(ellipse.bound)},
                    {"engines", impacts}};
  Json squares = Json::array(), engines = Json::array();
  for (const DropFinding& law : findings.drops.laws) {
    squares.push_back({{"name", law.name},
                       {"text", law.text},
                       {"parameters", fitted_json(law.parameters, law.fitted)},
                       {"law_error", differences_json(law.model)}});
  }
  for (const EngineFinding& engine : findings.drops.engines) {
    Json row{{"engine", engine.engine}, {"law", engine.law}, {"dt", engine.dt}};
    if (!engine.why_not.empty()) {
      row["skipped"] = engine.why_not;
    } else {
      row["failed"] = engine.failed;
      row["numerical"] = differences_json(engine.numerical);
      row["total"] = differences_json(engine.measured);
      row["share"] = differences_json(engine.share);
    }
    engines.push_back(row);
  }
  out["square"] = {{"drops", findings.drops.drops},
                   {"left_out", findings.drops.left_out},
                   {"tested", findings.drops.tested},
                   {"laws", squares},
                   {"engines", engines}};
  return out.dump() + "\n";
}

}  // namespace plumb::harness::reality
