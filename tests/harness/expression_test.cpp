#include "harness/case_file/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/scene/error.h"

namespace plumb::harness::case_file {
namespace {

Scene two_balls(const char* second) {
  Scene scene;
  scene.gravity = {0, -10};
  scene.bodies.push_back({.name = "left ball",
                          .position = {1, 2},
                          .velocity = {3, 4},
                          .mass = 5,
                          .shapes = {{.geometry = Circle{2}}}});
  scene.bodies.push_back({.name = second, .position = {-1, 0}, .shapes = {{.geometry = Circle{1}}}});
  scene.joints = {DistanceJoint{.name = "rod", .body_a = "left ball", .body_b = second, .length = 7}};
  return scene;
}

double value(const std::string& text, const Scene& scene = two_balls("right")) {
  const Names names(scene);
  std::vector<BodyState> states{initial_state(scene.bodies[0]), initial_state(scene.bodies[1])};
  states[0].position.x = 10;
  return Expression(text, names).at(0.5, states);
}

Error::Kind kind_of_error(const std::string& text, const Scene& scene = two_balls("right")) {
  try {
    value(text, scene);
  } catch (const Error& error) {
    return error.kind();
  }
  ADD_FAILURE() << text << " was taken";
  return Error::Kind::Io;
}

TEST(Expression, KnowsStatesStartsAndWhatTheSceneHas) {
  EXPECT_EQ(value("left_ball.x"), 10);
  EXPECT_EQ(value("left_ball.x0"), 1);
  EXPECT_EQ(value("left_ball.vy"), 4);
  EXPECT_EQ(value("left_ball.mass"), 5);
  EXPECT_EQ(value("left_ball.inertia"), 10);
  EXPECT_EQ(value("rod.length"), 7);
  EXPECT_EQ(value("gravity.y"), -10);
  EXPECT_EQ(value("t"), 0.5);
  EXPECT_EQ(value("-1.5e-3"), -1.5e-3);
}

TEST(Expression, EvaluatesFormulas) {
  if (kind_of_error("1 +") == Error::Kind::Unsupported) GTEST_SKIP() << "built without muparser";
  EXPECT_EQ(value("left_ball.x - 3*t"), 8.5);
  EXPECT_NEAR(value("cos(pi)"), -1, 1e-15);
  EXPECT_EQ(value("hypot(3, 4)"), 5);
  EXPECT_EQ(value("mod(-1, 3)"), 2);
  EXPECT_EQ(value("t < 1 ? 2 : 3"), 2);
  EXPECT_EQ(value("2^3^1"), 8);
  EXPECT_NEAR(value("ln(exp(2))"), 2, 1e-15);
}

TEST(Expression, RefusesWhatIsNoFormulaAndWhatItDoesNotKnow) {
  EXPECT_EQ(kind_of_error("left_bal.x"), Error::Kind::Name);
  EXPECT_EQ(kind_of_error("2*left_bal.x"), Error::Kind::Name);
  for (const char* text : {"", "1 +", "sin(", "3 4", "1 $ 2", "sin(1, 2)"})
    EXPECT_EQ(kind_of_error(text), Error::Kind::Syntax) << text;
}

// "left ball" and "left-ball" are both left_ball in a formula.
TEST(Expression, RefusesANameThatMeansTwoThings) {
  EXPECT_EQ(kind_of_error("left_ball.x", two_balls("left-ball")), Error::Kind::Name);
}

TEST(Names, TakeConstantsOnce) {
  Names names(two_balls("right"));
  names.add("k", 3);
  EXPECT_EQ(Expression("k", names).at(0, {}), 3);
  EXPECT_FALSE(Expression("k", names).varies());
  EXPECT_TRUE(Expression("right.x", names).varies());
  EXPECT_THROW(names.add("k", 4), Error);
  EXPECT_THROW(names.add("t", 4), Error);
  EXPECT_THROW(names.add("2k", 4), Error);
}

}  // namespace
}  // namespace plumb::harness::case_file
