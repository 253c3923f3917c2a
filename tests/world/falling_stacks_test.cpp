#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/world/support.h"

// Bodies that touch each other and fall together onto a floor, without restitution. The impact is plastic: it
// stops all of them, so that none moves up by more than gravity's velocity of a step, and none rises above
// the place where it rests.
namespace plumb {
namespace {

constexpr double kDt = 1.0 / 60, kStepSpeed = kGravity * kDt;

struct Stack {
  int count = 2;
  double fall = 2;  // m
  ShapeGeometry geometry = Box{1, 1};
  double height = 1;  // m, of each body
};

// Returns the number of steps from rest until a fall ends, and one more.
int steps_of_fall(double fall, double dt) {
  return static_cast<int>(std::sqrt(2 * fall / kGravity) / dt) + 2;
}

// Runs the step of the impact and half a second; returns the largest velocity up of any body, m/s.
template <class Real>
double velocity_up_after(BasicWorld<Real>& world, const std::vector<BodyId>& bodies, double fall, double dt,
                         int substeps) {
  run(world, steps_of_fall(fall, dt), dt, substeps);
  double up = 0;
  for (double time = 0; time < 0.5; time += dt) {
    for (const BodyId body : bodies) up = std::max(up, world.velocity(body).y);
    world.step(dt, substeps);
  }
  return up;
}

template <class Real>
void expect_to_stay(const Stack& stack, double dt, int substeps) {
  BasicWorld<Real> world(without_sleep());
  add_ground(world);
  std::vector<BodyId> bodies;
  for (int i = 0; i < stack.count; ++i)
    bodies.push_back(
        add_body(world, {0, stack.fall + (i + 0.5) * stack.height}, {.geometry = stack.geometry}));
  const double up = velocity_up_after(world, bodies, stack.fall, dt, substeps);
  const std::string scene = std::to_string(stack.count) + " bodies fall by " + std::to_string(stack.fall) +
                            " m with steps of " + std::to_string(dt) + " s / " + std::to_string(substeps);
  EXPECT_LT(up, kStepSpeed) << scene;
  for (int i = 0; i < stack.count; ++i) {
    EXPECT_NEAR(world.position(bodies[i]).y, (i + 0.5) * stack.height, 0.005 * stack.height) << scene;
    EXPECT_NEAR(world.velocity(bodies[i]).y, 0, 0.01) << scene;
  }
}

TEST(FallingStacks, StayWhereTheyLand) {
  for (const int count : {2, 3, 5, 20}) {
    for (const double fall : {0.1, 0.5, 2.0, 20.0, 50.0}) {
      expect_to_stay<float>({.count = count, .fall = fall}, kDt, 4);
      expect_to_stay<double>({.count = count, .fall = fall}, kDt, 4);
    }
  }
}

TEST(FallingStacks, OfAnyShapeStayWhereTheyLand) {
  for (const double fall : {0.5, 2.0, 20.0}) {
    expect_to_stay<float>({.count = 3, .fall = fall, .geometry = Circle{0.5}}, kDt, 4);
    expect_to_stay<float>({.count = 3, .fall = fall, .geometry = Box{4, 1}}, kDt, 4);
    expect_to_stay<float>({.count = 3, .fall = fall, .geometry = Box{0.2, 0.2}, .height = 0.2}, kDt, 4);
  }
}

TEST(FallingStacks, StayWithAnyStepAndNumberOfSubsteps) {
  for (const double fall : {0.5, 2.0, 20.0}) {
    for (const int substeps : {1, 2, 8, 16}) expect_to_stay<float>({.count = 5, .fall = fall}, kDt, substeps);
    expect_to_stay<float>({.count = 5, .fall = fall}, kDt / 8, 4);
  }
}

TEST(FallingStacks, OfDifferentMassesStayWhereTheyLand) {
  for (const double fall : {0.5, 2.0, 20.0}) {
    World world(without_sleep());
    add_ground(world);
    std::vector<BodyId> bodies;
    for (int i = 0; i < 4; ++i) bodies.push_back(add_box(world, {0, fall + i + 0.5}, i % 2 == 0 ? 1 : 10));
    EXPECT_LT(velocity_up_after(world, bodies, fall, kDt, 4), kStepSpeed);
  }
}

// Gaps that close within the step of the impact change nothing.
TEST(FallingStacks, WithSmallGapsStayWhereTheyLand) {
  for (const double gap : {0.001, 0.01}) {
    for (const double fall : {2.0, 20.0}) {
      World world(without_sleep());
      add_ground(world);
      std::vector<BodyId> bodies;
      for (int i = 0; i < 5; ++i) bodies.push_back(add_box(world, {0, fall + i * (1 + gap) + 0.5}));
      EXPECT_LT(velocity_up_after(world, bodies, fall, kDt, 4), kStepSpeed) << gap << ", " << fall;
    }
  }
}

TEST(FallingStacks, PyramidsStayWhereTheyLand) {
  for (const double fall : {0.5, 5.0, 20.0}) {
    World world(without_sleep());
    add_ground(world);
    std::vector<BodyId> bodies;
    for (int row = 0; row < 5; ++row)
      for (int i = 0; i < 5 - row; ++i)
        bodies.push_back(add_box(world, {i - 0.5 * (4 - row), fall + row + 0.5}));
    EXPECT_LT(velocity_up_after(world, bodies, fall, kDt, 4), kStepSpeed) << fall;
  }
}

// Without gravity a row that flies at a wall stays there.
TEST(FallingStacks, RowsStayAtTheWallThatTheyHit) {
  for (const double speed : {1.0, 5.0, 30.0}) {
    for (const bool discs : {false, true}) {
      World world(weightless());
      BodyDefinition wall;
      wall.type = BodyType::Static;
      world.create_body(wall, ShapeDefinition{.geometry = Box{2, 10}, .position = {-1, 0}});
      std::vector<BodyId> bodies;
      for (int i = 0; i < 5; ++i)
        bodies.push_back(add_body(world, {1.503 + i, 0},
                                  {.geometry = discs ? ShapeGeometry{Circle{0.5}} : ShapeGeometry{Box{1, 1}}},
                                  {-speed, 0}));
      run(world, static_cast<int>(1 / speed / kDt) + 3);
      for (const BodyId body : bodies) EXPECT_NEAR(world.velocity(body).x, 0, 0.02 * speed) << speed;
    }
  }
}

// The floor takes the momentum of the whole stack in the step of the impact: n m v, plus the weight of the
// rest of the step.
TEST(FallingStacks, ReportTheImpulseOfTheWholeStack) {
  World world(without_sleep());
  add_ground(world);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 3; ++i)
    bodies.push_back(add_body(world, {0, 2 + i + 0.5}, {.geometry = Box{1, 1}, .hit_events = true}));
  double momentum = 0, impulse = 0;
  while (impulse == 0 && world.time() < 2) {
    momentum = 0;
    for (const BodyId body : bodies) momentum -= world.mass(body) * world.velocity(body).y;
    world.step(kDt);
    for (const ContactReading& contact : world.contacts(bodies[0]))
      if (std::abs(contact.points[0].y) < 0.1) impulse = contact.step_impulse;
  }
  const double weight = 3 * world.mass(bodies[0]) * kStepSpeed;
  EXPECT_NEAR(impulse, momentum + weight, weight);
}

}  // namespace
}  // namespace plumb
