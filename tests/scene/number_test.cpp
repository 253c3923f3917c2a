#include "engine/scene/number.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/error.h"

namespace plumb {
namespace {

// Names may have dots, so that one may begin like another, in any order of the bodies.
TEST(NumbersOfAScene, TheLongestNameThatFitsIsMeant) {
  for (const bool longer_first : {false, true}) {
    Scene scene;
    scene.bodies = {{.name = "a", .mass = 1}, {.name = "a.b", .mass = 2}};
    if (longer_first) std::swap(scene.bodies[0], scene.bodies[1]);
    const std::size_t longer = longer_first ? 0 : 1;
    EXPECT_EQ(numbers_at(scene, "bodies.a.b.mass"), std::vector{&scene.bodies[longer].mass});
    EXPECT_EQ(numbers_at(scene, "bodies.a.mass"), std::vector{&scene.bodies[1 - longer].mass});
    EXPECT_EQ(body_of_initial_state(scene, "bodies.a.b.angle"), longer);
    EXPECT_EQ(body_of_initial_state(scene, "bodies.a.angle"), 1 - longer);
    EXPECT_THROW(numbers_at(scene, "bodies.a.c.mass"), Error);
  }
}

TEST(NumbersOfAScene, AreComparedByTheirUnits) {
  Scene scene;
  scene.bodies = {{.name = "a"}};
  PrismaticJoint slider;
  slider.name = "slider", slider.limits = Range{.lower = 0};
  RatchetJoint ratchet;
  ratchet.name = "ratchet";
  scene.joints = {slider, ratchet};
  scene.forces = {PointForce{.body = "a", .duration = 1}};
  const std::map<std::string, NumberKind> kinds{
      {"bodies.a.position.x", NumberKind::Length},    {"bodies.a.angle", NumberKind::Angle},
      {"bodies.a.velocity.x", NumberKind::Relative},  {"joints.slider.limits.lower", NumberKind::Length},
      {"joints.slider.axis.x", NumberKind::Relative}, {"joints.ratchet.phase", NumberKind::Angle},
      {"joints.ratchet.tooth", NumberKind::Relative}, {"forces[0].point.x", NumberKind::Length},
      {"forces[0].force.x", NumberKind::Relative}};
  for (const auto& [path, kind] : kinds) {
    EXPECT_EQ(numbers_at(scene, path).size(), 1u) << path;
    EXPECT_EQ(kind_of_number(scene, path), kind) << path;
  }
  for (const char* none : {"joints.slider.limits.upper", "forces[0].start", "forces[0].duration",
                           "forces[0].frame", "bodies.a.name", "bodies.a.inertia"})
    EXPECT_THROW(numbers_at(scene, none), Error) << none;
}

TEST(NumbersOfAScene, JointsAreFoundByTheirLongestName) {
  Scene scene;
  DistanceJoint rod, end;
  rod.name = "rod", rod.length = 1;
  end.name = "rod.end", end.length = 2;
  scene.joints = {rod, end};
  EXPECT_EQ(*numbers_at(scene, "joints.rod.end.length")[0], 2);
  EXPECT_EQ(*numbers_at(scene, "joints.rod.length")[0], 1);
}

}  // namespace
}  // namespace plumb
