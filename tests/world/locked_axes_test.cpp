#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

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
const Solver kSolvers[] = {Solver::SoftSteps, Solver::Direct, Solver::SequentialImpulses, Solver::Jakobsen,
                           Solver::Xpbd};

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
  for (const Solver solver : kSolvers) {
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
  for (const Solver solver : kSolvers) {
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

// While a body is disabled its locks hold for what it is given, as they do once it is enabled.
TYPED_TEST(LockedAxes, ADisabledBodyTakesNoSpinThatALockForbids) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}});
  const BodyId box = world.create_body({.lock_rotation = true}, {.geometry = Box{1, 0.5}});
  world.set_enabled(box, false);
  world.set_angular_velocity(box, 3);
  EXPECT_EQ(world.angular_velocity(box), 0);
  world.set_enabled(box, true);
  world.step();
  EXPECT_EQ(world.angle(box), 0);
}

// A kinematic body turns as told, whatever is locked. Once dynamic it keeps its angle.
TYPED_TEST(LockedAxes, AKinematicBodyThatBecomesDynamicLosesItsSpinToALock) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
  const BodyId bat = world.create_body({.type = BodyType::Kinematic, .angular_velocity = 4},
                                       ShapeDefinition{.geometry = Box{2, 0.2}});
  world.set_locks(bat, false, false, true);
  world.step();
  EXPECT_NEAR(world.angle(bat), 4.0 / 60, rounding<TypeParam>());
  world.set_type(bat, BodyType::Dynamic);
  EXPECT_EQ(world.angular_velocity(bat), 0);
  const double angle = world.angle(bat);
  run(world, 10);
  EXPECT_EQ(world.angle(bat), angle);
}

// Discs meet with the line of centres at 45 degrees; the struck one moves along one axis only.
TYPED_TEST(LockedAxes, AnObliqueBlowMovesABodyAlongItsFreeAxis) {
  const double along = std::sqrt(0.5), side = along * 2 * kRadius;
  for (const Solver solver : kSolvers) {
    for (const double restitution : {0.0, 0.5, 1.0}) {
      for (const bool lock_x : {true, false}) {
        BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
        const BodyId ball = add_disc(world, {-side, -side}, {1, 0}, 1, restitution);
        const BodyId struck = add_disc(world, {0, 0}, {}, 2, restitution, {.x = lock_x, .y = !lock_x});
        world.step(1.0 / 1000, 1);
        const double impulse = (1 + restitution) * along / (1 + 0.5 * along * along);
        const Vec2d exact = lock_x ? Vec2d{0, 0.5 * impulse * along} : Vec2d{0.5 * impulse * along, 0};
        const std::string which = std::to_string(static_cast<int>(solver)) + " " +
                                  std::to_string(restitution) + (lock_x ? "x" : "y");
        EXPECT_NEAR(world.velocity(struck).x, exact.x, rounding<TypeParam>()) << which;
        EXPECT_NEAR(world.velocity(struck).y, exact.y, rounding<TypeParam>()) << which;
        EXPECT_NEAR(world.velocity(ball).x, 1 - impulse * along, rounding<TypeParam>()) << which;
        EXPECT_NEAR(world.velocity(ball).y, -impulse * along, rounding<TypeParam>()) << which;
      }
    }
  }
}

// The same blow in flight, for which the normal must be that at the time of the impact: placed there by
// continuous collision, or by the solver where a hook could refuse the contact.
TYPED_TEST(LockedAxes, AFastObliqueBlowMovesABodyAlongItsFreeAxis) {
  const double along = std::sqrt(0.5), side = along * 2 * kRadius;
  for (const bool hooked : {true, false}) {
    for (const double speed : {0.5, 5.0, 50.0}) {
      for (const double restitution : {0.0, 1.0}) {
        BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
        const BodyId ball = add_disc(world, {-side - 1, -side}, {speed, 0}, 1, restitution);
        const BodyId struck = add_disc(world, {0, 0}, {}, 2, restitution, {.x = true});
        for (const ShapeId shape : world.shapes(ball)) world.set_pre_solve(shape, hooked);
        run(world, static_cast<int>(60 * 2 / speed) + 2);
        const double impulse = (1 + restitution) * speed * along / (1 + 0.5 * along * along);
        const double bound = speed * rounding<TypeParam>();
        EXPECT_NEAR(world.velocity(struck).y, 0.5 * impulse * along, bound) << speed << " " << hooked;
        EXPECT_NEAR(world.velocity(ball).x, speed - impulse * along, bound) << speed << " " << hooked;
        EXPECT_EQ(world.position(struck).x, 0);
      }
    }
  }
}

