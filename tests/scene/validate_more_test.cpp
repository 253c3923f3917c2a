#include <gtest/gtest.h>

#include "engine/scene/features.h"
#include "engine/scene/validate.h"
#include "tests/scene/sample.h"

/// Checks what shapes, bodies and joints may have beyond circles, boxes, hinges and rods.
namespace plumb {
namespace {

struct Wrong {
  const char* name;
  std::function<void(Scene&)> spoil;
  std::string subject, field, value, problem;
};

void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

class ValidateMore : public testing::TestWithParam<Wrong> {};

TEST_P(ValidateMore, NamesWhatIsWrong) {
  Scene scene = test::full_scene();
  GetParam().spoil(scene);
  const Error error = test::error_of([&] { validate(scene); });
  EXPECT_EQ(error.kind(), Error::Kind::Value);
  EXPECT_EQ(error.subject(), GetParam().subject);
  EXPECT_EQ(error.field(), GetParam().field);
  EXPECT_EQ(error.value(), GetParam().value);
  EXPECT_NE(error.problem().find(GetParam().problem), std::string::npos) << error.what();
}

template <class T>
T& shape(Scene& scene, std::size_t index) {
  return std::get<T>(scene.bodies[3].shapes[index].geometry);
}
template <class J>
J& joint(Scene& scene, std::size_t index) {
  return std::get<J>(scene.joints[index]);
}

const Wrong kCases[] = {
    {"CapsuleRadius", [](Scene& s) { shape<Capsule>(s, 0).radius = 0; }, "body 'rock'", "shapes[0].radius",
     "0", "positive number of m"},
    {"PolygonLine",
     [](Scene& s) {
       shape<Polygon>(s, 1).points = {{0, 0}, {1, 1}, {2, 2}};
     },
     "body 'rock'", "shapes[1].points", "3 points", "line"},
    {"PolygonPoint", [](Scene& s) { shape<Polygon>(s, 1).points[2].y = 1e101; }, "body 'rock'",
     "shapes[1].points[2]", "[-4, 1e+101]", "overflow"},
    {"PolygonTwoPoints", [](Scene& s) { shape<Polygon>(s, 1).points.pop_back(); }, "body 'rock'",
     "shapes[1].points", "2 points", "3 or more"},
    {"SegmentPoint",
     [](Scene& s) {
       shape<Segment>(s, 2).end = {1, 2};
     },
     "body 'rock'", "shapes[2].end", "[1, 2]", "length"},
    {"ChainTwice",
     [](Scene& s) {
       shape<Chain>(s, 3).points[1] = {0, 1};
     },
     "body 'rock'", "shapes[3].points[1]", "[0, 1]", "differ"},
    {"ClosedChainOfTwo", [](Scene& s) { shape<Chain>(s, 3).points.pop_back(); }, "body 'rock'",
     "shapes[3].points", "2 points", "when closed"},
    {"Rolling", [](Scene& s) { s.bodies[0].shapes[0].rolling_resistance = -1; }, "body 'ball'",
     "shapes[0].rolling_resistance", "-1", "zero or a positive"},
    {"Density", [](Scene& s) { s.bodies[3].shapes[0].density = -1; }, "body 'rock'", "shapes[0].density",
     "-1", "zero or a positive number of kg/m^2"},
    {"OneDensity", [](Scene& s) { s.bodies[0].shapes[0].density = 1; }, "body 'ball'", "shapes[1].density",
     "absent", "another shape"},
    {"MassByDensity", [](Scene& s) { s.bodies[0].shapes[0].density = s.bodies[0].shapes[1].density = 2; },
     "body 'ball'", "mass", "6", "densities give"},
    {"WeighsNothing",
     [](Scene& s) {
       s.bodies[0].shapes = {{.geometry = Segment{{0, 0}, {1, 0}}}};
       s.bodies[0].inertia.reset();
     },
     "body 'ball'", "inertia", "absent", "weigh nothing"},
    {"Damping", [](Scene& s) { s.bodies[0].linear_damping = -2; }, "body 'ball'", "linear_damping", "-2",
     "1/s"},
    {"LimitsTurned", [](Scene& s) { joint<RevoluteJoint>(s, 0).limits->upper = 0; }, "joint 'hinge'",
     "limits.upper", "0", "lower bound, 0.25"},
    {"MotorForce", [](Scene& s) { joint<RevoluteJoint>(s, 0).motor->max_force = -1; }, "joint 'hinge'",
     "motor.max_force", "-1", "zero or a positive"},
    {"RopeLength", [](Scene& s) { joint<DistanceJoint>(s, 1).range->lower = -1; }, "joint 'rod'",
     "range.lower", "-1", "zero or a positive number of m"},
    {"Axis", [](Scene& s) { joint<PrismaticJoint>(s, 2).axis = {}; }, "joint 'slide'", "axis", "[0, 0]",
     "direction"},
    {"Hertz", [](Scene& s) { joint<WeldJoint>(s, 3).linear_spring->hertz = 0; }, "joint 'weld'",
     "linear_spring.hertz", "0", "positive"},
    {"GearRatio", [](Scene& s) { joint<GearJoint>(s, 7).ratio = 0; }, "joint 'gear'", "ratio", "0",
     "other than 0"},
    {"PulleyRatio", [](Scene& s) { joint<PulleyJoint>(s, 8).ratio = -1; }, "joint 'rope'", "ratio", "-1",
     "positive"},
    {"Tooth", [](Scene& s) { joint<RatchetJoint>(s, 9).tooth = 1e-101; }, "joint 'click'", "tooth", "1e-101",
     "at least 1e-100 in magnitude"},
    {"Break", [](Scene& s) { joint<FrictionJoint>(s, 10).break_force = -1; }, "joint 'drag'", "break_force",
     "-1", "zero or a positive number of N"},
};
std::string case_name(const testing::TestParamInfo<Wrong>& one) { return one.param.name; }
INSTANTIATE_TEST_SUITE_P(All, ValidateMore, testing::ValuesIn(kCases), case_name);

TEST(Features, NamesTheFirstThatIsUnusual) {
  Scene scene;
  scene.bodies = {{.name = "a", .shapes = {{.geometry = Circle{1}}}}, {.name = "b", .inertia = 1}};
  scene.joints = {
      RevoluteJoint{.name = "r", .body_a = "a", .body_b = "b", .anchor_a = {1, 2}, .collide = true},
      DistanceJoint{.name = "d", .body_a = "a", .body_b = "b", .length = 3}};
  EXPECT_EQ(unusual_feature(scene), "");
  std::get<DistanceJoint>(scene.joints[1]).range = Range{1, 2};
  EXPECT_EQ(unusual_field(scene), "joint 'd' has range");
  std::get<RevoluteJoint>(scene.joints[0]).break_force = 1;
  EXPECT_EQ(unusual_field(scene), "joint 'r' has break_force");
  scene.bodies[1].lock_y = true;
  EXPECT_EQ(unusual_field(scene), "body 'b' has lock_y");
  EXPECT_EQ(unusual_kind(scene), "");
  GearJoint gear;
  gear.name = "g";
  scene.joints.push_back(gear);
  EXPECT_EQ(unusual_feature(scene), "joint 'g' is a gear joint");
  scene.bodies[0].shapes.push_back({.geometry = Segment{}});
  EXPECT_EQ(unusual_feature(scene), "body 'a' has a segment");
}

}  // namespace
}  // namespace plumb
