#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "tests/simulation/scenes.h"

namespace plumb {
namespace {

using namespace plumb::testing;

constexpr double kSlope = 0.4;  // rad

/// How far body 1 has gone down the slope, and away from it.
Vec2d way(const Simulation& world, Vec2d start) {
  const Vec2d d = world.state(1).position - start;
  return {d.x * std::cos(kSlope) - d.y * std::sin(kSlope), d.x * std::sin(kSlope) + d.y * std::cos(kSlope)};
}

Vec2d on_slope(double height) { return {height * std::sin(kSlope), height * std::cos(kSlope)}; }

// Slips iff tan(theta) > mu, then with g (sin - mu cos).
TEST(Contacts, BlockOnARamp) {
  for (const double mu : {0.0, 0.1, 0.3, 0.42, 0.43, 1.0}) {
    Body block = box("block", on_slope(0.5), 1, 1, mu);
    block.angle = -kSlope;
    Simulation world = compile(with(empty_scene(), {plane(mu, 0, -kSlope), block}));
    world.step(120);
    const bool slips = std::tan(kSlope) > mu;
    const double acceleration = slips ? kGravity * (std::sin(kSlope) - mu * std::cos(kSlope)) : 0;
    EXPECT_NEAR(way(world, on_slope(0.5)).x, acceleration * 2 * 2 / 2, 1e-11) << mu;
    EXPECT_NEAR(way(world, on_slope(0.5)).y, 0, 1e-12) << mu;
    EXPECT_NEAR(world.state(1).angular_velocity, 0, 1e-12) << mu;
  }
}

// Rolls iff mu >= tan(theta)/3, then with (2/3) g sin; else slides with g (sin - mu cos).
TEST(Contacts, DiscOnARamp) {
  for (const double mu : {0.05, 0.13, 0.15, 0.6}) {
    Simulation world =
        compile(with(empty_scene(), {plane(mu, 0, -kSlope), disc("disc", on_slope(0.5), 0.5, mu)}));
    world.step(120);
    const bool rolls = mu >= std::tan(kSlope) / 3;
    const double acceleration =
        rolls ? kGravity * std::sin(kSlope) * 2 / 3 : kGravity * (std::sin(kSlope) - mu * std::cos(kSlope));
    EXPECT_NEAR(way(world, on_slope(0.5)).x, acceleration * 2, 1e-11) << mu;
    const double turning = rolls ? acceleration / 0.5 : 2 * mu * kGravity * std::cos(kSlope) / 0.5;
    EXPECT_NEAR(world.state(1).angle, -turning * 2, 1e-10) << mu;
  }
}

// A sliding disc rolls after v0/(3 mu g), then with 2 v0/3. The change falls inside a substep: one error of
// h^2.
TEST(Contacts, SlidingDiscComesToRoll) {
  Body ball = disc("disc", {0, 0.5}, 0.5, 0.2);
  ball.velocity = {5, 0};
  Simulation world = compile(with(empty_scene(), {plane(0.2), ball}));
  world.step(120);
  const double rolling_from = 5 / (3 * 0.2 * kGravity), distance = 5 * 25 / (18 * 0.2 * kGravity);
  EXPECT_NEAR(world.state(1).velocity.x, 10.0 / 3, 1e-13);
  EXPECT_NEAR(world.state(1).angular_velocity, -20.0 / 3, 3e-13);
  EXPECT_NEAR(world.state(1).position.x, distance + (2 - rolling_from) * 10 / 3, 2e-5);
}

TEST(Contacts, BoxesRestWhateverTheirSize) {
  for (const double size : {1e-3, 1.0, 1e3}) {
    Simulation world = compile(with(empty_scene(), {plane(), box("box", {0, size / 2}, size, size)}));
    world.step(120);
    EXPECT_NEAR(world.state(1).position.y / size, 0.5, 1e-12) << size;
    EXPECT_NEAR(world.state(1).position.x / size, 0, 1e-5) << size;
    EXPECT_NEAR(world.state(1).velocity.y, 0, 1e-14) << size;
  }
}

TEST(Contacts, RestitutionDoesNotShakeWhatRests) {
  Simulation world = compile(with(empty_scene(), {plane(0.5, 1), box("box", {0, 0.5}, 1, 1, 0.5, 1),
                                                  disc("disc", {3, 0.5}, 0.5, 0.5, 1)}));
  for (int i = 0; i < 120; ++i) {
    world.step();
    EXPECT_NEAR(world.state(1).position.y, 0.5, 1e-13);
    EXPECT_NEAR(world.state(2).position.y, 0.5, 1e-13);
  }
}

// Ten boxes for ten seconds. Measured: the top moves 2.7 mm aside and sinks 0.9 mm within the first second,
// while the sweeps converge, then creeps by less than 0.1 mm a second and ends at 1.3 mm/s.
TEST(Contacts, StackOfTenStandsStill) {
  Scene scene = with(empty_scene(), {plane()});
  for (int i = 0; i < 10; ++i) scene.bodies.push_back(box("box " + std::to_string(i), {0, i + 0.5}, 1, 1));
  Simulation world = compile(scene);
  for (int second = 1; second <= 10; ++second) {
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
      world.step();
      for (std::size_t body = 1; body <= 10; ++body)
        fastest = std::fmax(fastest, std::sqrt(length_squared(world.state(body).velocity)));
    }
    EXPECT_LT(fastest, second == 1 ? 0.1 : 0.015) << second;
  }
  EXPECT_NEAR(world.state(10).position.y, 9.5, 5e-5);
  EXPECT_NEAR(world.state(10).position.x, 0, 6e-3);
  EXPECT_NEAR(world.state(10).angle, 0, 3e-3);
}

// Sequential impulses converge by 1 - 1/ratio a sweep: at 30 the light box gives by 0.9 mm before it bears.
TEST(Contacts, HeavyBoxOnALightOneIsBorne) {
  for (const double ratio : {3.0, 10.0, 30.0}) {
    Scene scene = with(empty_scene(), {plane(), box("light", {0, 0.5}, 1, 1), box("heavy", {0, 1.5}, 1, 1)});
    scene.bodies[2].mass = ratio;
    Simulation world = compile(scene);
    double lowest = 1.5;
    for (int i = 0; i < 600; ++i) world.step(), lowest = std::fmin(lowest, world.state(2).position.y);
    EXPECT_GT(lowest, 1.5 - 2e-3) << ratio;
    EXPECT_NEAR(world.state(2).position.y, 1.5, 2e-6) << ratio;
  }
}

TEST(Contacts, OverlapIsPushedOutWithoutSpeed) {
  Scene scene = with(empty_scene({0, 0}), {disc("a", {0, 0}, 0.5), disc("b", {0.7, 0}, 0.5)});
  Simulation world = compile(scene);
  double fastest = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    fastest = std::fmax(fastest, std::abs(world.state(0).velocity.x));
  }
  EXPECT_EQ(fastest, 0);
  EXPECT_NEAR(world.state(1).position.x - world.state(0).position.x, 1, 1e-9);
}

