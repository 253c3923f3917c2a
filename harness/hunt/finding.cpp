#include "harness/hunt/finding.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "engine/scene/names.h"

namespace plumb::harness::hunt {
namespace {

using Json = nlohmann::ordered_json;

std::string kind_of(const Joint& joint) {
  std::string out(kJointNames[joint.index()]);
  std::visit(
      [&](const auto& j) {
        if constexpr (requires { j.limits; }) out += j.limits ? " limits" : "";
        if constexpr (requires { j.motor; }) out += j.motor ? " motor" : "";
        if constexpr (requires { j.spring.has_value(); }) out += j.spring ? " spring" : "";
        if constexpr (requires { j.range; }) out += j.range ? " range" : "";
        if constexpr (requires { j.linear_spring; })
          out += j.linear_spring || j.angular_spring ? " spring" : "";
      },
      joint);
  return out;
}

const char* kind_of(const Geometry& geometry) {
  static constexpr const char* kNames[] = {"circle", "box", "capsule", "polygon", "segment", "chain"};
  return kNames[geometry.index()];
}

std::string joined(const std::set<std::string>& parts) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : ", ") + part;
  return out;
}

// Writes non-finite numbers as null: JSON has no others.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::string made_of(const Case& one, const std::string& law) {
  std::set<std::string> joints, shapes, grounds, actions;
  bool pairs = false;
  for (const Joint& joint : one.scene.joints) joints.insert(kind_of(joint));
  for (const Body& body : one.scene.bodies)
    for (const Shape& shape : body.shapes)
      (body.type == BodyType::Dynamic ? shapes : grounds).insert(kind_of(shape.geometry));
  for (const Action& action : one.actions)
    actions.insert(std::string(kActionNames[static_cast<std::size_t>(action.kind)]));
  if (law == "events" || law == "sensors") return joined(actions);  // only actions matter
  // Shapes matter only if they may touch: for bodies that never touch, only the motion of their centres
  // matters.
  pairs = !grounds.empty() || joints.empty();
  std::string out = joined(joints);
  if (pairs) {
    out += (out.empty() ? "" : "; ") + joined(shapes);
    if (!grounds.empty()) out += " on " + joined(grounds);
  }
  if (!actions.empty()) out += "; " + joined(actions);
  return out;
}

std::string to_json(const Finding& finding) {
  const Objection& o = finding.objection;
  Json out{{"engine", finding.engine},
           {"kind", finding.kind},
           {"law", o.law},
           {"judge", o.judge},
           {"what", o.what},
           {"right", o.right},
           {"figure", number(o.figure)},
           {"bound", number(o.bound)},
           {"unit", o.unit},
           {"time", o.time},
           {"subject", o.subject},
           {"shrunk", finding.shrunk},
           {"case", Json::parse(to_json(finding.smallest, -1))}};
  return out.dump();
}

Finding finding_from_json(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    const auto real = [&](const char* key) {
      return json.at(key).is_null() ? INFINITY : json.at(key).get<double>();
    };
    Finding out;
    out.engine = json.at("engine").get<std::string>();
    out.kind = json.at("kind").get<std::string>();
    out.objection = {.law = json.at("law").get<std::string>(),
                     .judge = json.at("judge").get<std::string>(),
                     .what = json.at("what").get<std::string>(),
                     .right = json.at("right").get<std::string>(),
                     .figure = real("figure"),
                     .bound = real("bound"),
                     .unit = json.at("unit").get<std::string>(),
                     .time = json.at("time").get<double>(),
                     .subject = json.at("subject").get<std::string>()};
    out.shrunk = json.at("shrunk").get<bool>();
    out.smallest = case_from_json(json.at("case").dump());
    return out;
  } catch (const Json::exception& error) {
    throw Error(Error::Kind::Syntax, "finding", "", "", error.what());
  }
}

}  // namespace plumb::harness::hunt
