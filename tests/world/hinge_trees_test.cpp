#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/math/trigonometry.h"
#include "engine/world/snapshot.h"
#include "engine/world/world_data.h"
#include "tests/world/solver_scenes.h"

// Mechanisms of hinges, that are moved as such.
namespace plumb {
namespace {

using test::add_chain;
using test::add_hook;
using test::add_mass;
using test::with;

template <class Real>
class HingeTrees : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(HingeTrees, Reals);

constexpr Vec2d kEnd{0.5, 0};

template <class Real>
double energy_of(const BasicWorld<Real>& world, const std::vector<BodyId>& bodies) {
  double sum = 0;
  for (const BodyId body : bodies) {
    const double m = world.mass(body), spin = world.angular_velocity(body);
    sum += 0.5 * m * length_squared(world.velocity(body)) + 0.5 * world.inertia(body) * spin * spin +
           m * kGravity * world.position(body).y;
  }
  return sum;
}

struct Swing {
  double energy = 0;               // the most that it is off by, of m g L / 2 (1 - cos)
  double gap = 0;                  // m
  double lowest = 0, highest = 0;  // rad
};

// A rod of 1 m and 1 kg on a hook, from `angle` above straight down.
template <class Real>
Swing swing(double angle, double dt, int steps, Vec2d hook = {}, Solver solver = Solver::SoftSteps) {
  BasicWorld<Real> world(with(solver));
  const double start = angle - test::kPi / 2;
  const BodyId rod = add_mass(world, hook + 0.5 * Vec2d{std::sin(angle), -std::cos(angle)}, 1, 1.0 / 12);
  world.set_position(rod, world.position(rod), start);
  world.create_joint(add_hook(world), rod, {.kind = RevoluteDefinition{.anchor_a = hook, .anchor_b = -kEnd}});
  const double at_start = energy_of(world, {rod}), scale = 0.5 * kGravity * (1 - std::cos(angle));
  Swing out{.lowest = start, .highest = start};
  for (int i = 0; i < steps; ++i) {
    world.step(dt, 4);
    const Vec2d open = (world.position(rod) - hook) - rotation_of(world.angle(rod)) * kEnd;
    out.gap = std::max(out.gap, std::hypot(open.x, open.y));
    out.energy = std::max(out.energy, std::abs(energy_of(world, {rod}) - at_start) / scale);
    out.lowest = std::min(out.lowest, world.angle(rod));
    out.highest = std::max(out.highest, world.angle(rod));
  }
  return out;
}

// The energy of a symmetric method of second order comes and goes by some share of (h w)^2, with h the
// substep and w^2 = 3 g / (2 L), and is not used up: a third of it in this swing. Floats add the rounding of
// a velocity a step, 3e-8, in 10,000 steps at random.
TYPED_TEST(HingeTrees, APendulumKeepsItsEnergy) {
  const double turn = std::sqrt(1.5 * kGravity) / 240;
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
    const Swing out = swing<TypeParam>(test::kPi / 2, 1.0 / 60, 10'000, {}, solver);
    EXPECT_LT(out.energy, turn * turn / 2);
    EXPECT_LT(out.gap, sizeof(TypeParam) == 4 ? 3e-8 : 1e-11);
  }
}

// A static hook that is disabled for a step and enabled again holds two rods as before: joints are closed,
// and the energy comes and goes by a share of (h w)^2 as above. w is at most the frequency of the faster
// mode, 1.5 sqrt(3 g / L), and 2 m g L what the rods may exchange.
TYPED_TEST(HingeTrees, AHookThatWasDisabledHoldsItsMechanism) {
  BasicWorld<TypeParam> world(with(Solver::Direct));
  const test::Chain chain = test::add_chain(world, 2);
  const BodyId hook = world.bodies(chain.joints[0]).first;
  world.step(1.0 / 60, 4);
  world.set_enabled(hook, false);
  world.step(1.0 / 60, 4);
  EXPECT_EQ(world.data().scratch.islands.trees.hinge_count, 1);
  world.set_enabled(hook, true);
  for (int i = 0; i < 2; ++i) {
    world.set_position(chain.links[i], {i + 0.5, 0}, 0);
    world.set_velocity(chain.links[i], {}), world.set_angular_velocity(chain.links[i], 0);
  }
  const double start = energy_of(world, chain.links);
  double off = 0;
  for (int i = 0; i < 600; ++i) {
    world.step(1.0 / 60, 4);
    off = std::max(off, std::abs(energy_of(world, chain.links) - start));
  }
  EXPECT_EQ(world.data().scratch.islands.trees.hinge_count, 2);
  const double turn = 1.5 * std::sqrt(3 * kGravity) / 240;
  EXPECT_LT(off, turn * turn * 2 * kGravity);
  EXPECT_LT(test::worst_gap(world, chain.joints), sizeof(TypeParam) == 4 ? 3e-7 : 1e-11);
}

// Substeps of more than an eighth of a rad are made smaller: it comes and goes by up to half of the square of
// that, and the rod swings as wide as ever.
TYPED_TEST(HingeTrees, LongStepsDoNotFreezeAPendulum) {
  for (const double dt : {0.05, 0.2, 1.0}) {
    const Swing out = swing<TypeParam>(test::kPi / 3, dt, 200);
    EXPECT_LT(out.energy, 0.125 * 0.125 / 2) << dt;
    EXPECT_LT(out.lowest, -test::kPi / 2 - 0.95 * test::kPi / 3) << dt;
    EXPECT_GT(out.highest, -test::kPi / 2 + 0.95 * test::kPi / 3) << dt;
  }
}

// Coordinates there are 1.2e-7 m apart.
TYPED_TEST(HingeTrees, APendulumSwingsAMillionKilometresAway) {
  const Swing out = swing<TypeParam>(test::kPi / 3, 1.0 / 60, 300, {1e9, 1e9});
  EXPECT_LT(out.gap, 3e-7);
  EXPECT_LT(out.energy, 1e-3);
}

// The load swings as on a rod without mass: the beam turns by a'' = -(M - m) g cos(a) / (I + M + m), here by
// Runge and Kutta's method.
TYPED_TEST(HingeTrees, ALeverHoldsAnyLoad) {
  for (const double load : {10.0, 1e5, 1e9}) {
    BasicWorld<TypeParam> world(with(Solver::SoftSteps));
    const BodyId hook = add_hook(world), beam = add_mass(world, {0, 0}, 1, 1.0 / 3);
    const BodyId heavy = add_mass(world, {-1, 0}, load, 0.02 * load),
                 light = add_mass(world, {1, 0}, 1, 0.02);
    world.create_joint(hook, beam, {.kind = RevoluteDefinition{}});
    world.create_joint(beam, heavy, {.kind = RevoluteDefinition{.anchor_a = {-1, 0}}});
    world.create_joint(light, beam, {.kind = RevoluteDefinition{.anchor_b = {1, 0}}});
    const long double k = (load - 1) * kGravity / (1.0L / 3 + load + 1);
    long double angle = 0, rate = 0;
    const auto f = [k](long double a) { return k * std::cos(a); };
    double off = 0, gap = 0;
    for (int i = 0; i < 120; ++i) {
      world.step(1.0 / 60, 4);
      for (int j = 0; j < 10; ++j) {
        const long double h = 1.0L / 600;
        const long double k1 = f(angle), k2 = f(angle + h / 2 * rate),
                          k3 = f(angle + h / 2 * rate + h * h / 4 * k1),
                          k4 = f(angle + h * rate + h * h / 2 * k2);
        angle += h * rate + h * h / 6 * (k1 + k2 + k3), rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      }
      off = std::max(off, std::abs(world.angle(beam) - static_cast<double>(angle)));
      const Vec2d arm = rotation_of(world.angle(beam)) * Vec2d{1, 0};
      for (const Vec2d open : {world.position(heavy) + arm, world.position(light) - arm})
        gap = std::max(gap, std::hypot(open.x, open.y));
    }
    EXPECT_LT(off, 1.5e-3) << load;
    EXPECT_LT(gap, 1e-6) << load;
  }
}

// A hub with arms of two rods each, that flies and spins: momentum, angular momentum and energy stay.
TYPED_TEST(HingeTrees, AFreeTreeKeepsWhatItHas) {
  BasicWorld<TypeParam> world(test::weightless(Solver::Direct));
  std::vector<BodyId> bodies{add_mass(world, {0, 0}, 3, 0.5, {0.3, 0.1})};
  for (int arm = 0; arm < 5; ++arm) {
    const double angle = 2 * test::kPi * arm / 5;
    const Vec2d along{std::cos(angle), std::sin(angle)};
    BodyId before = bodies[0];
    for (int i = 0; i < 2; ++i) {
      const BodyId rod = add_mass(world, (i + 0.7) * along, 1, 1.0 / 12, {0.3, 0.1});
      world.set_position(rod, world.position(rod), angle);
      world.set_angular_velocity(rod, arm - 1.5 * i);
      world.create_joint(
          before, rod,
          {.kind = RevoluteDefinition{.anchor_a = i == 0 ? 0.2 * along : kEnd, .anchor_b = -kEnd}});
      bodies.push_back(rod);
      before = rod;
    }
  }
  world.step();  // makes velocities fit
  const auto sums = [&] {
    std::vector<double> out(4);
    for (const BodyId body : bodies) {
      const double m = world.mass(body), spin = world.angular_velocity(body);
      const Vec2d v = world.velocity(body), x = world.position(body);
      out[0] += m * v.x, out[1] += m * v.y;
      out[2] += m * cross(x, v) + world.inertia(body) * spin;
      out[3] += 0.5 * (m * length_squared(v) + world.inertia(body) * spin * spin);
    }
    return out;
  };
  const std::vector<double> start = sums();
  run(world, 600);
  const std::vector<double> end = sums();
  const double rounding = sizeof(TypeParam) == 4 ? 2e-5 : 1e-11;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(end[i], start[i], rounding) << i;
  EXPECT_NEAR(end[3], start[3], 1e-3 * start[3]);
}

// Ten thousand links: of their weight each joint feels what hangs on it.
TYPED_TEST(HingeTrees, TenThousandLinksHang) {
  BasicWorld<TypeParam> world(with(Solver::SoftSteps));
  constexpr int kLinks = 10'000;
  BodyId before = add_hook(world);
  std::vector<JointId> joints;
  for (int i = 0; i < kLinks; ++i) {
    const BodyId link = add_mass(world, {0, -0.5 - i}, 1, 1.0 / 12);
    joints.push_back(world.create_joint(
        before, link,
        {.kind = RevoluteDefinition{.anchor_a = {0, i == 0 ? 0 : -0.5}, .anchor_b = {0, 0.5}}}));
    before = link;
  }
  run(world, 10);
  EXPECT_NEAR(world.position(before).y, 0.5 - kLinks, 1e-6);
  for (const int i : {0, kLinks / 2, kLinks - 1})
    EXPECT_NEAR(world.read(joints[i]).force / ((kLinks - i) * kGravity), 1, 1e-5) << i;
}

// A joint that is open by half of the rod closes without a burst: by up to four times its arm a second.
TYPED_TEST(HingeTrees, AnOpenJointClosesSmoothly) {
  BasicWorld<TypeParam> world(test::weightless(Solver::SoftSteps));
  const BodyId rod = add_mass(world, {1, 0}, 1, 1.0 / 12);
  world.create_joint(add_hook(world), rod, {.kind = RevoluteDefinition{.anchor_b = -kEnd}});
  double fastest = 0, before = 1;
  for (int i = 0; i < 60; ++i) {
    world.step(1.0 / 60, 4);
    fastest = std::max(fastest, before - world.position(rod).x);
    before = world.position(rod).x;
  }
  EXPECT_LT(fastest, 1.01 * 4 * 0.5 / 60);
  EXPECT_NEAR(before, 0.5, 1e-6);
  EXPECT_LT(std::hypot(world.velocity(rod).x, world.velocity(rod).y), 1e-3);
}

// A rod that meets a box is left to the sweeps while it touches it, and is a mechanism again after.
TYPED_TEST(HingeTrees, WhatTouchesIsLeftToTheSweeps) {
  BasicWorld<TypeParam> world(with(Solver::SoftSteps));
  const BodyId rod = world.create_body({.position = {0.5, 0}}, {.geometry = Box{1, 0.1}});
  const JointId joint =
      world.create_joint(add_hook(world), rod, {.kind = RevoluteDefinition{.anchor_b = -kEnd}});
  world.create_body({.type = BodyType::Static, .position = {0, -1.3}}, {.geometry = Box{0.5, 0.8}});
  int held = 0, swept = 0;
  double gap = 0;
  for (int i = 0; i < 120; ++i) {
    world.step(1.0 / 60, 4);
    (world.data().scratch.islands.trees.empty() ? swept : held)++;
    gap = std::max(gap, static_cast<double>(world.read(joint).linear_error));
  }
  EXPECT_GT(held, 20);
  EXPECT_GT(swept, 0);
  EXPECT_LT(gap, 0.01);
}

// Loops, other joints, locked bodies and other solvers are no mechanisms; nor are, for their cost, chains of
// a few like links.
TEST(HingeTreeChoice, WhatIsAMechanism) {
  const auto hinges = [](int links, double tip, Solver solver, auto&& change) {
    World world(with(solver));
    const test::Chain chain = add_chain(world, links, tip);
    change(world, chain);
    world.step();
    return world.data().scratch.islands.trees.hinge_count;
  };
  const auto nothing = [](World&, const test::Chain&) {};
  EXPECT_EQ(hinges(1, 1, Solver::SoftSteps, nothing), 1);
  EXPECT_EQ(hinges(4, 1, Solver::SoftSteps, nothing), 4);
  EXPECT_EQ(hinges(10, 1, Solver::SoftSteps, nothing), 0);
  EXPECT_EQ(hinges(10, 10, Solver::SoftSteps, nothing), 10);
  EXPECT_EQ(hinges(10, 1, Solver::Direct, nothing), 10);
  EXPECT_EQ(hinges(17, 1, Solver::SoftSteps, nothing), 17);
  EXPECT_EQ(hinges(2, 1, Solver::Xpbd, nothing), 0);
  EXPECT_EQ(
      hinges(2, 1, Solver::SoftSteps, [](World& w, const test::Chain&) { w.set_direct_islands(false); }), 0);
  EXPECT_EQ(hinges(2, 1, Solver::SoftSteps,
                   [](World& w, const test::Chain& c) { w.set_locks(c.links[1], true, false, false); }),
            0);
  EXPECT_EQ(hinges(2, 1, Solver::SoftSteps,
                   [](World& w, const test::Chain& c) {
                     w.step();
                     w.change(c.joints[1], RevoluteDefinition{.anchor_a = kEnd,
                                                              .anchor_b = -kEnd,
                                                              .motor = Motor{.speed = 1, .max_force = 1}});
                   }),
            0);
  EXPECT_EQ(hinges(2, 1, Solver::SoftSteps,
                   [](World& w, const test::Chain& c) {
                     const BodyId hook = add_hook(w, {2, 0});
                     w.create_joint(hook, c.links[1], {.kind = RevoluteDefinition{.anchor_b = kEnd}});
                   }),
            0);
  EXPECT_EQ(hinges(3, 1, Solver::SoftSteps,
                   [](World& w, const test::Chain& c) {
                     w.create_joint(c.links[0], c.links[2],
                                    {.kind = RevoluteDefinition{.anchor_a = {1.5, 0}, .anchor_b = -kEnd}});
                   }),
            0);
}

// A restored world goes on with the same bits, mechanisms and all.
TYPED_TEST(HingeTrees, SnapshotsGoOn) {
  BasicWorld<TypeParam> world(with(Solver::Direct));
  add_chain(world, 7, 20.0);
  run(world, 30);
  BasicWorld<TypeParam> other(with(Solver::Direct));
  restore(other, save(world));
  run(world, 30), run(other, 30);
  EXPECT_EQ(world.hash(), other.hash());
}

}  // namespace
}  // namespace plumb
