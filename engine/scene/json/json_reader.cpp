#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/text.h"
#include "engine/scene/check.h"
#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/scene/json/json_document.h"
#include "engine/scene/json/json_fields.h"
#include "engine/scene/json/json_joints.h"
#include "engine/scene/json/json_place.h"
#include "engine/scene/names.h"

namespace plumb {
namespace {

using json::Fields;
using json::View;

Fields::Keys operator+(Fields::Keys keys, const Fields::Keys& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

/// Returns the index in `names` of the object's "type". `keys` are those of all types, so that a mistyped
/// "type" is reported as such.
template <std::size_t kCount>
std::size_t type_of(const View& view, std::string_view what, const Fields::Keys& keys,
                    const std::array<std::string_view, kCount>& names) {
  return choice(Fields(view, what, keys).required("type"), names);
}

void read_version(const Fields& fields) {
  if (!fields.has("plumb_scene")) return;
  const View version = fields.required("plumb_scene");
  if (json::number(version) != 1) {
    version.fail(Error::Kind::Unsupported,
                 "must be 1, the version of the scene format that this plumb reads");
  }
}

ContactRules read_contact_rules(const View& view) {
  const Fields fields(
      view, "contact_rules",
      {"friction", "restitution", "restitution_threshold", "simultaneous", "impact", "yield_speed",
       "tangential_restitution", "friction_after_stop", "friction_while_sliding"});
  ContactRules rules;
  fields.read("friction", rules.friction, kCombineNames);
  fields.read("restitution", rules.restitution, kCombineNames);
  fields.read("restitution_threshold", rules.restitution_threshold);
  fields.read("simultaneous", rules.simultaneous, kSimultaneousNames);
  fields.read("impact", rules.impact, kImpactNames);
  fields.read("yield_speed", rules.yield_speed);
  fields.read("tangential_restitution", rules.tangential_restitution);
  fields.read("friction_after_stop", rules.friction_after_stop);
  fields.read("friction_while_sliding", rules.friction_while_sliding);
  return rules;
}

Filter read_filter(const View& view) {
  const Fields fields(view, "a filter", {"category", "mask", "group"});
  Filter filter;
  fields.read("category", filter.category);
  fields.read("mask", filter.mask);
  fields.read("group", filter.group);
  return filter;
}

Fields::Keys shape_keys() {
  return {"type",          "position", "angle", "friction", "restitution", "rolling_resistance",
          "surface_speed", "density",  "filter"};
}

std::vector<Vec2d> read_points(const View& view) {
  if (view.node().kind != json::Kind::Array)
    view.fail(Error::Kind::Syntax, "must be a list of points [[x, y], ...]");
  std::vector<Vec2d> points;
  for (const json::Node& item : view.node().items) points.push_back(json::vector(View(item, view)));
  return points;
}

Geometry read_geometry(const View& view) {
  const Fields::Keys any =
      shape_keys() + Fields::Keys{"radius", "width", "height", "start", "end", "points", "closed"};
  const auto of = [&](std::string_view what, const Fields::Keys& keys) {
    return Fields(view, what, shape_keys() + keys);
  };
  switch (type_of(view, "a shape", any, kGeometryNames)) {
    case 0: {
      const Fields fields = of("a circle", {"radius"});
      return Circle{json::number(fields.required("radius"))};
    }
    case 1: {
      const Fields fields = of("a box", {"width", "height"});
      return Box{json::number(fields.required("width")), json::number(fields.required("height"))};
    }
    case 2: {
      const Fields fields = of("a capsule", {"start", "end", "radius"});
      return Capsule{json::vector(fields.required("start")), json::vector(fields.required("end")),
                     json::number(fields.required("radius"))};
    }
    case 3: {
      const Fields fields = of("a polygon", {"points", "radius"});
      Polygon polygon{.points = read_points(fields.required("points"))};
      fields.read("radius", polygon.radius);
      return polygon;
    }
    case 4: {
      const Fields fields = of("a segment", {"start", "end"});
      return Segment{json::vector(fields.required("start")), json::vector(fields.required("end"))};
    }
    default: {
      const Fields fields = of("a chain", {"points", "closed"});
      Chain chain{.points = read_points(fields.required("points"))};
      fields.read("closed", chain.closed);
      return chain;
    }
  }
}

Shape read_shape(const View& view) {
  Shape shape{.geometry = read_geometry(view)};
  const Fields fields(
      view, "a shape",
      shape_keys() + Fields::Keys{"radius", "width", "height", "start", "end", "points", "closed"});
  fields.read("position", shape.position);
  fields.read("angle", shape.angle);
  fields.read("friction", shape.friction);
  fields.read("restitution", shape.restitution);
  fields.read("rolling_resistance", shape.rolling_resistance);
  fields.read("surface_speed", shape.surface_speed);
  if (fields.has("density")) shape.density = json::number(fields.required("density"));
  if (fields.has("filter")) shape.filter = read_filter(fields.required("filter"));
  return shape;
}

/// Reads a formula: text, or a number in its place.
std::string read_formula(const View& view) {
  if (view.node().kind == json::Kind::Number) {
    const double value = json::number(view);
    if (!(std::abs(value) <= kLargest))
      view.fail(Error::Kind::Value, "must be at most " + shortest(kLargest) + " in magnitude");
    return shortest(value);
  }
  std::string text = json::string(view);
  if (text.empty()) view.fail(Error::Kind::Syntax, "is no formula: it is empty");
  return text;
}

PrescribedMotion read_motion(const View& view) {
  const Fields fields(view, "a motion", {"x", "y", "angle"});
  PrescribedMotion motion;
  if (fields.has("x")) motion.x = read_formula(fields.required("x"));
  if (fields.has("y")) motion.y = read_formula(fields.required("y"));
  if (fields.has("angle")) motion.angle = read_formula(fields.required("angle"));
  return motion;
}

Drive read_drive(const View& view) {
  const Fields fields(view, "a drive", {"joint", "speed"});
  return {json::string(fields.required("joint")), read_formula(fields.required("speed"))};
}

Body read_body(const View& view) {
  const Fields fields(view, "a body",
                      {"name", "type", "position", "angle", "velocity", "angular_velocity", "mass", "inertia",
                       "fixed_rotation", "lock_x", "lock_y", "gravity_scale", "linear_damping",
                       "angular_damping", "motion", "shapes"});
  Body body{.name = json::string(fields.required("name"))};
  fields.read("type", body.type, kBodyTypeNames);
  fields.read("position", body.position);
  fields.read("angle", body.angle);
  fields.read("velocity", body.velocity);
  fields.read("angular_velocity", body.angular_velocity);
  fields.read("mass", body.mass);
  if (fields.has("inertia")) body.inertia = json::number(fields.required("inertia"));
  fields.read("fixed_rotation", body.fixed_rotation);
  fields.read("lock_x", body.lock_x);
  fields.read("lock_y", body.lock_y);
  fields.read("gravity_scale", body.gravity_scale);
  fields.read("linear_damping", body.linear_damping);
  fields.read("angular_damping", body.angular_damping);
  if (fields.has("motion")) body.motion = read_motion(fields.required("motion"));
  fields.each("shapes", [&](const View& shape) { body.shapes.push_back(read_shape(shape)); });
  if (body.type == BodyType::Dynamic && !fields.has("mass"))
    body.mass = mass_by_density(body).value_or(body.mass);
  return body;
}

LinearDrag read_linear_drag(const Fields& fields) {
  LinearDrag law{json::string(fields.required("body")), json::number(fields.required("coefficient"))};
  fields.read("angular_coefficient", law.angular_coefficient);
  return law;
}

QuadraticDrag read_quadratic_drag(const Fields& fields) {
  return {json::string(fields.required("body")), json::number(fields.required("coefficient"))};
}

PointForce read_point_force(const Fields& fields) {
  PointForce law{.body = json::string(fields.required("body")),
                 .force = json::vector(fields.required("force"))};
  fields.read("point", law.point);
  fields.read("frame", law.frame, kFrameNames);
  fields.read("start", law.start);
  fields.read("duration", law.duration);
  return law;
}

Torque read_torque(const Fields& fields) {
  Torque law{.body = json::string(fields.required("body")),
             .torque = json::number(fields.required("torque"))};
  fields.read("start", law.start);
  fields.read("duration", law.duration);
  return law;
}

SpringForce read_spring(const Fields& fields) {
  SpringForce law{.body_a = json::string(fields.required("body_a")),
                  .body_b = json::string(fields.required("body_b"))};
  fields.read("anchor_a", law.anchor_a);
  fields.read("anchor_b", law.anchor_b);
  fields.read("rest_length", law.rest_length);
  law.stiffness = json::number(fields.required("stiffness"));
  fields.read("damping", law.damping);
  return law;
}

AttractionForce read_attraction(const Fields& fields) {
  AttractionForce law{.body = json::string(fields.required("body"))};
  fields.read("centre_body", law.centre_body);
  fields.read("centre", law.centre);
  law.strength = json::number(fields.required("strength"));
  if (fields.has("exponent")) {
    law.exponent =
        static_cast<int>(json::integer(fields.required("exponent"), -kLargestExponent, kLargestExponent));
  }
  return law;
}

SinusoidalForce read_sinusoidal_force(const Fields& fields) {
  SinusoidalForce law{.body = json::string(fields.required("body")),
                      .amplitude = json::vector(fields.required("amplitude"))};
  fields.read("point", law.point);
  law.angular_frequency = json::number(fields.required("angular_frequency"));
  fields.read("phase", law.phase);
  return law;
}

FormulaForce read_formula_force(const Fields& fields) {
  FormulaForce law{.body = json::string(fields.required("body"))};
  if (fields.has("force")) {
    const View force = fields.required("force");
    if (force.node().kind != json::Kind::Array || force.node().items.size() != 2)
      force.fail(Error::Kind::Syntax, "must be two formulas [x, y]");
    law.x = read_formula(View(force.node().items[0], force));
    law.y = read_formula(View(force.node().items[1], force));
  }
  if (fields.has("torque")) law.torque = read_formula(fields.required("torque"));
  fields.read("point", law.point);
  return law;
}

FormulaSpring read_formula_spring(const Fields& fields) {
  FormulaSpring law{.body_a = json::string(fields.required("body_a")),
                    .body_b = json::string(fields.required("body_b"))};
  fields.read("anchor_a", law.anchor_a);
  fields.read("anchor_b", law.anchor_b);
  law.tension = read_formula(fields.required("tension"));
  return law;
}

ForceLaw read_force(const View& view) {
  const Fields::Keys common{"type", "body"}, drag{"coefficient"}, turning{"angular_coefficient"},
      timed{"start", "duration"};
  const Fields::Keys point{"force", "point", "frame"}, torque{"torque"};
  const Fields::Keys ends{"body_a", "body_b", "anchor_a", "anchor_b"};
  const Fields::Keys spring{"rest_length", "stiffness", "damping"};
  const Fields::Keys attraction{"centre_body", "centre", "strength", "exponent"};
  const Fields::Keys wave{"amplitude", "angular_frequency", "phase"};
  const Fields::Keys tension{"tension"};
  const Fields::Keys any =
      common + drag + turning + timed + point + torque + ends + spring + attraction + wave + tension;
  switch (type_of(view, "a force", any, kForceNames)) {
    case 0:
      return read_linear_drag(Fields(view, "a linear_drag", common + drag + turning));
    case 1:
      return read_quadratic_drag(Fields(view, "a quadratic_drag", common + drag));
    case 2:
      return read_point_force(Fields(view, "a point_force", common + point + timed));
    case 3:
      return read_torque(Fields(view, "a torque", common + torque + timed));
    case 4:
      return read_spring(Fields(view, "a spring", Fields::Keys{"type"} + ends + spring));
    case 5:
      return read_attraction(Fields(view, "an attraction", common + attraction));
    case 6:
      return read_sinusoidal_force(Fields(view, "a sinusoidal_force", common + wave + Fields::Keys{"point"}));
    case 7:
      return read_formula_force(
          Fields(view, "a formula_force", common + torque + Fields::Keys{"force", "point"}));
    default:
      return read_formula_spring(Fields(view, "a formula_spring", Fields::Keys{"type"} + ends + tension));
  }
}

Scene read_scene(const View& view) {
  const Fields fields(
      view, "a scene",
      {"plumb_scene", "name", "gravity", "contact_rules", "bodies", "joints", "forces", "drives"});
  read_version(fields);
  Scene scene;
  fields.read("name", scene.name);
  fields.read("gravity", scene.gravity);
  if (fields.has("contact_rules")) scene.contact_rules = read_contact_rules(fields.required("contact_rules"));
  fields.each("bodies", [&](const View& body) { scene.bodies.push_back(read_body(body)); });
  fields.each("joints", [&](const View& joint) { scene.joints.push_back(json::read_joint(joint)); });
  fields.each("forces", [&](const View& force) { scene.forces.push_back(read_force(force)); });
  fields.each("drives", [&](const View& drive) { scene.drives.push_back(read_drive(drive)); });
  return scene;
}

}  // namespace

Scene scene_from_json(std::string_view text) {
  json::Document document;
  json::parse(text, document);
  if (document.refusal) {
    json::Refusal& refusal = *document.refusal;
    const auto [subject, field] = json::naming_of(refusal.path);
    throw Error(refusal.kind, subject, field, std::move(refusal.value), std::move(refusal.problem),
                refusal.line);
  }
  Scene scene = read_scene(View(document.root));
  Place place;
  try {
    check(scene, place);
  } catch (const Error& error) {
    throw error.at_line(json::line_of(document.root, place, error.field()));
  }
  return scene;
}

}  // namespace plumb
