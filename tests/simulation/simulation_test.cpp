#include "engine/simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "engine/scene/error.h"
#include "tests/simulation/scenes.h"
#include "tests/world/golden.h"

namespace plumb {
namespace {

using namespace plumb::testing;

std::vector<Realtime> kinds() {
  std::vector<Realtime> out;
  for (const Precision precision : {Precision::Float, Precision::Double})
    for (const Solver solver : {Solver::SoftSteps, Solver::Direct, Solver::Xpbd})
      for (const Integrator integrator :
           {Integrator::VelocityVerlet, Integrator::SemiImplicitEuler, Integrator::ExplicitEuler})
        out.push_back({.precision = precision,
                       .integrator = integrator,
                       .solver = solver,
                       .on_violation = OnViolation::Report});
  return out;
}

TEST(Simulation, SameRunSameHash) {
  for (const Realtime& accuracy : kinds()) {
    Simulation a = compile(pile(27, 0.5), accuracy), b = compile(pile(27, 0.5), accuracy);
    EXPECT_EQ(a.hash(), b.hash());
    const std::uint64_t start = a.hash();
    a.step(100);
    b.step(60);
    b.step(40);
    EXPECT_EQ(a.hash(), b.hash());
    EXPECT_NE(a.hash(), start);
  }
}

TEST(Simulation, RestoredRunsGoOnWithTheSameBits) {
  for (const double restitution : {0.0, 0.5}) {
    for (const Realtime& accuracy : kinds()) {
      Simulation world = compile(pile(27, restitution), accuracy),
                 other = compile(pile(27, restitution), accuracy);
      for (const int steps : {0, 1, 50, 31}) {
        world.step(steps);
        const std::vector<std::byte> snapshot = world.save();
        other.restore(snapshot);  // once into a fresh world, later into one that has gone elsewhere
        EXPECT_EQ(other.hash(), world.hash());
        EXPECT_EQ(other.save(), snapshot);
        Simulation third = compile(pile(27, restitution), accuracy);
        third.restore(snapshot);
        world.step(40);
        other.step(40);
        third.step(40);
        EXPECT_EQ(other.hash(), world.hash());
        EXPECT_EQ(third.hash(), world.hash());
        other.step(17);
      }
    }
  }
}

void expect_refused(Simulation& world, std::span<const std::byte> snapshot) {
  const std::uint64_t before = world.hash();
  const std::vector<std::byte> saved = world.save();
  try {
    world.restore(snapshot);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
  }
  EXPECT_EQ(world.hash(), before);
  EXPECT_EQ(world.save(), saved);
}

TEST(Simulation, ASnapshotGoesOnWithAnotherNumberOfThreads) {
  Simulation one = compile(pile(9, 0)), two = compile(pile(9, 0), Realtime{.threads = 2});
  one.step(20);
  two.restore(one.save());
  one.step(20), two.step(20);
  EXPECT_EQ(one.hash(), two.hash());
}

TEST(Simulation, ForeignSnapshotsAreRefused) {
  Simulation world = compile(pile(9, 0));
  world.step(30);
  Simulation other_scene = compile(pile(10, 0)),
             other_accuracy = compile(pile(9, 0), Realtime{.substeps = 3}),
             other_precision = compile(pile(9, 0), Realtime{.precision = Precision::Float});
  for (Simulation* other : {&other_scene, &other_accuracy, &other_precision})
    expect_refused(world, other->save());
}

TEST(Simulation, DamagedSnapshotsAreRefused) {
  Simulation world = compile(pile(9, 0));
  world.step(30);
  const std::vector<std::byte> good = world.save();
  world.step(10);
  for (std::size_t length = 0; length < good.size(); length += 1 + length / 7)
    expect_refused(world, std::span(good).first(length));
  std::vector<std::byte> longer = good;
  longer.push_back({});
  expect_refused(world, longer);
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::byte> bytes = good;
    bytes[random() % bytes.size()] ^= static_cast<std::byte>(1 + random() % 255);
    expect_refused(world, bytes);
  }
  std::vector<std::byte> noise(good.size());
  for (std::byte& byte : noise) byte = static_cast<std::byte>(random());
  expect_refused(world, noise);
  world.restore(good);
}

TEST(Simulation, SetStateMovesABodyAndWakesItsSurroundings) {
  Simulation world =
      compile(with(empty_scene(), {plane(), box("a", {0, 0.5}, 1, 1), box("b", {0, 1.5}, 1, 1)}));
  world.step(60);
  world.set_state(1, {{50, 10}, 0.3, {1, 0}, 2});
  EXPECT_EQ(world.state(1).position, (Vec2d{50, 10}));
  world.step(60);
  EXPECT_NEAR(world.state(1).position.x, 51, 1e-9);
  EXPECT_NEAR(world.state(2).position.y, 0.5, 2e-2) << "what stood on it has fallen";
  world.set_state(0, {{0, -100}, 0, {}, 0});
  world.step(60);
  EXPECT_LT(world.state(2).position.y, -3) << "the ground is gone";
}

TEST(Simulation, AStateThatWasReadLeavesTheBodyWhereItIsWhenSet) {
  constexpr double kNear = 1e-6;  // m, rounding of a float's rotation
  Scene scene;
  for (const BodyType type : {BodyType::Static, BodyType::Kinematic})
    scene.bodies.push_back({.name = type == BodyType::Static ? "wall" : "lift",
                            .type = type,
                            .position = {-6, -0.5},
                            .angle = 0.3,
                            .shapes = {{.geometry = Box{1, 1}, .position = {1, 0}}}});
  for (const Realtime& accuracy : kinds()) {
    Simulation world = compile(scene, accuracy);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      EXPECT_NEAR(world.state(i).position.x, -6, kNear);
      EXPECT_NEAR(world.state(i).position.y, -0.5, kNear);
      world.set_state(i, world.state(i));
      EXPECT_NEAR(world.state(i).position.x, -6, kNear);
      EXPECT_NEAR(world.state(i).position.y, -0.5, kNear);
    }
  }
}