// Nine discs in a room, smooth and elastic, six of which keep their x or their y: no energy is lost or
// gained.
TYPED_TEST(LockedAxes, BodiesWithALockedAxisKeepTheirEnergyInElasticImpacts) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
  const Material bouncy{0, 1};
  const BodyId room = world.create_body({.type = BodyType::Static});
  for (const Vec2d centre : {Vec2d{-6, 0}, Vec2d{6, 0}})
    world.create_shape(room, {.geometry = Box{1, 12}, .position = centre, .material = bouncy});
  for (const Vec2d centre : {Vec2d{0, -6}, Vec2d{0, 6}})
    world.create_shape(room, {.geometry = Box{12, 1}, .position = centre, .material = bouncy});
  const auto energy = [&] {
    double sum = 0;
    for (const BodyId body : world.bodies()) {
      if (world.type(body) != BodyType::Dynamic) continue;
      const double spin = world.angular_velocity(body);
      sum += world.mass(body) * length_squared(world.velocity(body)) + world.inertia(body) * spin * spin;
    }
    return sum / 2;
  };
  for (int i = 0; i < 9; ++i) {
    const Vec2d place{1.5 * (i % 3) - 1.5, 1.5 * (i / 3) - 1.5};
    const Vec2d velocity{10 * std::cos(2.4 * i), 10 * std::sin(2.4 * i)};
    const bool keeps_x = i % 3 == 0, keeps_y = i % 3 == 1;
    const BodyId disc = add_disc(world, place, {keeps_x ? 0 : velocity.x, keeps_y ? 0 : velocity.y}, 1 + i, 1,
                                 {.x = keeps_x, .y = keeps_y});
    for (const ShapeId shape : world.shapes(disc)) world.set_pre_solve(shape, true);
  }
  const double before = energy();
  run(world, 600);
  EXPECT_NEAR(energy() / before, 1, rounding<TypeParam>());
}

// Out of an overlap with a steep slope, a disc that keeps its x moves along the normal as fast as a free one.
TYPED_TEST(LockedAxes, AnOverlapIsLeftAlongTheFreeAxis) {
  constexpr double kSlope = 1.2, kOverlap = 0.02;
  const Vec2d normal{-std::sin(kSlope), std::cos(kSlope)};
  std::vector<double> depths[2];
  for (const bool lock_x : {false, true}) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false, .solver = Solver::SequentialImpulses});
    world.create_body({.type = BodyType::Static, .angle = kSlope},
                      ShapeDefinition{.geometry = Box{20, 1}, .material = {0, 0}});
    const BodyId disc = add_disc(world, (1 - kOverlap) * normal, {}, 1, 0, {.x = lock_x});
    for (int i = 0; i < 10; ++i) {
      world.step();
      depths[lock_x].push_back(1 - dot(normal, world.position(disc)));
    }
    EXPECT_LT(depths[lock_x].back(), 0.8 * kOverlap);
  }
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(depths[1][i], depths[0][i], rounding<TypeParam>()) << i;
}

// A row of more blocks than an island solved as one may have, side by side on a smooth slope.
TYPED_TEST(LockedAxes, ManyBlocksThatKeepTheirXRestOnASmoothSlope) {
  constexpr double kSlope = 0.4;
  constexpr int kBlocks = 700;
  BasicWorld<TypeParam> world(without_sleep());
  world.create_body({.type = BodyType::Static, .angle = kSlope},
                    ShapeDefinition{.geometry = Box{2000, 1}, .material = {0, 0}});
  const Vec2d up{-std::sin(kSlope), std::cos(kSlope)}, right{std::cos(kSlope), std::sin(kSlope)};
  std::vector<BodyId> blocks;
  for (int i = 0; i < kBlocks; ++i)
    blocks.push_back(world.create_body({.position = up + (1.0 * (i - kBlocks / 2)) * right,
                                        .angle = kSlope,
                                        .lock_x = true,
                                        .lock_rotation = true},
                                       ShapeDefinition{.geometry = Box{1, 1}, .material = {0, 0}}));
  run(world, 60);
  for (int i = 0; i < kBlocks; i += 50) {
    EXPECT_NEAR(world.velocity(blocks[i]).y, 0, rounding<TypeParam>()) << i;
    EXPECT_EQ(world.velocity(blocks[i]).x, 0) << i;
  }
}

