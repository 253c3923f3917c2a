#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "harness/joint_gap.h"
#include "harness/penetration.h"

namespace plumb::harness {
namespace {

constexpr double kRoot2 = std::numbers::sqrt2;

PlacedShape circle(double x, double y, double radius) { return {true, {x, y}, {1, 0}, radius, radius}; }
PlacedShape box(double x, double y, double width, double height, double angle = 0) {
  return {false, {x, y}, {std::cos(angle), std::sin(angle)}, width / 2, height / 2};
}

TEST(Overlap, OfKnownPairs) {
  EXPECT_NEAR(overlap(circle(0, 0, 1), circle(3, 4, 4.5)), 0.5, 1e-14);
  EXPECT_NEAR(overlap(circle(0, 0, 1), circle(3, 4, 3)), -1, 1e-14);
  EXPECT_NEAR(overlap(box(0, 0, 2, 1), circle(1.5, 0, 0.6)), 0.1, 1e-14);
  EXPECT_NEAR(overlap(circle(1.3, 0.9, 0.6), box(0, 0, 2, 1)), 0.1, 1e-14);  // at the corner: 0.3, 0.4, 0.5
  EXPECT_NEAR(overlap(box(0, 0, 2, 1), circle(0.9, 0, 0.25)), 0.35,
              1e-14);  // centre inside, 0.1 below the face
  EXPECT_NEAR(overlap(box(0, 0, 1, 1), box(0.9, 0.2, 1, 1)), 0.1, 1e-14);
  EXPECT_NEAR(overlap(box(0, 0, 1, 1), box(0.5 + kRoot2 / 2 - 0.05, 0, 1, 1, std::numbers::pi / 4)), 0.05,
              1e-14);
  // Apart along one axis alone, of the four that there are.
  const double corner = 0.5 + kRoot2 / 2 + 0.05, eighth = std::numbers::pi / 4;
  EXPECT_NEAR(overlap(box(0, 0, 1, 1, eighth), box(corner, 0, 1, 1)), -0.05, 1e-14);
  EXPECT_NEAR(overlap(box(0, 0, 1, 1, eighth), box(0, corner, 1, 1)), -0.05, 1e-14);
  EXPECT_NEAR(overlap(box(corner, 0, 1, 1), box(0, 0, 1, 1, eighth)), -0.05, 1e-14);
  EXPECT_NEAR(overlap(box(0, corner, 1, 1), box(0, 0, 1, 1, eighth)), -0.05, 1e-14);
}

Scene crowd(int count, double spacing) {
  Scene scene;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    Body body{.name = "b" + std::to_string(i),
              .position = {spacing * (i % side) + jitter(random), spacing * (i / side) + jitter(random)}};
    body.angle = jitter(random) * 5;
    if (i % 2 == 0) {
      body.shapes = {{.geometry = Circle{0.5}}};
    } else {
      body.shapes = {{.geometry = Box{1, 0.8}, .position = {0.1, 0}, .angle = 0.3}};
    }
    if (i % 7 == 0) body.shapes[0].filter.group = -1;
    scene.bodies.push_back(body);
  }
  return scene;
}

std::vector<BodyState> states_of(const Scene& scene) {
  std::vector<BodyState> states;
  for (const Body& body : scene.bodies) states.push_back(initial_state(body));
  return states;
}

PlacedShape placed(const Body& body) {
  const Shape& shape = body.shapes[0];
  if (const auto* round = std::get_if<Circle>(&shape.geometry))
    return circle(body.position.x, body.position.y, round->radius);
  const auto& b = std::get<Box>(shape.geometry);
  const double c = std::cos(body.angle), s = std::sin(body.angle);
  return box(body.position.x + c * shape.position.x, body.position.y + s * shape.position.x, b.width,
             b.height, body.angle + shape.angle);
}

TEST(Penetration, SweepFindsWhatAllPairsHave) {
  for (const double spacing : {0.8, 1.0, 1.3}) {
    const Scene scene = crowd(150, spacing);
    double deepest = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      for (std::size_t j = i + 1; j < scene.bodies.size(); ++j)
        if (may_touch(scene.bodies[i].shapes[0].filter, scene.bodies[j].shapes[0].filter))
          deepest = std::max(deepest, overlap(placed(scene.bodies[i]), placed(scene.bodies[j])));
    PenetrationMeter meter(scene);
    ASSERT_TRUE(meter.possible());
    EXPECT_NEAR(meter.deepest(states_of(scene)), deepest, 1e-13) << spacing;
    EXPECT_NEAR(meter.deepest(states_of(scene)), deepest, 1e-13) << "the second time, sorted already";
  }
}

TEST(Penetration, TenThousandBodiesArePossible) {
  const Scene scene = crowd(10000, 1.2);
  const std::vector<BodyState> states = states_of(scene);
  PenetrationMeter meter(scene);
  meter.deepest(states);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_GT(meter.deepest(states), 0);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 2);
}

TEST(Penetration, IsImpossibleWhereNoPairMayTouch) {
  Scene scene = crowd(2, 0.1);
  EXPECT_TRUE(PenetrationMeter(scene).possible());
  scene.joints = {RevoluteJoint{.name = "j", .body_a = "b1", .body_b = "b0", .anchor_a = {}, .anchor_b = {}}};
  EXPECT_FALSE(PenetrationMeter(scene).possible());
  scene.joints.clear();
  for (Body& body : scene.bodies) body.shapes[0].filter = {.category = 1, .mask = 0};
  EXPECT_FALSE(PenetrationMeter(scene).possible());
  Scene fixed = crowd(2, 0.1);
  for (Body& body : fixed.bodies) body.type = BodyType::Static;
  EXPECT_FALSE(PenetrationMeter(fixed).possible());
}

TEST(JointGap, OfBothKinds) {
  Scene scene;
  scene.bodies = {{.name = "a"}, {.name = "b"}};
  scene.joints = {RevoluteJoint{.name = "pin",
                                .body_a = std::string(kWorld),
                                .body_b = "a",
                                .anchor_a = {1, 0},
                                .anchor_b = {-0.5, 0}},
                  DistanceJoint{.name = "rod",
                                .body_a = "a",
                                .body_b = "b",
                                .anchor_a = {0.5, 0},
                                .anchor_b = {0, 0},
                                .length = 2}};
  const JointGaps gaps(scene);
  ASSERT_EQ(gaps.size(), 2u);
  // a stands upright at (1, 0.5): its anchor (-0.5, 0) is at (1, 0), the other end at (1, 1).
  std::vector<BodyState> states(2);
  states[0] = {{1, 0.5}, std::numbers::pi / 2, {}, 0};
  states[1] = {{1, 3}, 0, {}, 0};
  EXPECT_NEAR(gaps.gap(0, states), 0, 1e-15);
  EXPECT_NEAR(gaps.gap(1, states), 0, 1e-15);
  states[0].position += {0.3, 0.4};
  EXPECT_NEAR(gaps.gap(0, states), 0.5, 1e-15);
  states[0].position = {1, 0.5};
  states[1].position.y = 2.75;
  EXPECT_NEAR(gaps.gap(1, states), 0.25, 1e-15);
}

}  // namespace
}  // namespace plumb::harness