TEST(Contacts, FiltersAndJointsKeepPairsApart) {
  Scene scene = with(empty_scene(), {plane(), disc("a", {0, 3}), disc("b", {0.2, 3}), disc("c", {5, 3})});
  scene.bodies[3].shapes[0].filter.mask = 0;
  scene.joints = {DistanceJoint{"bar", "a", "b", {}, {}, 0.2}};
  Simulation world = compile(scene);
  world.step(120);
  EXPECT_NEAR(world.state(2).position.x - world.state(1).position.x, 0.2, 0.2) << "they may overlap";
  EXPECT_NEAR(length_squared(world.state(2).position - world.state(1).position), 0.04, 1e-9);
  EXPECT_NEAR(world.state(3).position.y, 3 - kGravity * 2 * 2 / 2, 1e-11) << "it falls through the plane";
}

// Shapes off the centre and turned in the body: a box that is made of two halves rests as one.
TEST(Contacts, ShapesHaveTheirPlaceInTheBody) {
  Body two = box("two", {0, 0.5}, 1, 1);
  two.shapes = {Shape{Box{1, 0.5}, {-0.25, 0}, 1.5707963267948966}, Shape{Box{0.5, 1}, {0.25, 0}}};
  two.inertia = 1.0 / 6;
  Simulation world = compile(with(empty_scene(), {plane(), two}));
  world.step(60);
  EXPECT_NEAR(world.state(1).position.y, 0.5, 1e-9);
  EXPECT_NEAR(world.state(1).angle, 0, 1e-9);
}

// A crate on a lift that rises; and one on a conveyor that carries it along: both kinematic.
TEST(Contacts, KinematicBodiesCarry) {
  Body lift = box("lift", {0, -0.5}, 10, 1, 0.8);
  lift.type = BodyType::Kinematic;
  lift.velocity = {0.5, 1};
  Body crate = box("crate", {0, 0.5}, 1, 1, 0.8);
  crate.velocity = {0.5, 1};
  Simulation world = compile(with(empty_scene(), {lift, crate}));
  world.step(120);
  EXPECT_NEAR(world.state(1).position.x, 1, 1e-6);
  EXPECT_NEAR(world.state(1).position.y, 2.5, 1e-10);
}

/// CPU time of the first steps of a load that rests on a box of 1 kg, where a step has many substeps.
std::clock_t time_of_steps(double load) {
  Body below = box("below", {0, 0.5}, 1, 1), above = box("above", {0, 1.5}, 1, 1);
  below.mass = 1, above.mass = load;
  Simulation world = compile(with(empty_scene({0, -2e7}), {plane(0.5, 0, 0), below, above}),
                             Realtime{.on_doubt = OnDoubt::Report});
  EXPECT_EQ(world.plan().substeps, 1000);
  const std::clock_t start = std::clock();
  world.step(3);
  return std::clock() - start;
}

// Sweeps for a heavy load: 2000 a pass would cost 12 times as much as the 4 that are asked for; shared by
// 1000 substeps they are 32, and a step costs 1.06 times as much.
TEST(Contacts, AStepOfManySubstepsSharesTheSweepsForALoad) {
  EXPECT_LT(time_of_steps(1e9), 4 * time_of_steps(10));
}

}  // namespace
}  // namespace plumb
