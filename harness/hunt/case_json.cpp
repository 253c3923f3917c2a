#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "harness/hunt/case.h"

namespace plumb::harness::hunt {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const std::string& problem) {
  throw Error(Error::Kind::Syntax, "case", "", "", problem + "; `plumb hunt` writes such files");
}

template <class Enum, std::size_t kCount>
Enum named(const std::string& name, const std::string_view (&names)[kCount]) {
  for (std::size_t i = 0; i < kCount; ++i)
    if (names[i] == name) return static_cast<Enum>(i);
  refuse(fmt::format("'{}' is unknown", name));
}

Json to_object(const Action& action) {
  Json out{{"kind", kActionNames[static_cast<std::size_t>(action.kind)]},
           {"step", action.step},
           {"target", action.target}};
  if (action.kind == ActionKind::Teleport || action.kind == ActionKind::Push) {
    out["position"] = {action.position.x, action.position.y};
    out["angle"] = action.angle;
  }
  if (action.kind == ActionKind::SetType) out["type"] = static_cast<int>(action.type);
  if (action.kind == ActionKind::SetFilter) out["touches"] = action.touches;
  return out;
}

Action action_of(const Json& json) {
  Action out;
  out.kind = named<ActionKind>(json.at("kind").get<std::string>(), kActionNames);
  out.step = json.at("step").get<int>();
  out.target = json.at("target").get<std::string>();
  if (json.contains("position"))
    out.position = {json["position"].at(0).get<double>(), json["position"].at(1).get<double>()};
  out.angle = json.value("angle", 0.0);
  const int type = json.value("type", 0);
  if (type < 0 || type > 2) refuse("'type' of an action is 0 (static), 1 (kinematic) or 2 (dynamic)");
  out.type = static_cast<BodyType>(type);
  out.touches = json.value("touches", false);
  return out;
}

Json to_object(const Expectation& expectation) {
  Json out{{"name", expectation.name},
           {"body", expectation.body},
           {"quantity", kQuantityNames[static_cast<std::size_t>(expectation.quantity)]}};
  const auto number = [&](const char* key, double value) {
    if (std::isfinite(value)) out[key] = value;
  };
  number("lower", expectation.lower);
  number("upper", expectation.upper);
  number("from", expectation.from);
  number("to", expectation.to);
  out["needs"] = expectation.needs;
  if (!expectation.until.empty()) out["until"] = expectation.until;
  out["why"] = expectation.why;
  return out;
}

Expectation expectation_of(const Json& json) {
  Expectation out;
  out.name = json.at("name").get<std::string>();
  out.body = json.at("body").get<std::string>();
  out.quantity = named<Quantity>(json.at("quantity").get<std::string>(), kQuantityNames);
  out.lower = json.value("lower", out.lower);
  out.upper = json.value("upper", out.upper);
  out.from = json.value("from", out.from);
  out.to = json.value("to", out.to);
  out.needs = json.value("needs", out.needs);
  out.until = json.value("until", out.until);
  out.why = json.value("why", out.why);
  return out;
}

Case read(const Json& json) {
  if (!json.is_object() || !json.contains("plumb_hunt")) refuse("there is no member 'plumb_hunt'");
  Case out;
  out.seed = json.value("seed", std::uint64_t{0});
  out.index = json.value("index", std::uint64_t{0});
  out.idioms = json.value("idioms", out.idioms);
  out.scene = scene_from_json(json.at("scene").dump());
  out.dt = json.at("dt").get<double>();
  out.substeps = json.at("substeps").get<int>();
  out.steps = json.at("steps").get<int>();
  if (!(out.dt > 0) || out.substeps < 1 || out.steps < 1) refuse("dt, substeps and steps must be positive");
  out.sleeping = json.value("sleeping", false);
  out.sensors = json.value("sensors", out.sensors);
  out.case_file = json.value("case_file", out.case_file);
  for (const Json& action : json.value("actions", Json::array())) out.actions.push_back(action_of(action));
  for (const Json& each : json.value("expectations", Json::array()))
    out.expectations.push_back(expectation_of(each));
  return out;
}

}  // namespace

std::string to_json(const Case& one, int indent) {
  Json out{{"plumb_hunt", 1}, {"seed", one.seed},         {"index", one.index}, {"idioms", one.idioms},
           {"dt", one.dt},    {"substeps", one.substeps}, {"steps", one.steps}, {"sleeping", one.sleeping}};
  if (!one.sensors.empty()) out["sensors"] = one.sensors;
  if (!one.case_file.empty()) out["case_file"] = one.case_file;
  for (const Action& action : one.actions) out["actions"].push_back(to_object(action));
  for (const Expectation& each : one.expectations) out["expectations"].push_back(to_object(each));
  out["scene"] = Json::parse(plumb::to_json(one.scene, -1));
  return out.dump(indent);
}

Case case_from_json(std::string_view text) {
  try {
    return read(Json::parse(text));
  } catch (const Json::exception& error) {
    refuse(error.what());
  }
}

}  // namespace plumb::harness::hunt
