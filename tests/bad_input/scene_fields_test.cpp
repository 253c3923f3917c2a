// Every number of a scene, with every bad value: by itself and as JSON, and what runs do with what is
// accepted.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/json.h"
#include "engine/scene/validate.h"
#include "engine/simulation/simulation.h"
#include "engine/world/scene/scene_forces.h"
#include "tests/bad_input/refusal.h"
#include "tests/bad_input/scene_members.h"

namespace plumb::bad_input {
namespace {

// As the headers of the scene say, with the limits of engine/scene/check.h.
constexpr Rule kAny{-1e100, 1e100}, kNotNegative{0, 1e100}, kPositive{1e-100, 1e100}, kShare{0, 1};
constexpr Rule kNotZero{-1e100, 1e100, 1e-100}, kBound{-1e100, 1e100, 0, true}, kForEver{0, 1e100, 0, true};

std::map<std::string, Rule> scene_rules() {
  std::map<std::string, Rule> rules{{"Scene.gravity", kAny},
                                    {"ContactRules.friction", {0, 4}},
                                    {"ContactRules.restitution", {0, 4}},
                                    {"ContactRules.restitution_threshold", kNotNegative},
                                    {"ContactRules.simultaneous", {0, 1}},
                                    {"ContactRules.impact", {0, 2}},
                                    {"ContactRules.yield_speed", kNotNegative},
                                    {"ContactRules.tangential_restitution", kShare},
                                    {"ContactRules.friction_after_stop", kShare},
                                    {"ContactRules.friction_while_sliding", kShare},
                                    {"Body.type", {0, 2}},
                                    {"Body.position", kAny},
                                    {"Body.angle", kAny},
                                    {"Body.velocity", kAny},
                                    {"Body.angular_velocity", kAny},
                                    {"Body.mass", kPositive},
                                    {"Body.inertia", kPositive},
                                    {"Body.gravity_scale", kAny},
                                    {"Body.linear_damping", kNotNegative},
                                    {"Body.angular_damping", kNotNegative},
                                    {"Shape.position", kAny},
                                    {"Shape.angle", kAny},
                                    {"Shape.friction", kNotNegative},
                                    {"Shape.restitution", kShare},
                                    {"Shape.rolling_resistance", kNotNegative},
                                    {"Shape.surface_speed", kAny},
                                    {"Shape.density", kNotNegative},
                                    {"Filter.group", {-2147483648.0, 2147483647.0}},
                                    {"Circle.radius", kPositive},
                                    {"Box.width", kPositive},
                                    {"Box.height", kPositive},
                                    {"Capsule.start", kAny},
                                    {"Capsule.end", kAny},
                                    {"Capsule.radius", kPositive},
                                    {"Polygon.points", kAny},
                                    {"Polygon.radius", kNotNegative},
                                    {"Segment.start", kAny},
                                    {"Segment.end", kAny},
                                    {"Chain.points", kAny},
                                    {"LinearDrag.coefficient", kNotNegative},
                                    {"LinearDrag.angular_coefficient", kNotNegative},
                                    {"QuadraticDrag.coefficient", kNotNegative},
                                    {"PointForce.force", kAny},
                                    {"PointForce.point", kAny},
                                    {"PointForce.frame", {0, 1}},
                                    {"PointForce.start", kNotNegative},
                                    {"PointForce.duration", kForEver},
                                    {"Torque.torque", kAny},
                                    {"Torque.start", kNotNegative},
                                    {"Torque.duration", kForEver},
                                    {"SpringForce.anchor_a", kAny},
                                    {"SpringForce.anchor_b", kAny},
                                    {"SpringForce.rest_length", kNotNegative},
                                    {"SpringForce.stiffness", kNotNegative},
                                    {"SpringForce.damping", kNotNegative},
                                    {"AttractionForce.centre", kAny},
                                    {"AttractionForce.strength", kAny},
                                    {"AttractionForce.exponent", {-9, 9}},
                                    {"SinusoidalForce.amplitude", kAny},
                                    {"SinusoidalForce.point", kAny},
                                    {"SinusoidalForce.angular_frequency", kNotNegative},
                                    {"SinusoidalForce.phase", kAny},
                                    {"FormulaForce.point", kAny},
                                    {"FormulaSpring.anchor_a", kAny},
                                    {"FormulaSpring.anchor_b", kAny},
                                    {"Spring.hertz", kPositive},
                                    {"Spring.damping_ratio", kNotNegative},
                                    {"Motor.speed", kAny},
                                    {"Motor.max_force", kNotNegative},
                                    {"Range.lower", kBound},
                                    {"Range.upper", kBound},
                                    {"RevoluteJoint.target_angle", kAny},
                                    {"DistanceJoint.length", kPositive},
                                    {"PrismaticJoint.target_translation", kAny},
                                    {"MotorJoint.target_position", kAny},
                                    {"MotorJoint.target_angle", kAny},
                                    {"MouseJoint.target", kAny},
                                    {"GearJoint.ratio", kNotZero},
                                    {"GearJoint.phase", kAny},
                                    {"PulleyJoint.ground_a", kAny},
                                    {"PulleyJoint.ground_b", kAny},
                                    {"PulleyJoint.ratio", kPositive},
                                    {"PulleyJoint.length", kPositive},
                                    {"RatchetJoint.tooth", kNotZero},
                                    {"RatchetJoint.phase", kAny}};
  for (const char* kind : {"Revolute", "Distance", "Prismatic", "Weld", "Wheel", "Motor", "Mouse", "Gear",
                           "Pulley", "Ratchet", "Friction"}) {
    const std::string joint = std::string(kind) + "Joint.";
    rules[joint + "break_force"] = rules[joint + "break_torque"] = kNotNegative;
  }
  for (const char* kind : {"Revolute", "Distance", "Prismatic", "Weld", "Wheel", "Pulley", "Friction"})
    rules[std::string(kind) + "Joint.anchor_a"] = rules[std::string(kind) + "Joint.anchor_b"] = kAny;
  rules["MouseJoint.anchor_b"] = kAny;
  for (const char* kind : {"Revolute", "Prismatic", "Weld"})
    rules[std::string(kind) + "Joint.reference_angle"] = kAny;
  for (const char* kind : {"Prismatic", "Wheel"}) rules[std::string(kind) + "Joint.axis"] = kAny;
  for (const char* field : {"MotorJoint.max_force", "MotorJoint.max_torque", "MouseJoint.max_force",
                            "FrictionJoint.max_force", "FrictionJoint.max_torque"})
    rules[field] = kNotNegative;
  return rules;
}

/// One of everything, with nothing absent.
Scene full_scene() {
  const std::vector<Geometry> geometries{Circle{0.5},
                                         Box{1, 2},
                                         Capsule{{0, 0}, {1, 0}, 0.25},
                                         Polygon{{{0, 0}, {1, 0}, {0, 1}}, 0.125},
                                         Segment{{0, 0}, {1, 1}},
                                         Chain{{{5, 0}, {6, 1}, {7, 0}}}};
  Body rock{
      .name = "rock", .type = BodyType::Kinematic, .position = {20, 0}, .velocity = {1, 0}, .inertia = 1.0};
  for (const Geometry& geometry : geometries) rock.shapes.push_back({.geometry = geometry, .density = 1.0});
  Body ball{.name = "ball", .position = {0, 2}, .mass = 2.0, .inertia = 0.5};
  Body other{.name = "other", .position = {3, 2}, .mass = 1.0, .inertia = 0.25};
  for (Body* body : {&ball, &other})
    body->shapes.push_back({.geometry = Box{0.5, 1}, .density = body->mass / 0.5});
  Scene scene{.name = "everything", .bodies = {rock, ball, other}};
  const Range range{0.25, 5};
  const Motor motor{1, 2};
  const Spring spring{3, 0.5};
  const std::string a = "ball", b = "other";
  scene.joints = {
      RevoluteJoint{.name = "1", .body_a = a, .body_b = b, .limits = range, .motor = motor, .spring = spring},
      DistanceJoint{.name = "2",
                    .body_a = a,
                    .body_b = b,
                    .length = 3,
                    .spring = spring,
                    .range = range,
                    .motor = motor},
      PrismaticJoint{
          .name = "3", .body_a = a, .body_b = b, .limits = range, .motor = motor, .spring = spring},
      WeldJoint{.name = "4", .body_a = a, .body_b = b, .linear_spring = spring, .angular_spring = spring},
      WheelJoint{.name = "5", .body_a = a, .body_b = b, .spring = spring, .limits = range, .motor = motor},
      MotorJoint{.name = "6", .body_a = a, .body_b = b},
      MouseJoint{.name = "7", .body_a = "world", .body_b = b},
      GearJoint{.name = "8", .body_a = a, .body_b = b},
      PulleyJoint{
          .name = "9", .body_a = a, .body_b = b, .ground_a = {0, 5}, .ground_b = {3, 5}, .length = 6.0},
      RatchetJoint{.name = "10", .body_a = a, .body_b = b},
      FrictionJoint{.name = "11", .body_a = a, .body_b = b}};
  scene.forces = {LinearDrag{a, 0.5, 0.1},
                  QuadraticDrag{a, 0.25},
                  PointForce{.body = a, .force = {1, 2}, .duration = 1},
                  Torque{.body = a, .torque = 1, .duration = 1},
                  SpringForce{.body_a = a, .body_b = b, .rest_length = 1, .stiffness = 2, .damping = 0.5},
                  AttractionForce{.body = a, .centre_body = b, .strength = 1},
                  SinusoidalForce{.body = a, .amplitude = {1, 1}, .angular_frequency = 2},
                  FormulaForce{.body = a, .x = "sin(t)"},
                  FormulaSpring{.body_a = a, .body_b = b, .tension = "length"}};
  scene.drives = {{"1", "sin(t)"}};
  return scene;
}

/// The thing of the scene that a path leads to, as errors name it.
std::string subject_of(const std::string& path) {
  const auto index = [&] { return std::stoi(path.substr(path.find('[') + 1)); };
  static const char* const kBodies[] = {"rock", "ball", "other"};
  if (path.starts_with("bodies")) return "body '" + std::string(kBodies[index()]) + "'";
  if (path.starts_with("joints")) return "joint '" + std::to_string(index() + 1) + "'";
  if (path.starts_with("forces")) return "force " + std::to_string(index());
  return "scene 'everything'";
}

struct Spoilt {
  Scene scene;
  FieldPlace at;
  std::string text;  ///< of the value; empty where the field cannot hold it
};

Spoilt spoil(const Scene& good, const FieldPlace& at, double bad) {
  Spoilt out{good, at, ""};
  visit_fields(out.scene, {}, [&]<class T>(const FieldPlace& here, T& value) {
    if (here.path != at.path || !can_hold<T>(bad)) return;
    value = static_cast<T>(bad);
    out.text = text_of<T>(bad);
  });
  return out;
}

void expect_names_place(const Error& error, const Spoilt& spoilt) {
  EXPECT_EQ(error.kind(), Error::Kind::Value) << error.what();
  EXPECT_EQ(error.subject().substr(0, subject_of(spoilt.at.path).size()), subject_of(spoilt.at.path));
  EXPECT_EQ(last_name(error.field()), last_name(spoilt.at.path)) << error.what();
  EXPECT_NE(error.value().find(spoilt.text), std::string::npos) << spoilt.text << " in " << error.what();
}

/// The scene as text; empty where JSON has no such number.
std::string text_of(const Scene& scene) {
  try {
    return to_json(scene);
  } catch (const Error&) {
    return "";
  }
}

void expect_finite(std::span<const BodyState> states) {
  for (const BodyState& state : states) {
    for (const double value : {state.position.x, state.position.y, state.angle, state.velocity.x,
                               state.velocity.y, state.angular_velocity})
      ASSERT_TRUE(std::isfinite(value));
  }
}

/// Runs of what was accepted end with finite states or say that they could not.
void expect_finite_runs(const Scene& scene) {
  std::vector<BodyState> states(scene.bodies.size());
  for (const Precision precision : {Precision::Double, Precision::Float}) {
    try {
      Simulation simulation = compile(scene, Realtime{.precision = precision});
      for (int i = 0; i < 3; ++i) {
        simulation.step();
        simulation.read(states);
        expect_finite(states);
      }
    } catch (const Error&) {
    }
  }
  try {
    World world(world_definition(scene));
    const SceneParts parts = add_scene(world, scene);
    SceneForces<float> forces(scene, parts);
    for (int i = 0; i < 3; ++i) {
      forces.apply(world, 1.0 / 60);
      world.step();
      EXPECT_TRUE(is_finite(world));
    }
  } catch (const Error&) {
  }
}

TEST(SceneFields, BadNumbersAreRefusedWithTheirPlace) {
  const Scene good = full_scene();
  ASSERT_NO_THROW(validate(good));
  std::vector<FieldPlace> places;
  Scene sample = good;
  visit_fields(sample, {}, [&](const FieldPlace& at, auto&) { places.push_back(at); });
  Rules rules(scene_rules());
  int refused = 0, read = 0, accepted = 0;
  for (const FieldPlace& at : places) {
    Rule rule = rules.of(at.key);
    // Only dynamic bodies have a mass, whatever is written there.
    if (at.path == "bodies[0].mass") rule = kNotNegative;
    for (const double bad : bad_numbers()) {
      const Spoilt spoilt = spoil(good, at, bad);
      if (spoilt.text.empty()) continue;
      SCOPED_TRACE(at.path + " = " + spoilt.text);
      try {
        validate(spoilt.scene);
        EXPECT_TRUE(rule.accepts(bad)) << "was accepted";
        ++accepted;
        expect_finite_runs(spoilt.scene);
      } catch (const Error& error) {
        if (!rule.accepts(bad)) expect_names_place(error, spoilt), ++refused;
      }
      const std::string json = text_of(spoilt.scene);
      if (!json.empty() && !rule.accepts(bad)) {
        try {
          scene_from_json(json);
          ADD_FAILURE() << "was read";
        } catch (const Error& error) {
          expect_names_place(error, spoilt);
          EXPECT_GT(error.line(), 1);
          ++read;
        }
      }
    }
  }
  rules.expect_all_used();
  EXPECT_GT(refused, 2000);
  EXPECT_GT(read, 1000);
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace plumb::bad_input
