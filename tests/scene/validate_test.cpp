#include "engine/scene/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/scene/json.h"
#include "tests/scene/sample.h"

namespace plumb {
namespace {

using Kind = Error::Kind;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One thing made wrong in `full_scene()`, and what must be said about it.
struct Wrong {
  const char* name;
  std::function<void(Scene&)> spoil;
  Kind kind;
  std::string subject, field, value, problem;  ///< `problem` is a part of the text
};

void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

Body& ball(Scene& scene) { return scene.bodies[0]; }
Body& floor_of(Scene& scene) { return scene.bodies[1]; }
Circle& disc(Scene& scene) { return std::get<Circle>(ball(scene).shapes[0].geometry); }
Box& plank(Scene& scene) { return std::get<Box>(ball(scene).shapes[1].geometry); }
RevoluteJoint& hinge(Scene& scene) { return std::get<RevoluteJoint>(scene.joints[0]); }
DistanceJoint& rod(Scene& scene) { return std::get<DistanceJoint>(scene.joints[1]); }
PointForce& push(Scene& scene) { return std::get<PointForce>(scene.forces[2]); }

class Validate : public testing::TestWithParam<Wrong> {};

TEST_P(Validate, NamesWhatIsWrong) {
  Scene scene = test::full_scene();
  EXPECT_NO_THROW(validate(scene));
  GetParam().spoil(scene);
  const Error error = test::error_of([&] { validate(scene); });
  EXPECT_EQ(error.kind(), GetParam().kind);
  EXPECT_EQ(error.subject(), GetParam().subject);
  EXPECT_EQ(error.field(), GetParam().field);
  EXPECT_EQ(error.value(), GetParam().value);
  EXPECT_NE(error.problem().find(GetParam().problem), std::string::npos) << error.what();
  EXPECT_EQ(error.line(), 0);
}

std::string case_name(const testing::TestParamInfo<Wrong>& info) { return info.param.name; }

const Wrong kSceneCases[] = {
    {"SceneName", [](Scene& s) { s.name = "a\nb"; }, Kind::Name, "scene 'a\\x0ab'", "name", "a\\x0ab",
     "control characters"},
    {"Gravity", [](Scene& s) { s.gravity.y = kNan; }, Kind::Value, "scene 'everything'", "gravity",
     "[0.1, nan]", "two finite numbers of m/s^2"},
    {"GravityHuge", [](Scene& s) { s.gravity.x = -2e100; }, Kind::Value, "scene 'everything'", "gravity",
     "[-2e+100, -1.62]", "overflow"},
    {"Threshold", [](Scene& s) { s.contact_rules.restitution_threshold = -0.5; }, Kind::Value,
     "scene 'everything'", "contact_rules.restitution_threshold", "-0.5", "zero or a positive number of m/s"},
    {"Rule", [](Scene& s) { s.contact_rules.friction = static_cast<Combine>(9); }, Kind::Value,
     "scene 'everything'", "contact_rules.friction", "9", "enumeration"},
};
INSTANTIATE_TEST_SUITE_P(Scene, Validate, testing::ValuesIn(kSceneCases), case_name);

const Wrong kBodyCases[] = {
    {"NameEmpty", [](Scene& s) { ball(s).name = ""; }, Kind::Name, "body 0", "name", "", "must not be empty"},
    {"NameWorld", [](Scene& s) { ball(s).name = "world"; }, Kind::Name, "body 'world'", "name", "world",
     "fixed frame"},
    {"NameControl", [](Scene& s) { ball(s).name = "a\x7F"; }, Kind::Name, "body 'a\\x7f'", "name", "a\\x7f",
     "control characters"},
    {"NameNotUtf8", [](Scene& s) { ball(s).name = "\xFF"; }, Kind::Name, "body '\\xff'", "name", "\\xff",
     "UTF-8"},
    {"NameTwice", [](Scene& s) { s.bodies[2].name = "ball"; }, Kind::Name, "body 'ball'", "name", "ball",
     "unique: body 0"},
    {"Type", [](Scene& s) { ball(s).type = static_cast<BodyType>(3); }, Kind::Value, "body 'ball'", "type",
     "3", "enumeration"},
    {"Position", [](Scene& s) { ball(s).position.x = kInfinity; }, Kind::Value, "body 'ball'", "position",
     "[inf, 2]", "finite"},
    {"PositionHuge", [](Scene& s) { ball(s).position.x = 1e150; }, Kind::Value, "body 'ball'", "position",
     "[1e+150, 2]", "overflow"},
    {"Angle", [](Scene& s) { ball(s).angle = kNan; }, Kind::Value, "body 'ball'", "angle", "nan",
     "finite number of rad"},
    {"Velocity", [](Scene& s) { ball(s).velocity.y = -kInfinity; }, Kind::Value, "body 'ball'", "velocity",
     "[3, -inf]", "finite"},
    {"Spin", [](Scene& s) { ball(s).angular_velocity = kInfinity; }, Kind::Value, "body 'ball'",
     "angular_velocity", "inf", "finite"},
    {"SpinHuge", [](Scene& s) { ball(s).angular_velocity = -1.1e100; }, Kind::Value, "body 'ball'",
     "angular_velocity", "-1.1e+100", "overflow"},
    {"MassZero", [](Scene& s) { ball(s).mass = 0; }, Kind::Value, "body 'ball'", "mass", "0",
     "must be a positive number of kg"},
    {"MassNegative", [](Scene& s) { ball(s).mass = -1; }, Kind::Value, "body 'ball'", "mass", "-1",
     "must be a positive number of kg"},
    {"MassNan", [](Scene& s) { ball(s).mass = kNan; }, Kind::Value, "body 'ball'", "mass", "nan", "positive"},
    {"MassInfinite", [](Scene& s) { ball(s).mass = kInfinity; }, Kind::Value, "body 'ball'", "mass", "inf",
     "positive"},
    {"MassDenormal", [](Scene& s) { ball(s).mass = 5e-324; }, Kind::Value, "body 'ball'", "mass", "5e-324",
     "reciprocal would overflow"},
    {"MassHuge", [](Scene& s) { ball(s).mass = 1e101; }, Kind::Value, "body 'ball'", "mass", "1e+101",
     "overflow"},
    {"MassOfStatic", [](Scene& s) { floor_of(s).mass = kNan; }, Kind::Value, "body 'floor'", "mass", "nan",
     "zero or"},
    {"Inertia", [](Scene& s) { ball(s).inertia = 0; }, Kind::Value, "body 'ball'", "inertia", "0",
     "positive number of kg m^2"},
    {"InertiaDenormal", [](Scene& s) { ball(s).inertia = 1e-310; }, Kind::Value, "body 'ball'", "inertia",
     "1e-310", "reciprocal"},
    {"InertiaAbsent", [](Scene& s) { ball(s).inertia.reset(), ball(s).shapes.clear(); }, Kind::Value,
     "body 'ball'", "inertia", "absent", "dynamic body without shapes"},
    {"StaticMoves",
     [](Scene& s) {
       floor_of(s).velocity = {0, 1};
     },
     Kind::Value, "body 'floor'", "velocity", "[0, 1]", "zero for a static body"},
    {"StaticTurns", [](Scene& s) { floor_of(s).angular_velocity = 1; }, Kind::Value, "body 'floor'",
     "angular_velocity", "1", "zero for a static body"},
    {"FixedTurns", [](Scene& s) { ball(s).fixed_rotation = true; }, Kind::Value, "body 'ball'",
     "angular_velocity", "5", "fixed_rotation"},
};
INSTANTIATE_TEST_SUITE_P(Body, Validate, testing::ValuesIn(kBodyCases), case_name);

const Wrong kShapeCases[] = {
    {"RadiusZero", [](Scene& s) { disc(s).radius = 0; }, Kind::Value, "body 'ball'", "shapes[0].radius", "0",
     "positive number of m"},
    {"RadiusNan", [](Scene& s) { disc(s).radius = kNan; }, Kind::Value, "body 'ball'", "shapes[0].radius",
     "nan", "positive"},
    {"RadiusTiny", [](Scene& s) { disc(s).radius = 1e-101; }, Kind::Value, "body 'ball'", "shapes[0].radius",
     "1e-101", "at least 1e-100"},
    {"Width", [](Scene& s) { plank(s).width = -2; }, Kind::Value, "body 'ball'", "shapes[1].width", "-2",
     "positive number of m"},
    {"Height", [](Scene& s) { plank(s).height = kInfinity; }, Kind::Value, "body 'ball'", "shapes[1].height",
     "inf", "positive"},
    {"Position",
     [](Scene& s) {
       ball(s).shapes[1].position = {kNan, 0};
     },
     Kind::Value, "body 'ball'", "shapes[1].position", "[nan, 0]", "finite"},
    {"Angle", [](Scene& s) { ball(s).shapes[0].angle = kInfinity; }, Kind::Value, "body 'ball'",
     "shapes[0].angle", "inf", "finite"},
    {"Friction", [](Scene& s) { ball(s).shapes[0].friction = -0.1; }, Kind::Value, "body 'ball'",
     "shapes[0].friction", "-0.1", "zero or a positive number"},
    {"RestitutionHigh", [](Scene& s) { ball(s).shapes[0].restitution = 1.5; }, Kind::Value, "body 'ball'",
     "shapes[0].restitution", "1.5", "from 0 to 1"},
    {"RestitutionLow", [](Scene& s) { ball(s).shapes[1].restitution = -0.5; }, Kind::Value, "body 'ball'",
     "shapes[1].restitution", "-0.5", "from 0 to 1"},
};
INSTANTIATE_TEST_SUITE_P(Shape, Validate, testing::ValuesIn(kShapeCases), case_name);

const Wrong kJointCases[] = {
    {"NameEmpty", [](Scene& s) { hinge(s).name = ""; }, Kind::Name, "joint 0", "name", "",
     "must not be empty"},
    {"NameTwice", [](Scene& s) { rod(s).name = "hinge"; }, Kind::Name, "joint 'hinge'", "name", "hinge",
     "unique: joint 0"},
    {"UnknownBody", [](Scene& s) { hinge(s).body_b = "bal"; }, Kind::Name, "joint 'hinge'", "body_b", "bal",
     "or 'world'; did you mean 'ball'?"},
    {"UnknownWorld", [](Scene& s) { hinge(s).body_a = "World"; }, Kind::Name, "joint 'hinge'", "body_a",
     "World", "did you mean 'world'?"},
    {"ToItself", [](Scene& s) { rod(s).body_b = "ball"; }, Kind::Name, "joint 'rod'", "body_b", "ball",
     "must differ from body_a"},
    {"WorldToItself", [](Scene& s) { hinge(s).body_b = "world"; }, Kind::Name, "joint 'hinge'", "body_b",
     "world", "must differ from body_a"},
    {"NothingMoves", [](Scene& s) { rod(s).body_a = "belt"; }, Kind::Name, "joint 'rod'", "body_b", "floor",
     "must be dynamic when 'belt' is not"},
    {"NothingMovesInTheWorld", [](Scene& s) { hinge(s).body_b = "floor"; }, Kind::Name, "joint 'hinge'",
     "body_b", "floor", "must be dynamic when 'world' is not"},
    {"AnchorA", [](Scene& s) { hinge(s).anchor_a.x = kNan; }, Kind::Value, "joint 'hinge'", "anchor_a",
     "[nan, 1]", "finite"},
    {"AnchorB", [](Scene& s) { rod(s).anchor_b.y = 1e200; }, Kind::Value, "joint 'rod'", "anchor_b",
     "[4, 1e+200]", "overflow"},
    {"Length", [](Scene& s) { rod(s).length = 0; }, Kind::Value, "joint 'rod'", "length", "0",
     "positive number of m"},
    {"LengthNan", [](Scene& s) { rod(s).length = kNan; }, Kind::Value, "joint 'rod'", "length", "nan",
     "positive"},
};
INSTANTIATE_TEST_SUITE_P(Joint, Validate, testing::ValuesIn(kJointCases), case_name);

const Wrong kForceCases[] = {
    {"LinearDrag", [](Scene& s) { std::get<LinearDrag>(s.forces[0]).coefficient = -1; }, Kind::Value,
     "force 0 (linear_drag on 'ball')", "coefficient", "-1", "number of N s/m"},
    {"QuadraticDrag", [](Scene& s) { std::get<QuadraticDrag>(s.forces[1]).coefficient = kNan; }, Kind::Value,
     "force 1 (quadratic_drag on 'ball')", "coefficient", "nan", "number of N s^2/m^2"},
    {"UnknownBody", [](Scene& s) { push(s).body = "blal"; }, Kind::Name, "force 2 (point_force on 'blal')",
     "body", "blal", "did you mean 'ball'?"},
    {"World", [](Scene& s) { push(s).body = "world"; }, Kind::Name, "force 2 (point_force on 'world')",
     "body", "world", "must be the name of a body"},
    {"Force", [](Scene& s) { push(s).force.x = kInfinity; }, Kind::Value, "force 2 (point_force on 'ball')",
     "force", "[inf, 2]", "finite numbers of N"},
    {"Point", [](Scene& s) { push(s).point.y = kNan; }, Kind::Value, "force 2 (point_force on 'ball')",
     "point", "[3, nan]", "finite"},
    {"Frame", [](Scene& s) { push(s).frame = static_cast<Frame>(-1); }, Kind::Value,
     "force 2 (point_force on 'ball')", "frame", "-1", "enumeration"},
    {"Start", [](Scene& s) { push(s).start = -1; }, Kind::Value, "force 2 (point_force on 'ball')", "start",
     "-1", "zero or a positive number of s"},
    {"StartInfinite", [](Scene& s) { push(s).start = kInfinity; }, Kind::Value,
     "force 2 (point_force on 'ball')", "start", "inf", "number of s"},
    {"Duration", [](Scene& s) { push(s).duration = -1; }, Kind::Value, "force 2 (point_force on 'ball')",
     "duration", "-1", "zero or a positive number of s"},
    {"DurationNan", [](Scene& s) { push(s).duration = kNan; }, Kind::Value, "force 2 (point_force on 'ball')",
     "duration", "nan", "number of s"},
    {"Torque", [](Scene& s) { std::get<Torque>(s.forces[3]).torque = kNan; }, Kind::Value,
     "force 3 (torque on 'ball')", "torque", "nan", "finite number of N m"},
    {"TorqueDuration", [](Scene& s) { std::get<Torque>(s.forces[3]).duration = -kInfinity; }, Kind::Value,
     "force 3 (torque on 'ball')", "duration", "-inf", "number of s"},
};
INSTANTIATE_TEST_SUITE_P(Force, Validate, testing::ValuesIn(kForceCases), case_name);

TEST(ValidScene, MayBeEmptyOrNameless) {
  EXPECT_NO_THROW(validate(Scene{}));
  Scene scene = test::full_scene();
  scene.name = "";
  EXPECT_NO_THROW(validate(scene));
}

TEST(ValidScene, MayHaveAnyUtf8InNames) {
  Scene scene = test::full_scene();
  scene.name = scene.bodies[2].name = "Körper 球 \xF0\x9F\x8F\x80 \"'\\/";
  EXPECT_NO_THROW(validate(scene));
}

TEST(ValidScene, JointsAndBodiesMayShareNames) {
  Scene scene = test::full_scene();
  hinge(scene).name = scene.drives.front().joint = "ball";
  EXPECT_NO_THROW(validate(scene));
}

TEST(ValidScene, TakesTheLimitsThemselves) {
  Scene scene = test::full_scene();
  scene.gravity = {1e100, -1e100};
  ball(scene).mass = 1e-100;
  disc(scene).radius = 1e-100;
  plank(scene).width = 1e100;
  ball(scene).shapes[0].restitution = 1;
  ball(scene).shapes[1].restitution = 0;
  push(scene).duration = kInfinity;
  floor_of(scene).velocity = {-0.0, 0};
  EXPECT_NO_THROW(validate(scene));
}

/// Checks what the limits promise: no inertia that follows from them, nor its reciprocal, overflows or
/// vanishes.
TEST(ValidScene, LimitsKeepInertiaFinite) {
  for (const double size : {1e-100, 1e100}) {
    for (const double mass : {1e-100, 1e100}) {
      const Body body{.name = "b",
                      .mass = mass,
                      .shapes = {Shape{.geometry = Circle{size}}, Shape{.geometry = Box{size, size}}}};
      EXPECT_TRUE(std::isnormal(inertia_of(body))) << size << " " << mass;
      EXPECT_TRUE(std::isnormal(1 / inertia_of(body))) << size << " " << mass;
    }
  }
}

TEST(ValidScene, WorksOutLargeScenesInLinearTime) {
  Scene scene;
  for (int i = 0; i < 100000; ++i) {
    scene.bodies.push_back({.name = "b" + std::to_string(i), .inertia = 1});
    scene.joints.push_back(RevoluteJoint{"j" + std::to_string(i), "world", scene.bodies.back().name, {}, {}});
  }
  EXPECT_NO_THROW(validate(scene));
}

}  // namespace
}  // namespace plumb
