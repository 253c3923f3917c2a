// Scenes as trees of hinges: which links there are, and which scenes are refused with which reason.
#include "reference/support/mechanism.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace plumb::reference {
namespace {

using ::testing::HasSubstr;

Body body_at(const std::string& name, Vec2d position) { return {.name = name, .position = position}; }

RevoluteJoint hinge(const std::string& name, const std::string& a, const std::string& b, Vec2d anchor_a,
                    Vec2d anchor_b) {
  return {.name = name, .body_a = a, .body_b = b, .anchor_a = anchor_a, .anchor_b = anchor_b};
}

/// Rods of 2 m along x: w - a - b, and c that hangs from a's end too; free is apart. Bodies and joints are
/// out of order on purpose.
Scene tree() {
  Scene scene{.name = "tree"};
  scene.bodies = {body_at("c", {3, 0}), body_at("b", {3, 0}), body_at("free", {9, 9}), body_at("a", {1, 0})};
  scene.joints = {hinge("ab", "b", "a", {-1, 0}, {1, 0}), hinge("ac", "a", "c", {1, 0}, {-1, 0}),
                  hinge("wa", "a", "world", {-1, 0}, {0, 0})};
  return scene;
}

TEST(Mechanism, ParentsComeBeforeTheirChildren) {
  const Scene scene = tree();
  ASSERT_EQ(not_a_mechanism(scene), "");
  const auto links = links_of(scene);
  ASSERT_EQ(links.size(), 4u);
  EXPECT_EQ(scene.bodies[links[0].body].name, "a");
  EXPECT_EQ(links[0].parent, -1);
  EXPECT_TRUE(links[0].hinged);
  EXPECT_EQ(links[0].anchor, (Vec2d{-1, 0}));
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(links[i].parent, 0);
    EXPECT_EQ(links[i].parent_anchor, (Vec2d{1, 0}));
    EXPECT_EQ(links[i].anchor, (Vec2d{-1, 0}));
  }
  EXPECT_EQ(scene.bodies[links[3].body].name, "free");
  EXPECT_FALSE(links[3].hinged);
}

TEST(Mechanism, AnglesAndSpeedsAreRelativeToTheParent) {
  Scene scene = tree();
  // b stands up from a's end, turning at 5 rad/s while a turns at 2 rad/s about the origin.
  scene.bodies[1] = {.name = "b", .position = {2, 1}, .angle = std::numbers::pi / 2, .angular_velocity = 5};
  scene.bodies[3].angular_velocity = 2;
  scene.bodies[3].velocity = {0, 2};
  scene.bodies[1].velocity = Vec2d{0, 4} + Vec2d{-5, 0};
  scene.bodies[0].velocity = {0, 4};
  ASSERT_EQ(not_a_mechanism(scene), "");
  const auto links = links_of(scene);
  EXPECT_EQ(scene.bodies[links[1].body].name, "b");
  EXPECT_DOUBLE_EQ(links[1].angle, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(links[1].angle_speed, 3);
}

TEST(Mechanism, AStaticBodysAnchorIsAPlaceInTheWorld) {
  Scene scene = tree();
  scene.bodies.push_back(
      {.name = "post", .type = BodyType::Static, .position = {0, 2}, .angle = -std::numbers::pi / 2});
  scene.joints[2] = hinge("wa", "post", "a", {2, 0}, {-1, 0});
  ASSERT_EQ(not_a_mechanism(scene), "");
  const Vec2d at = links_of(scene)[0].parent_anchor;
  EXPECT_NEAR(at.x, 0, 1e-15);
  EXPECT_NEAR(at.y, 0, 1e-15);
}

struct Refusal {
  const char* reason;
  void (*spoil)(Scene&);
};

void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.reason; }

class MechanismRefuses : public ::testing::TestWithParam<Refusal> {};

TEST_P(MechanismRefuses, WithTheReason) {
  Scene scene = tree();
  GetParam().spoil(scene);
  EXPECT_THAT(not_a_mechanism(scene), HasSubstr(GetParam().reason));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, MechanismRefuses,
    ::testing::Values(
        Refusal{"joint 'rod': only revolute joints",
                [](Scene& s) {
                  s.joints.emplace_back(
                      DistanceJoint{.name = "rod", .body_a = "a", .body_b = "b", .length = 2});
                }},
        Refusal{"joint 'bc': it closes a loop",
                [](Scene& s) {
                  s.joints.emplace_back(hinge("bc", "b", "c", {1, 0}, {1, 0}));
                }},
        Refusal{"joint 'wa': it closes a loop",  // c hangs from the world, a from c
                [](Scene& s) {
                  s.joints.emplace_back(hinge("wc", "world", "c", {4, 0}, {1, 0}));
                }},
        Refusal{"joint 'ww': it closes a loop",
                [](Scene& s) {
                  s.joints.emplace_back(hinge("ww", "world", "a", {0, 0}, {-1, 0}));
                }},
        Refusal{"body 'a' is kinematic", [](Scene& s) { s.bodies[3].type = BodyType::Kinematic; }},
        Refusal{"body 'b' has a fixed rotation", [](Scene& s) { s.bodies[1].fixed_rotation = true; }},
        Refusal{"the hinge of body 'b' is open", [](Scene& s) { s.bodies[1].position.y += 1e-3; }},
        Refusal{"the velocity of body 'c' violates its hinge", [](Scene& s) { s.bodies[0].velocity.x = 1; }},
        Refusal{"bodies 'c' and 'b' may touch",
                [](Scene& s) {
                  s.bodies[0].shapes.push_back({.geometry = Circle{0.1}});
                  s.bodies[1].shapes.push_back({.geometry = Circle{0.1}});
                }}),
    [](const auto& which) { return "case" + std::to_string(which.index); });

TEST(Mechanism, ShapesThatJointsOrFiltersKeepApartMayBeThere) {
  Scene scene = tree();
  scene.bodies[3].shapes.push_back({.geometry = Circle{0.1}});
  scene.bodies[1].shapes.push_back({.geometry = Circle{0.1}});  // joined to a
  scene.bodies[2].shapes.push_back({.geometry = Circle{0.1}, .filter = {.mask = 0}});
  EXPECT_EQ(not_a_mechanism(scene), "");
}

}  // namespace
}  // namespace plumb::reference