// The ground holds a block that keeps its x on a smooth slope: N cos(a) = m g. It stays where it is, but for
// what soft contacts give under their first load: as much, along y, as those of a free block on level ground.
TYPED_TEST(LockedAxes, ABlockThatKeepsItsXRestsOnASmoothSlope) {
  const auto sinks = [](double slope, bool locked) {
    BasicWorld<TypeParam> world(without_sleep());
    const ShapeDefinition ground{.geometry = Box{20, 1}, .material = {0, 0}};
    const ShapeDefinition smooth{.geometry = Box{1, 1}, .material = {0, 0}};
    world.create_body({.type = BodyType::Static, .angle = slope}, ground);
    const Vec2d start{-std::sin(slope), std::cos(slope)};
    const BodyId block = world.create_body(
        {.position = start, .angle = slope, .lock_x = locked, .lock_rotation = locked}, smooth);
    run(world, 120);
    EXPECT_NEAR(world.velocity(block).y, 0, rounding<TypeParam>());
    return start.y - world.position(block).y;
  };
  EXPECT_NEAR(sinks(0.4, true), sinks(0, false), 1e-7);
}

// Neighbours in adjacent columns touch along the locked axis. All that acts along the free one is the
// rounding of their normals.
TYPED_TEST(LockedAxes, ABoardOfTouchingDiscsStandsStill) {
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct, Solver::SequentialImpulses}) {
    for (const bool direct : {true, false}) {
      for (const auto& [columns, rows] : {std::pair{7, 2}, std::pair{3, 6}, std::pair{3, 8}}) {
        BasicWorld<TypeParam> world({.solver = solver, .direct_islands = direct});
        world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{80, 2}});
        std::vector<BodyId> discs;
        for (int i = 0; i < columns; ++i)
          for (int j = 0; j < rows; ++j)
            discs.push_back(
                world.create_body({.position = {1.0 * i, j + 0.5}, .lock_x = true, .lock_rotation = true},
                                  {.geometry = Circle{0.5}}));
        run(world, 300);
        for (std::size_t k = 0; k < discs.size(); ++k)
          EXPECT_NEAR(world.position(discs[k]).y, static_cast<int>(k) % rows + 0.5, 0.01)
              << "solver " << static_cast<int>(solver) << ", direct islands " << direct << ", disc " << k
              << " of " << columns << " by " << rows;
      }
    }
  }
}

// A disc falls past one that it touches at the same height, up to a rounding, without friction: v = g t.
TYPED_TEST(LockedAxes, ADiscFallsPastOneThatItTouchesFromTheSide) {
  for (const double height : {0.0, 1e-16, 1e-15, 1e-12, 1e-8}) {
    BasicWorld<TypeParam> world({.gravity = {0, -10}});
    world.create_body({.type = BodyType::Static, .position = {1, 0}},
                      ShapeDefinition{.geometry = Circle{0.5}, .material = {0, 0}});
    const BodyId disc = world.create_body({.position = {0, height}, .lock_x = true},
                                          ShapeDefinition{.geometry = Circle{0.5}, .material = {0, 0}});
    run(world, 60);
    EXPECT_NEAR(world.velocity(disc).y, -10, 0.01) << height;
    EXPECT_NEAR(world.position(disc).y, -5, 0.01) << height;
  }
}

// Some bodies of a heap at rest get locks, also both with which a disc can only rotate. A lock supports more
// than friction did, so they settle, and reach no more than the speed of a fall through the heap.
TYPED_TEST(LockedAxes, AHeapWhoseBodiesAreLockedSettles) {
  for (int seed = 1; seed <= 30; ++seed) {
    for (const double friction : {0.6, 0.0}) {
      std::mt19937 random(seed);
      BasicWorld<TypeParam> world({.gravity = {0, -10}});
      const BodyId bin = world.create_body({.type = BodyType::Static});
      const Material material{friction, 0};
      for (const auto& [size, at] : {std::pair{Box{20, 2}, Vec2d{0, -3}}, std::pair{Box{2, 20}, Vec2d{-3, 0}},
                                     std::pair{Box{2, 20}, Vec2d{3, 0}}})
        world.create_shape(bin, {.geometry = size, .position = at, .material = material});
      std::vector<BodyId> discs;
      for (int k = 0; k < 8; ++k)
        discs.push_back(world.create_body(
            {.position = {-1.3 + 2.6 * static_cast<double>(random()) / 4294967296.0, -1 + 1.3 * k}},
            ShapeDefinition{.geometry = Circle{0.5}, .material = material}));
      run(world, 300);
      for (const BodyId disc : discs) {
        const auto bits = random();
        world.set_locks(disc, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0);
      }
      double fastest = 0;
      for (int i = 0; i < 120; ++i) {
        run(world, 1);
        for (const BodyId disc : discs) fastest = std::max(fastest, length(world.velocity(disc)));
      }
      EXPECT_LT(fastest, std::sqrt(2 * 10 * 4.0)) << "seed " << seed << ", friction " << friction;
    }
  }
}

}  // namespace
}  // namespace plumb
