#include "engine/world/solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/scene/error.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "tests/world/allocations.h"
#include "tests/world/golden.h"
#include "tests/world/solver_scenes.h"
#include "tests/world/threadings.h"
#include "tests/world/vector_widths.h"

// Checks each solver: closed forms of bodies in flight, in collision, on slopes and on stacks, and what the
// rest of the world makes of the impulses.
namespace plumb {
namespace {

using test::add_hook;
using test::add_mass;
using test::with;

class EachSolver : public testing::TestWithParam<Solver> {
 protected:
  bool flies_by_substeps() const { return GetParam() != Solver::SoftSteps && GetParam() != Solver::Direct; }
};
INSTANTIATE_TEST_SUITE_P(, EachSolver, test::all_solvers(), test::solver_name);

// Semi-implicit Euler falls g h t / 2 too far, exactly; soft steps fly on the parabola.
TEST_P(EachSolver, FallsFreely) {
  DoubleWorld world(with(GetParam()));
  const BodyId ball = add_body(world, {0, 0}, {.geometry = Circle{0.5}}, {2, 3});
  const double dt = 1.0 / 60, h = dt / 4;
  for (int i = 1; i <= 120; ++i) {
    world.step(dt, 4);
    const double t = i * dt, late = flies_by_substeps() ? kGravity * h * t / 2 : 0;
    ASSERT_NEAR(world.position(ball).y, 3 * t - kGravity * t * t / 2 - late, 1e-12);
    ASSERT_NEAR(world.position(ball).x, 2 * t, 1e-12);
    ASSERT_NEAR(world.velocity(ball).y, 3 - kGravity * t, 1e-12);
  }
}

TEST_P(EachSolver, HeadOnCollisionsKeepMomentumAndRestitution) {
  for (const double e : {0.0, 0.5, 1.0}) {
    DoubleWorld world(test::weightless(GetParam()));
    // Densities 1 and 3 of discs that are alike: masses m and 3 m.
    const ShapeDefinition light{.geometry = Circle{0.5}, .material = {.friction = 0, .restitution = e}};
    ShapeDefinition heavy = light;
    heavy.density = 3;
    const BodyId a = add_body(world, {-2, 0}, light, {4, 0}), b = add_body(world, {2, 0}, heavy, {-1, 0});
    run(world, 60);
    const double u = 4, v = -1, common = (u + 3 * v) / 4;
    EXPECT_NEAR(world.velocity(a).x, common - 0.75 * e * (u - v), 1e-12) << e;
    EXPECT_NEAR(world.velocity(b).x, common + 0.25 * e * (u - v), 1e-12) << e;
    EXPECT_NEAR(world.velocity(a).y, 0, 1e-12);
  }
}

// Known of the impact is the approach up to one step before: |v' - e v| <= (1 + e) g dt. It takes place
// within a step's way of the ground.
TEST_P(EachSolver, BallsBounceAtTheirRestitution) {
  const double dt = 1.0 / 240, e = 0.5, v = std::sqrt(2 * kGravity);
  DoubleWorld world(with(GetParam()));
  add_ground(world, {.restitution = e});
  const BodyId ball = add_body(world, {0, 1.5}, {.geometry = Circle{0.5}, .material = {.restitution = e}});
  double top = 0;
  const double impact = v / kGravity, again = impact * (1 + 2 * e);
  for (int i = 1; i * dt < again - 2 * dt; ++i) {
    world.step(dt);
    if (i * dt > impact + 2 * dt) top = std::max(top, world.position(ball).y - 0.5);
  }
  const double off = (1 + e) * kGravity * dt;
  EXPECT_GT(top, (e * v - off) * (e * v - off) / (2 * kGravity) - v * dt);
  EXPECT_LT(top, (e * v + off) * (e * v + off) / (2 * kGravity) + v * dt);
}

struct Slope {
  DoubleWorld world;
  BodyId box{};
  Vec2d downhill{};
};

Slope slope(Solver solver, double angle, double friction) {
  Slope s{DoubleWorld(with(solver))};
  s.downhill = {std::cos(angle), -std::sin(angle)};
  const Vec2d up{std::sin(angle), std::cos(angle)};
  s.world.create_body(
      {.type = BodyType::Static, .angle = -angle},
      ShapeDefinition{.geometry = Box{200, 2}, .position = {0, -1}, .material = {.friction = friction}});
  s.box = s.world.create_body({.position = 0.25 * up, .angle = -angle},
                              ShapeDefinition{.geometry = Box{1, 0.5}, .material = {.friction = friction}});
  return s;
}

TEST_P(EachSolver, ABoxOnASlopeSlidesOnlyBeyondTheAngleOfFriction) {
  const double angle = std::atan(0.5), sine = std::sin(angle), cosine = std::cos(angle);
  Slope held = slope(GetParam(), angle, 0.55);
  run(held.world, 300);
  // It settles by what it falls before the contact answers.
  EXPECT_NEAR(dot(held.world.position(held.box), held.downhill), 0, 5e-4);
  EXPECT_NEAR(dot(held.world.velocity(held.box), held.downhill), 0, 1e-6);

  const double mu = 0.4, acceleration = kGravity * (sine - mu * cosine);
  Slope slides = slope(GetParam(), angle, mu);
  run(slides.world, 120);
  // Friction may come a substep late.
  const double late = mu * kGravity * cosine / 240;
  EXPECT_NEAR(dot(slides.world.velocity(slides.box), slides.downhill), 2 * acceleration, late);
  // Semi-implicit: x = a t (t + h) / 2; XPBD moves bodies before friction has slowed them, by h mu g cos t.
  EXPECT_NEAR(dot(slides.world.position(slides.box), slides.downhill), 2 * acceleration, 2.5 * late);
}

// One sweep over a stack of n passes on half of each overlap; what is left at the k-th contact from the top
// is at most k g h^2.
TEST_P(EachSolver, AStackOfFiveStands) {
  World world(with(GetParam()));
  add_ground(world);
  std::vector<BodyId> boxes;
  for (int i = 0; i < 5; ++i) boxes.push_back(add_box(world, {0, 0.5 + i}));
  run(world, 600);
  const double h = 1.0 / 240, sunk = kGravity * h * h * 15;
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(world.position(boxes[i]).y, 0.5 + i, sunk) << i;
    EXPECT_NEAR(world.position(boxes[i]).x, 0, 1e-5) << i;
    EXPECT_NEAR(world.angle(boxes[i]), 0, 1e-5) << i;
    EXPECT_NEAR(world.velocity(boxes[i]).y, 0, 1e-6) << i;
  }
  EXPECT_EQ(world.counts().touching, 5);
}

// A rod of 1 m that is let go level: T = 1.18034059901610 T0 at 90 degrees, T0 = 2 pi sqrt(2 L / (3 g)).
// Euler's half kick shifts time by h / 2.
TEST_P(EachSolver, APendulumHasItsPeriod) {
  const double dt = 1.0 / 240, h = dt / 4;
  DoubleWorld world(with(GetParam()));
  const BodyId rod = add_mass(world, {0.5, 0}, 1, 1.0 / 12);
  world.create_joint(add_hook(world), rod, {.kind = RevoluteDefinition{.anchor_b = {-0.5, 0}}});
  double before = 0;
  int i = 0;
  while (world.centre(rod).x > 0 && i < 1000) {
    before = world.centre(rod).x;
    world.step(dt);
    ++i;
  }
  const double passed = dt * (i - world.centre(rod).x / (world.centre(rod).x - before));
  const double period = 1.18034059901610 * 2 * test::kPi * std::sqrt(2 / (3 * kGravity));
  EXPECT_NEAR(passed, period / 4, h);
}

TEST_P(EachSolver, LockedAxesStayWhereTheyAre) {
  World world(with(GetParam()));
  add_ground(world);
  const BodyId box =
      world.create_body({.position = {0, 0.5}, .lock_x = true}, ShapeDefinition{.geometry = Box{1, 1}});
  add_body(world, {-3, 0.5}, {.geometry = Box{1, 1}, .material = {.friction = 0}}, {5, 0});
  const BodyId hung = world.create_body(
      {.position = {5, 5}, .mass = MassProperties{.mass = 1, .inertia = 1}, .lock_x = true});
  const BodyId weight = add_mass(world, {6, 5}, 1, 1);
  world.create_joint(hung, weight, {.kind = DistanceDefinition{.length = 1}});
  run(world, 120);
  EXPECT_EQ(world.position(box).x, 0);
  EXPECT_EQ(world.position(hung).x, 5);
}

TEST_P(EachSolver, HitsTellTheSpeedOfTheImpact) {
  World world(test::weightless(GetParam()));
  add_ground(world);
  add_body(world, {0, 2}, {.geometry = Circle{0.5}, .hit_events = true}, {0, -6});
  std::vector<double> speeds;
  for (int i = 0; i < 60; ++i) {
    world.step();
    for (const HitEvent& hit : world.events().hits) speeds.push_back(hit.speed);
  }
  ASSERT_EQ(speeds.size(), 1u);
  EXPECT_NEAR(speeds[0], 6, 1e-5);
}

TEST_P(EachSolver, EventsBeginAndEnd) {
  World world(with(GetParam()));
  add_ground(world, {.restitution = 0.5});
  add_body(world, {0, 1.5}, {.geometry = Circle{0.5}, .material = {.restitution = 0.5}});
  int begun = 0, ended = 0;
  for (int i = 0; i < 50; ++i) {
    world.step();
    begun += static_cast<int>(world.events().begin.size());
    ended += static_cast<int>(world.events().end.size());
  }
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(ended, 1);
}

TEST_P(EachSolver, FastBodiesDoNotTunnel) {
  World world(test::weightless(GetParam()));
  world.create_body({.type = BodyType::Static}, ShapeDefinition{.geometry = Segment{{0, -5}, {0, 5}}});
  const BodyId bullet = add_body(world, {-10, 0}, {.geometry = Circle{0.05}}, {500, 0});
  run(world, 60);
  EXPECT_LT(world.position(bullet).x, 0);
}

TEST_P(EachSolver, StacksFallAsleepAndWake) {
  World world({.solver = GetParam()});
  add_ground(world);
  for (int i = 0; i < 5; ++i) add_box(world, {0, 0.5 + i});
  run(world, 120);
  EXPECT_EQ(world.counts().awake, 0);
  add_box(world, {0, 6});
  run(world, 40);
  EXPECT_EQ(world.counts().awake, 6);
}

// A hook bears the weight: its reaction is m g over the last substep.
TEST_P(EachSolver, JointsTellTheirForceAndBreakByIt) {
  DoubleWorld world(with(GetParam()));
  const BodyId hook = add_hook(world), weight = add_mass(world, {0, -1}, 2, 1);
  const JointDefinition rope{.kind = DistanceDefinition{.length = 1}, .break_force = 1.5 * 2 * kGravity};
  const JointId joint = world.create_joint(hook, weight, rope);
  run(world, 240);
  ASSERT_TRUE(world.valid(joint));
  EXPECT_NEAR(world.read(joint).force, 2 * kGravity, 1e-6 * 2 * kGravity);
  world.apply_force(weight, {0, -2 * kGravity});
  world.step();
  EXPECT_FALSE(world.valid(joint));
  EXPECT_EQ(world.events().broken.size(), 1u);
}

void add_mixed_scene(World& world) {
  add_ground(world);
  for (int i = 0; i < 12; ++i) {
    add_body(world, {-1.5 + 0.7 * (i % 4) + 0.1 * (i / 4), 0.6 + 0.9 * (i / 4)},
             {.geometry = i % 2 == 0 ? ShapeGeometry(Box{0.6, 0.6}) : ShapeGeometry(Circle{0.3})});
  }
  test::add_chain(world, 6, 5);
  const BodyId wheel = add_body(world, {3, 0.4}, {.geometry = Circle{0.4}});
  const BodyId car = add_box(world, {3, 1}, 1, 1, 0.4);
  world.create_joint(
      car, wheel,
      {.kind = WheelDefinition{.anchor_a = {0, -0.6}, .spring = Spring{4, 0.7}, .motor = Motor{-10, 5}}});
}

TEST_P(EachSolver, StepsDoNotAllocateOnceWarm) {
  World world(with(GetParam()));
  add_ground(world);
  for (int i = 0; i < 5; ++i) add_box(world, {0, 0.5 + i});
  test::add_chain(world, 6, 5);
  run(world, 60);
  const long before = test::allocations();
  run(world, 100);
  EXPECT_EQ(test::allocations() - before, 0);
}

TEST_P(EachSolver, SnapshotsGoOnWithTheSameBits) {
  World world(with(GetParam(), 7));
  add_mixed_scene(world);
  run(world, 60);
  const std::vector<std::byte> bytes = save(world);
  World other;
  restore(other, bytes);
  EXPECT_EQ(other.solver(), GetParam());
  EXPECT_EQ(other.iterations(), 7);
  run(world, 60), run(other, 60);
  EXPECT_EQ(full_hash(world), full_hash(other));
}

TEST(Solvers, MayChangeWhileTheWorldRuns) {
  World world(with(Solver::SoftSteps));
  add_ground(world);
  std::vector<BodyId> boxes;
  for (int i = 0; i < 4; ++i) boxes.push_back(add_box(world, {0, 0.5 + i}));
  const BodyId weight = add_mass(world, {5, 4}, 3, 1);
  const JointId rope =
      world.create_joint(add_hook(world, {5, 5}), weight, {.kind = DistanceDefinition{.length = 1}});
  // That of a stack one higher (see above), for the swing when the solver changes.
  const double h = 1.0 / 240, sunk = kGravity * h * h * 15;
  for (int turn = 0; turn < 25; ++turn) {
    world.set_solver(static_cast<Solver>(turn * 2 % 5));
    for (int i = 0; i < 20; ++i) {
      world.step();
      ASSERT_NEAR(world.position(boxes[3]).y, 3.5, sunk) << turn;
      ASSERT_NEAR(world.read(rope).length, 1, sunk) << turn;
      ASSERT_NEAR(world.read(rope).force, 3 * kGravity, 1e-3 * 3 * kGravity) << turn << ' ' << i;
    }
  }
}

TEST(Solvers, AreChecked) {
  EXPECT_THROW(World({.iterations = 0}), Error);
  EXPECT_THROW(World({.solver = static_cast<Solver>(9)}), Error);
  World world;
  try {
    world.set_iterations(1001);
    ADD_FAILURE() << "1001 sweeps were taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("iterations"), std::string::npos) << error.what();
  }
  EXPECT_THROW(world.set_solver(static_cast<Solver>(5)), Error);
  EXPECT_EQ(world.iterations(), 10);
  EXPECT_EQ(world.solver(), Solver::SoftSteps);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(solver_of(name_of(static_cast<Solver>(i))), static_cast<Solver>(i));
  EXPECT_EQ(solver_of("soft"), std::nullopt);
}

TEST(Solvers, EachHasOneHashEverywhere) {
  for (int i = 0; i < 5; ++i) {
    test::at_each_vector_width([&](VectorWidth) {
      World world(with(static_cast<Solver>(i)));
      add_mixed_scene(world);
      run(world, 200);
      test::expect_golden(name_of(static_cast<Solver>(i)), world.hash());
    });
  }
}

TEST(Solvers, EachHasOneHashEverywhereForEachNumberOfThreads) {
  for (int i = 0; i < 5; ++i) {
    test::at_each_threading<float>([&](const auto& set) {
      World world(with(static_cast<Solver>(i)));
      set(world);
      add_mixed_scene(world);
      run(world, 200);
      test::expect_golden(name_of(static_cast<Solver>(i)), world.hash());
    });
  }
}

}  // namespace
}  // namespace plumb
