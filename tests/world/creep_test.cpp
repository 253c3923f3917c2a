#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/world/support.h"

// Checks that bodies held by friction do not creep while they are kept awake.
namespace plumb {
namespace {

template <class Real>
class Creep : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Creep, Reals);

struct Pile {
  double width = 1, height = 0.5, gap = 0, friction = 0.5;
  std::vector<int> rows{};  ///< bricks of each, from below; each row lies half a brick further in
  bool straight = false;    ///< rows of a wall: in and out in turn
};

template <class Real>
std::vector<BodyId> add_pile(BasicWorld<Real>& world, const Pile& pile) {
  const Material material{.friction = pile.friction};
  world.create_body({.type = BodyType::Static, .position = {0, -1}},
                    {.geometry = Box{200, 2}, .material = material});
  std::vector<BodyId> bricks;
  for (std::size_t row = 0; row < pile.rows.size(); ++row) {
    const double in = 0.5 * static_cast<double>(pile.straight ? row % 2 : row);
    for (int i = 0; i < pile.rows[row]; ++i)
      bricks.push_back(world.create_body(
          {.position = {(i + in) * (pile.width + pile.gap), pile.height * (static_cast<double>(row) + 0.5)}},
          {.geometry = Box{pile.width, pile.height}, .material = material}));
  }
  return bricks;
}

/// Farthest that a body moves in `time` after a minute, m.
template <class Real>
double moved(BasicWorld<Real>& world, const std::vector<BodyId>& bodies, double time) {
  run(world, 3600);
  std::vector<Vec2d> before;
  for (const BodyId body : bodies) before.push_back(world.position(body));
  run(world, static_cast<int>(time * 60));
  double most = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    most = std::max(most, std::sqrt(length_squared(world.position(bodies[i]) - before[i])));
  return most;
}

TYPED_TEST(Creep, AWallStands) {
  BasicWorld<TypeParam> world(without_sleep());
  const auto bricks = add_pile(world, {.rows = {8, 7, 8, 7, 8, 7, 8, 7, 8, 7, 8, 7}, .straight = true});
  EXPECT_LT(moved(world, bricks, 60), 1e-5);
  EXPECT_NEAR(world.position(bricks[0]).x, 0, 1e-3);
}

// Each brick lies on two others that are not quite level: more supports than hold it.
TYPED_TEST(Creep, BricksOnTwoOthersStand) {
  const Pile piles[] = {
      {.width = 1.175, .height = 0.979, .gap = 0.14, .friction = 0.67, .rows = {9, 8, 9}, .straight = true},
      {.width = 1.007, .height = 0.385, .gap = 0.114, .friction = 0.34, .rows = {5, 4, 3, 2, 1}},
      {.width = 1, .height = 1, .gap = 0.02, .friction = 0.6, .rows = {8, 7, 6, 5, 4, 3, 2, 1}}};
  for (const Pile& pile : piles) {
    BasicWorld<TypeParam> world(without_sleep());
    const auto bricks = add_pile(world, pile);
    EXPECT_LT(moved(world, bricks, 30), 5e-4) << pile.rows.size() << " rows; it shook by centimetres";
  }
}

// g (sin a - mu cos a) above the angle of friction, nothing below.
TYPED_TEST(Creep, ASlopeHoldsUpToItsFriction) {
  for (const double friction : {0.3, 0.6, 0.9}) {
    for (const double beyond : {-0.01, 0.01}) {
      const double angle = std::atan(friction) + beyond;
      WorldDefinition definition = without_sleep();
      definition.gravity = {9.81 * std::sin(angle), -9.81 * std::cos(angle)};
      BasicWorld<TypeParam> world(definition);
      const auto boxes = add_pile(world, {.height = 0.25, .friction = friction, .rows = {1}});
      if (beyond < 0) {
        EXPECT_LT(moved(world, boxes, 60), 1e-5) << friction;
        continue;
      }
      run(world, 120);
      const double before = world.velocity(boxes[0]).x;
      run(world, 60);
      const double right = 9.81 * (std::sin(angle) - friction * std::cos(angle));
      EXPECT_NEAR(world.velocity(boxes[0]).x - before, right, 0.01 * right) << friction;
    }
  }
}

// Friction that holds by a thousandth more than the load. In the first substep the block moves before
// friction acts, by g sin(a) h^2 = 0.1 mm; then it stands. It slid by 1 to 50 mm while a block free to turn
// took up its friction over several substeps.
TYPED_TEST(Creep, ABlockNearTheLimitOfFrictionHoldsAtOnce) {
  for (const double friction : {0.2, 0.5, 0.9}) {
    for (const double height : {0.25, 0.5, 1.0}) {
      const double angle = std::atan(friction);
      WorldDefinition definition = without_sleep();
      definition.gravity = {9.81 * std::sin(angle), -9.81 * std::cos(angle)};
      BasicWorld<TypeParam> world(definition);
      const auto boxes = add_pile(world, {.height = height, .friction = 1.001 * friction, .rows = {1}});
      run(world, 240);
      const double substep = 1.0 / 240;
      EXPECT_LT(world.position(boxes[0]).x, 1.2 * 9.81 * std::sin(angle) * substep * substep)
          << friction << ' ' << height;
    }
  }
}

}  // namespace
}  // namespace plumb