TEST(Simulation, WrongUseIsRefused) {
  Simulation world = compile(with(empty_scene(), {disc("a", {0, 0})}));
  EXPECT_THROW(world.state(1), Error);
  EXPECT_THROW(world.set_state(1, {}), Error);
  EXPECT_THROW(world.set_state(0, {{std::numeric_limits<double>::quiet_NaN(), 0}}), Error);
  std::vector<BodyState> two(2);
  EXPECT_THROW(world.read(two), Error);
  EXPECT_EQ(world.state(0).position, (Vec2d{0, 0}));
}

// Explicit Euler with a stiff drag explodes; the run stops before the first state that is not finite.
TEST(Simulation, NoStateThatIsNotFiniteLeaves) {
  Scene scene = with(empty_scene({0, 0}), {disc("calm", {9, 0}), disc("wild", {0, 0})});
  scene.forces = {QuadraticDrag{"wild", 1e6}};
  scene.bodies[1].velocity = {10, 0};
  Simulation world = compile(scene, with_integrator(Integrator::ExplicitEuler));
  try {
    world.step(1000);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run);
    EXPECT_EQ(error.subject(), "body 'wild'");
    EXPECT_NE(error.problem().find("step"), std::string::npos);
  }
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(std::isfinite(world.state(i).position.x));
  EXPECT_THROW(world.step(), Error);
  world.set_state(1, {});
  EXPECT_NO_THROW(world.step());
}

TEST(Simulation, EmptySceneSteps) {
  Simulation world = compile(empty_scene());
  world.step(3);
  EXPECT_EQ(world.body_count(), 0u);
  EXPECT_EQ(world.time(), 3 * (1.0 / 60));
}

TEST(Simulation, StatisticsCount) {
  Simulation world = compile(with(empty_scene(), {plane(0, 1), disc("ball", {0, 1}, 0.5, 0, 1)}));
  world.step(60);
  EXPECT_EQ(world.statistics().steps, 240);
}

// The same bits with g++ 12 -O0, -O2, -O3 and clang++ 16 -O0, -O3.
TEST(Simulation, APileHasOneHashEverywhere) {
  const struct {
    const char* name;
    Precision precision;
    Solver solver;
    double restitution;
  } table[] = {
      {"pile", Precision::Double, Solver::SoftSteps, 0.0},
      {"pile_bounces", Precision::Double, Solver::SoftSteps, 0.5},
      {"pile_direct", Precision::Double, Solver::Direct, 0.5},
      {"pile_float", Precision::Float, Solver::SoftSteps, 0.0},
      {"pile_float_bounces", Precision::Float, Solver::SoftSteps, 0.5},
      {"pile_float_direct", Precision::Float, Solver::Direct, 0.5},
  };
  for (const auto& row : table) {
    Simulation world =
        compile(pile(90, row.restitution), Realtime{.precision = row.precision, .solver = row.solver});
    world.step(300);
    test::expect_golden(row.name, world.hash());
  }
}

}  // namespace
}  // namespace plumb
