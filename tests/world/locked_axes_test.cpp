#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/world/support.h"

// Bodies with locked axes in contact with others. Along a locked axis a body has infinite mass. Truth is the
// closed form of Newton's law of impact with an inverse mass for each axis: the impulse of bodies that close
// with v along n is (1 + e) v / (n . (1/M_a + 1/M_b) n + r_a^2 / I_a + r_b^2 / I_b).
namespace plumb {
namespace {

template <class Real>
class LockedAxes : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(LockedAxes, Precisions);

constexpr double kRadius = 0.5;
const Solver kRigidSolvers[] = {Solver::SoftSteps, Solver::Direct, Solver::SequentialImpulses};

// Rounding of speeds of some m/s over the substeps of a test, and positions at which smooth bodies meet: some
// 1e-5 of what they move in float.
template <class Real>
double rounding() {
  return 1000 * static_cast<double>(std::numeric_limits<Real>::epsilon());
}

template <class Real>
BodyId add_disc(BasicWorld<Real>& world, Vec2d position, Vec2d velocity, double mass, double restitution,
                BodyLocks locks = {}) {
  return world.create_body({.position = position,
                            .velocity = velocity,
                            .mass = MassProperties{.mass = mass, .inertia = 0.4 * mass * kRadius * kRadius},
                            .lock_x = locks.x,
                            .lock_y = locks.y,
                            .lock_rotation = locks.rotation},
                           ShapeDefinition{.geometry = Circle{kRadius}, .material = {0, restitution}});
}

TYPED_TEST(LockedAxes, ABodyWithBothLockedThrowsBackAllThatStrikesIt) {
  for (const Solver solver : kRigidSolvers) {
    for (const double restitution : {1.0, 0.5, 0.0}) {
      BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
      const BodyId ball = add_disc(world, {-2, 0}, {3, 0}, 1, restitution);
      const BodyId post = add_disc(world, {0, 0}, {}, 1, restitution, {.x = true, .y = true});
      run(world, 60);
      EXPECT_NEAR(world.velocity(ball).x, -3 * restitution, 3 * rounding<TypeParam>())
          << static_cast<int>(solver) << " " << restitution;
      EXPECT_EQ(world.velocity(post), Vec2d{});
      EXPECT_EQ(world.position(post), Vec2d{});
    }
  }
}

// A rod that turns about its locked centre is struck at the arm r: the ball finds the mass I / r^2.
TYPED_TEST(LockedAxes, ARodThatTurnsAboutItsLockedCentreIsStruckAsAnInertia) {
  constexpr double kMass = 2, kArm = 0.75, kSpeed = 3;
  for (const Solver solver : kRigidSolvers) {
    for (const double restitution : {1.0, 0.5}) {
      BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
      const BodyId rod =
          world.create_body({.lock_x = true, .lock_y = true},
                            ShapeDefinition{.geometry = Box{2, 0.2}, .material = {0, restitution}});
      const BodyId ball = add_disc(world, {kArm, 1}, {0, -kSpeed}, kMass, restitution);
      const double inertia = world.inertia(rod);
      run(world, 12);
      const double impulse = (1 + restitution) * kSpeed / (1 / kMass + kArm * kArm / inertia);
      EXPECT_NEAR(world.velocity(ball).y, -kSpeed + impulse / kMass, kSpeed * rounding<TypeParam>())
          << static_cast<int>(solver) << " " << restitution;
      EXPECT_NEAR(world.angular_velocity(rod), -impulse * kArm / inertia, 5 * kSpeed * rounding<TypeParam>());
      EXPECT_EQ(world.velocity(rod), Vec2d{});
    }
  }
}

// Locks that are set and taken away again leave the mass as it was.
TYPED_TEST(LockedAxes, UnlockedABodyHasItsMassAgain) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
  const BodyId ball = add_disc(world, {-2, 0}, {3, 0}, 1, 1);
  const BodyId other = add_disc(world, {0, 0}, {}, 1, 1, {.x = true, .y = true});
  world.set_locks(other, false, false, false);
  run(world, 60);
  EXPECT_NEAR(world.velocity(ball).x, 0, 3 * rounding<TypeParam>());
  EXPECT_NEAR(world.velocity(other).x, 3, 3 * rounding<TypeParam>());
}

// Discs meet with the line of centres at 45 degrees; the struck one moves along one axis only. Without
// restitution their contact is not an impact but a row of the solver.
TYPED_TEST(LockedAxes, AnObliqueBlowWithoutReboundMovesABodyAlongItsFreeAxis) {
  for (const bool lock_x : {true, false}) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
    const double side = std::sqrt(0.5) * 2 * kRadius;
    add_disc(world, {-side, -side}, {1, 0}, 1, 0);
    const BodyId struck = add_disc(world, {0, 0}, {}, 2, 0, {.x = lock_x, .y = !lock_x});
    world.step(1.0 / 1000, 1);
    const double along = std::sqrt(0.5), impulse = along / (1 + 0.5 * along * along);
    const Vec2d exact = lock_x ? Vec2d{0, 0.5 * impulse * along} : Vec2d{0.5 * impulse * along, 0};
    EXPECT_NEAR(world.velocity(struck).x, exact.x, rounding<TypeParam>()) << lock_x;
    EXPECT_NEAR(world.velocity(struck).y, exact.y, rounding<TypeParam>()) << lock_x;
  }
}

// The ground holds a block that keeps its x on a smooth slope: N cos(a) = m g, and it stays where it is.
TYPED_TEST(LockedAxes, ABlockThatKeepsItsXRestsOnASmoothSlope) {
  constexpr double kSlope = 0.4;
  BasicWorld<TypeParam> world(without_sleep());
  const ShapeDefinition ground{.geometry = Box{20, 1}, .material = {0, 0}};
  const ShapeDefinition smooth{.geometry = Box{1, 1}, .material = {0, 0}};
  world.create_body({.type = BodyType::Static, .angle = kSlope}, ground);
  const Vec2d start{-std::sin(kSlope), std::cos(kSlope)};
  const BodyId block =
      world.create_body({.position = start, .angle = kSlope, .lock_x = true, .lock_rotation = true}, smooth);
  run(world, 120);
  EXPECT_NEAR(world.position(block).y, start.y, 2e-6);
  EXPECT_NEAR(world.velocity(block).y, 0, rounding<TypeParam>());
}

}  // namespace
}  // namespace plumb
