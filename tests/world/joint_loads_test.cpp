// The load of a joint is its mean over a step: what a joint and gravity give a body in a step is the change
// of its momentum. Readings, breaking and load events are held against that, with all solvers, kinds of
// joints and numbers of substeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "engine/world/snapshot.h"
#include "engine/world/world.h"

namespace plumb {
namespace {

constexpr double kG = 9.81, kDt = 1.0 / 60;
constexpr Vec2d kGravity{0, -kG};

struct NamedKind {
  std::string name;
  JointKind kind;
};

// Joints between the world's origin and the centre of a plate there. All hold it in x.
std::vector<NamedKind> holding_kinds() {
  return {{"weld", WeldDefinition{}},
          {"hinge", RevoluteDefinition{}},
          {"hinge with limits", RevoluteDefinition{.limits = Range{-1, 1}}},
          {"slider", PrismaticDefinition{.axis = {0, 1}}},
          {"wheel", WheelDefinition{.axis = {0, 1}}},
          {"rod", DistanceDefinition{.anchor_a = {-2, 0}, .length = 2}},
          {"rope", DistanceDefinition{.anchor_a = {-2, 0}, .range = Range{0, 2}}}};
}

// A plate of 2 kg, joined to a static body.
struct Plate {
  explicit Plate(const WorldDefinition& settings, JointDefinition definition) : world(settings) {
    wall = world.create_body({.type = BodyType::Static});
    body = world.create_body({.mass = MassProperties{2, {}, 0.5}}, {.geometry = Box{1, 0.2}});
    joint = world.create_joint(wall, body, definition);
  }
  DoubleWorld world;
  BodyId wall, body;
  JointId joint;
};

// ---- Momentum

class JointLoad : public testing::TestWithParam<std::tuple<Solver, bool, int>> {
 protected:
  WorldDefinition settings() const {
    return {.sleeping = false, .solver = std::get<0>(GetParam()), .direct_islands = std::get<1>(GetParam())};
  }
  int substeps() const { return std::get<2>(GetParam()); }
};

// A plate on one joint is hit every ten steps: in each step m dv = (F + m g) dt.
TEST_P(JointLoad, IsTheChangeOfMomentum) {
  for (const auto& [name, kind] : holding_kinds()) {
    Plate at(settings(), {.kind = kind});
    const double m = at.world.mass(at.body);
    double worst = 0, largest = 0;
    for (int i = 0; i < 60; ++i) {
      if (i % 10 == 5) at.world.apply_impulse(at.body, {3 * m, 0.5 * m});
      const Vec2d before = at.world.velocity(at.body);
      at.world.step(kDt, substeps());
      const Vec2d force = (m / kDt) * (at.world.velocity(at.body) - before) - m * kGravity;
      const double read = at.world.read(at.joint).force;
      worst = std::max(worst, std::abs(read - std::sqrt(length_squared(force))));
      largest = std::max(largest, read);
    }
    EXPECT_GT(largest, m * 3 / kDt / 4) << name << ": nothing was held";
    // A substep's impulse counts along the rod at its end, while the rod turns by up to 0.01 rad in it.
    // SequentialImpulses corrects gaps by velocities, which are no load.
    const bool turns = std::holds_alternative<DistanceDefinition>(kind);
    EXPECT_LT(worst, (turns ? 0.02 : 1e-4) * largest) << name;
  }
}

// A joint that stops a plate at once breaks by its impulse over dt, for any number of substeps.
TEST_P(JointLoad, BreaksIffTheImpulseOverTheStepIsTooLarge) {
  for (const auto& [name, kind] : holding_kinds()) {
    for (const double speed : {0.1, 10.0, 1000.0}) {
      for (const auto& [factor, breaks] : {std::pair{0.98, true}, {1.02, false}}) {
        WorldDefinition without_gravity = settings();
        without_gravity.gravity = {};
        const double force = 2 * speed / kDt;
        Plate at(without_gravity,
                 {.kind = kind, .break_force = factor * force, .report_force = factor * force});
        at.world.apply_impulse(at.body, {2 * speed, 0});
        at.world.step(kDt, substeps());
        const double left = at.world.velocity(at.body).x / speed;
        if (breaks) {
          EXPECT_FALSE(at.world.valid(at.joint)) << name << ' ' << speed << ' ' << left;
          EXPECT_EQ(at.world.events().loaded.size(), 1u) << name << ' ' << speed;
        } else {
          ASSERT_TRUE(at.world.valid(at.joint)) << name << ' ' << speed;
          EXPECT_NEAR(at.world.read(at.joint).force / force, 1, 1e-3) << name << ' ' << speed << ' ' << left;
          EXPECT_TRUE(at.world.events().loaded.empty()) << name << ' ' << speed;
        }
      }
    }
  }
}

// An angular impulse L on a weld, and on a hinge's limit, is a torque of L / dt.
TEST_P(JointLoad, TorqueIsTheAngularImpulseOverTheStep) {
  const JointKind kinds[] = {WeldDefinition{}, RevoluteDefinition{.limits = Range{-1, 0}},
                             PrismaticDefinition{}};
  for (const JointKind& kind : kinds) {
    for (const auto& [factor, breaks] : {std::pair{0.98, true}, {1.02, false}}) {
      WorldDefinition without_gravity = settings();
      without_gravity.gravity = {};
      Plate at(without_gravity, {.kind = kind, .break_torque = factor * 0.5 * 20 / kDt});
      at.world.apply_angular_impulse(at.body, 0.5 * 20);
      at.world.step(kDt, substeps());
      EXPECT_EQ(at.world.valid(at.joint), !breaks)
          << kind.index() << ' ' << at.world.angular_velocity(at.body);
    }
  }
}

// A body falls into its rope, at any phase of a step: the rope gives it the momentum that gravity gave it.
TEST_P(JointLoad, OfARopeThatSnapsTautIsTheMomentumOfTheFall) {
  for (int i = 0; i < 10; ++i) {
    const double drop = 2 * (1 + 0.003 * i);
    DoubleWorld world(settings());
    const BodyId hook = world.create_body({.type = BodyType::Static});
    const BodyId ball = world.create_body({.position = {0, -1}, .mass = MassProperties{2, {}, 0.5}},
                                          {.geometry = Circle{0.2}});
    const JointDefinition definition{.kind = DistanceDefinition{.range = Range{0, 1 + drop}},
                                     .report_force = 10 * 2 * kG};
    const JointId rope = world.create_joint(hook, ball, definition);
    double impulse = 0, snap = 0;
    int events = 0;
    const int steps = 120;
    for (int step = 0; step < steps; ++step) {
      world.step(kDt, substeps());
      impulse += world.read(rope).force * kDt;
      snap = std::max(snap, world.read(rope).force);
      events += static_cast<int>(world.events().loaded.size());
    }
    const double want = 2 * (kG * steps * kDt + world.velocity(ball).y);
    EXPECT_NEAR(impulse, want, 1e-3 * want) << i;
    // It stops within two steps: one of them bears half of it at least.
    EXPECT_GT(snap, 0.5 * 2 * std::sqrt(2 * kG * drop) / kDt) << i;
    EXPECT_GE(events, 1) << i;
  }
}

// A load hangs from a lift that accelerates at a: its rope bears m (g + a).
TEST_P(JointLoad, OfALoadInALiftIncludesItsAcceleration) {
  DoubleWorld world(settings());
  const BodyId lift = world.create_body({.type = BodyType::Kinematic});
  const BodyId load = world.create_body({.position = {0, -1}, .mass = MassProperties{2, {}, 0.5}},
                                        {.geometry = Box{0.2, 0.2}});
  const JointId rope = world.create_joint(lift, load, {.kind = DistanceDefinition{.length = 1}});
  double mean = 0;
  for (int i = 1; i <= 180; ++i) {
    const double t = i * kDt;
    world.move_towards(lift, {0, 0.5 * 3 * t * t}, 0, kDt);
    world.step(kDt, substeps());
    if (i > 120) mean += world.read(rope).force / 60;
  }
  EXPECT_NEAR(mean, 2 * (kG + 3), 1e-3 * 2 * (kG + 3));
}

// At rest nothing changes: the hook of a chain bears its weight, the links below bear less.
TEST_P(JointLoad, OfAChainAtRestIsTheWeightBelow) {
  DoubleWorld world(settings());
  BodyId above = world.create_body({.type = BodyType::Static});
  std::vector<JointId> joints;
  for (int i = 0; i < 4; ++i) {
    const BodyId link = world.create_body({.position = {0, -0.5 - i}, .mass = MassProperties{2, {}, 0.5}},
                                          {.geometry = Box{0.1, 1}});
    joints.push_back(world.create_joint(
        above, link, {.kind = RevoluteDefinition{.anchor_a = {0, i == 0 ? 0 : -0.5}, .anchor_b = {0, 0.5}}}));
    above = link;
  }
  for (int i = 0; i < 600; ++i) world.step(kDt, substeps());
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(world.read(joints[i]).force, (4 - i) * 2 * kG, 0.01 * (4 - i) * 2 * kG) << i;
}

// Of any length and size: what closes the gaps of a joint that iterations leave open bears load, too.
TEST(JointLoads, OfHangingChainsAreTheWeightsBelow) {
  for (const int links : {2, 5, 6, 8, 12, 16, 17, 24}) {
    for (const double size : {0.01, 0.1, 1.0, 30.0}) {
      DoubleWorld world({.sleeping = false});
      BodyId above = world.create_body({.type = BodyType::Static});
      std::vector<JointId> joints;
      double weight = 0;
      for (int i = 0; i < links; ++i) {
        const BodyId link =
            world.create_body({.position = {0, -size * (i + 0.5)}}, {.geometry = Box{0.1 * size, size}});
        joints.push_back(world.create_joint(
            above, link,
            {.kind =
                 RevoluteDefinition{.anchor_a = {0, i == 0 ? 0 : -size / 2}, .anchor_b = {0, size / 2}}}));
        weight += world.mass(link) * kG;
        above = link;
      }
      for (int i = 0; i < 200; ++i) world.step(kDt);
      for (int i = 0; i < links; ++i) {
        const double below = weight * (links - i) / links;
        EXPECT_NEAR(world.read(joints[i]).force / below, 1, 0.02) << links << " of " << size << " m, " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, JointLoad,
                         testing::Combine(testing::Values(Solver::SoftSteps, Solver::Direct,
                                                          Solver::SequentialImpulses, Solver::Jakobsen,
                                                          Solver::Xpbd),
                                          testing::Bool(), testing::Values(1, 2, 4, 8)));

// ---- Side by side

// Plates that iterations solve, alone or many side by side, with any number of threads: each has its own
// load.
TEST(JointLoads, AreEachJointsOwnInLanesAndThreads) {
  for (const auto& [name, kind] : holding_kinds()) {
    std::vector<double> first;
    for (const int threads : {1, 3}) {
      World world({.gravity = {}, .sleeping = false, .direct_islands = false, .threads = threads});
      const BodyId wall = world.create_body({.type = BodyType::Static});
      std::vector<BodyId> plates;
      std::vector<JointId> joints;
      for (int i = 0; i < 300; ++i) {
        plates.push_back(world.create_body({.mass = MassProperties{2, {}, 0.5}}));
        joints.push_back(world.create_joint(wall, plates.back(), {.kind = kind}));
        world.apply_impulse(plates.back(), {2.0 * (1 + i), 0});
      }
      world.step(kDt);
      std::vector<double> loads;
      for (int i = 0; i < 300; ++i) {
        loads.push_back(world.read(joints[i]).force);
        EXPECT_NEAR(loads.back() / (2.0 * (1 + i) / kDt), 1, 1e-3) << name << ' ' << i;
      }
      if (first.empty()) first = loads;
      EXPECT_EQ(loads, first) << name;
    }
  }
}

// ---- Impacts

// A ball bounces off a plate: the joint bears what the ball gives, though no substep ends with it.
TEST(JointLoads, IncludeImpactsThatJointsPassOn) {
  for (const bool direct : {true, false}) {
    for (const double restitution : {0.5, 1.0}) {
      for (int phase = 0; phase < 6; ++phase) {
        DoubleWorld world({.gravity = {}, .sleeping = false, .direct_islands = direct});
        const BodyId wall = world.create_body({.type = BodyType::Static});
        const BodyId plate =
            world.create_body({}, {.geometry = Box{0.2, 2}, .material = {.restitution = restitution}});
        const JointId joint = world.create_joint(wall, plate, {.kind = WeldDefinition{}});
        const BodyId ball =
            world.create_body({.position = {-3 - 0.04 * phase, 0}, .velocity = {10, 0}},
                              {.geometry = Circle{0.3}, .material = {.restitution = restitution}});
        double impulse = 0;
        for (int i = 0; i < 60; ++i) {
          world.step(kDt);
          impulse += world.read(joint).force * kDt;
        }
        const double given = world.mass(ball) * (10 - world.velocity(ball).x);
        EXPECT_NEAR(given, world.mass(ball) * 10 * (1 + restitution), 0.01 * given);
        EXPECT_NEAR(impulse, given, 0.01 * given) << direct << ' ' << restitution << ' ' << phase;
      }
    }
  }
}

// ---- State

TEST(JointLoads, AreTheSameInARestoredWorld) {
  for (const auto& [name, kind] : holding_kinds()) {
    Plate at({}, {.kind = kind});
    at.world.apply_impulse(at.body, {6, 1});
    at.world.apply_angular_impulse(at.body, 1);
    at.world.step(kDt);
    DoubleWorld other;
    restore(other, save(at.world));
    EXPECT_GT(at.world.read(at.joint).force, 2 * 3 / kDt / 2) << name;
    EXPECT_EQ(other.read(at.joint).force, at.world.read(at.joint).force) << name;
    EXPECT_EQ(other.read(at.joint).torque, at.world.read(at.joint).torque) << name;
  }
}

}  // namespace
}  // namespace plumb
