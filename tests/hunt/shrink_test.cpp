#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/hunt/finding.h"
#include "harness/hunt/idiom.h"
#include "harness/hunt/shrink.h"

namespace plumb::harness::hunt {
namespace {

Case with_bodies(int count) {
  Case one;
  one.scene.name = "many";
  for (int i = 0; i < count; ++i) {
    Body body{.name = "b" + std::to_string(i), .position = {1.2345678 * i, 0.1}};
    body.shapes = {{.geometry = Circle{0.5}}};
    one.scene.bodies.push_back(body);
  }
  one.scene.joints = {RevoluteJoint{.name = "j", .body_a = "b1", .body_b = "b2"}};
  one.actions = {{.kind = ActionKind::Destroy, .step = 3, .target = "b5"}};
  return one;
}

TEST(Shrink, LeavesWhatIsNeededAlone) {
  const Case smallest = shrink(with_bodies(20), [](const Case& one) {
    return find_body(one.scene, "b7").has_value() && find_body(one.scene, "b13").has_value();
  });
  EXPECT_EQ(smallest.scene.bodies.size(), 2u);
  EXPECT_TRUE(smallest.scene.joints.empty());
  EXPECT_TRUE(smallest.actions.empty());
  EXPECT_EQ(smallest.scene.bodies.front().position.x, 9) << "one digit is enough";
  EXPECT_EQ(smallest.steps, 1);
}

TEST(Shrink, WhatIsOwedWithItsMassesKeepsThemAndTheStep) {
  Case one = with_bodies(2);
  one.scene.joints.clear(), one.actions.clear();
  one.dt = 0.01, one.scene.gravity = {0, -3}, one.scene.bodies.front().mass = 7;
  const auto always = [](const Case& candidate) { return find_body(candidate.scene, "b0").has_value(); };
  EXPECT_EQ(shrink(one, always).scene.bodies.front().mass, 1);
  one.expectations = {
      {.name = "falls", .body = "b0", .needs = {"b0", std::string(kMasses)}, .why = "it does"}};
  const Case smallest = shrink(one, [&](const Case& candidate) { return !candidate.expectations.empty(); });
  EXPECT_EQ(smallest.scene.bodies.front().mass, 7);
  EXPECT_EQ(smallest.scene.gravity, (Vec2d{0, -3}));
  EXPECT_EQ(smallest.dt, 0.01);
}

TEST(Shrink, WhatIsNeededOnlyLaterIsTakenAwayWhereItFailsBefore) {
  Case one = with_bodies(6);
  one.expectations = {{.name = "stays", .body = "b0", .until = {{"b3", 0.5}, {"b4", 1.5}}, .why = "it does"}};
  // It is wrong from 1 s on.
  const Case smallest = shrink(one, [](const Case& candidate) {
    return !candidate.expectations.empty() && candidate.expectations.front().to >= 1;
  });
  ASSERT_EQ(smallest.scene.bodies.size(), 2u);
  EXPECT_EQ(smallest.scene.bodies.back().name, "b3");
  EXPECT_EQ(smallest.expectations.front().to, 1.5);
}

TEST(Shrink, WhatAnExpectationNeedsGoesWithIt) {
  Case one = with_bodies(6);
  one.expectations = {{.name = "stays", .body = "b0", .needs = {"b3"}, .why = "it does"}};
  const Case smallest = shrink(one, [](const Case& candidate) { return !candidate.expectations.empty(); });
  ASSERT_EQ(smallest.scene.bodies.size(), 2u);
  EXPECT_EQ(smallest.scene.bodies.front().position, one.scene.bodies.front().position);
  EXPECT_FALSE(smallest.scene.bodies.front().shapes.empty());
}

TEST(Finding, ReadsBack) {
  Finding finding{
      .engine = "plumb-float",
      .objection = {.law = "energy", .judge = "energy", .what = "it grew", .right = "it does not"},
      .smallest = compose(1, 4)};
  finding.objection.figure = INFINITY;
  finding.kind = "energy: " + made_of(finding.smallest, "energy");
  EXPECT_EQ(to_json(finding_from_json(to_json(finding))), to_json(finding));
}

}  // namespace
}  // namespace plumb::harness::hunt
