// The promises of worlds and simulations about any scene, and the integration of free bodies.
#include "harness/hunt/promises.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/world/world.h"
#include "harness/hunt/examine.h"
#include "harness/hunt/idiom.h"
#include "harness/hunt/run_mode.h"

namespace plumb::harness::hunt {
namespace {

Engine engine(const char* name) { return Engine(reference::find_backend(name)); }

/// A chain that swings into a stack of boxes.
Case chain_and_stack() {
  Case one;
  one.scene.bodies.push_back({.name = "floor",
                              .type = BodyType::Static,
                              .position = {0, -0.5},
                              .shapes = {{.geometry = Box{20, 1}}}});
  for (int i = 0; i < 4; ++i)
    one.scene.bodies.push_back({.name = "box" + std::to_string(i),
                                .position = {0.02 * i, 0.25 + 0.5 * i},
                                .shapes = {{.geometry = Box{0.5, 0.5}}}});
  std::string before{kWorld};
  for (int i = 0; i < 5; ++i) {
    const std::string name = "link" + std::to_string(i);
    one.scene.bodies.push_back({.name = name,
                                .position = {-3 + 0.4 * i + 0.2, 2.5},
                                .shapes = {{.geometry = Capsule{{-0.2, 0}, {0.2, 0}, 0.05}}}});
    one.scene.joints.push_back(RevoluteJoint{.name = "j" + std::to_string(i),
                                             .body_a = before,
                                             .body_b = name,
                                             .anchor_a = i == 0 ? Vec2d{-3, 2.5} : Vec2d{0.2, 0},
                                             .anchor_b = {-0.2, 0}});
    before = name;
  }
  one.steps = 90, one.sleeping = true;
  return one;
}

TEST(Promises, AreKeptByAChainThatSwingsIntoAStack) {
  for (const char* name : {"plumb-float", "plumb", "plumb-precise"})
    for (const Relation& promise : promises()) {
      const Case one = chain_and_stack();
      if (!promise.applies(one, engine(name))) continue;
      const Verdict verdict = promise.judge(one, engine(name), {});
      EXPECT_FALSE(verdict) << name << ", " << promise.name << ": " << verdict->what;
    }
}

// Draws by the scene's number alone what these judges ask for.
TEST(Promises, PartsOfTheEnginesKeepTheirsInManyDraws) {
  for (std::uint64_t index = 0; index < 60; ++index) {
    Case one = chain_and_stack();
    one.index = index;
    for (const auto& judge : {systems, loops, monitors, integrators, strikes})
      for (const char* name : {"plumb-float", "plumb"}) {
        const Verdict verdict = judge(one, engine(name), {});
        EXPECT_FALSE(verdict) << name << ", " << index << ", " << verdict->judge << ": " << verdict->what;
      }
    const Verdict verdict = blows(one, engine("plumb-precise"), {});
    EXPECT_FALSE(verdict) << index << ": " << verdict->what;
  }
}

// A Precise scene in which a disc bounces, slides and ends: derivatives by its numbers are those of
// differences.
TEST(Promises, DerivativesAndForcesOfABouncingDiscAreThoseOfItsRuns) {
  Case one;
  one.scene.bodies = {{.name = "floor",
                       .type = BodyType::Static,
                       .position = {0, -0.5},
                       .shapes = {{.geometry = Box{40, 1}, .friction = 0.3, .restitution = 0.2}}},
                      {.name = "disc",
                       .position = {0, 1.2},
                       .velocity = {2, 0},
                       .shapes = {{.geometry = Circle{0.5}, .friction = 0.6, .restitution = 0.5}}}};
  for (one.index = 0; one.index < 20; ++one.index)
    for (const auto& judge : {derivatives, forces, estimates, starts}) {
      const Verdict verdict = judge(one, engine("plumb-precise"), {});
      EXPECT_FALSE(verdict) << one.index << ", " << verdict->judge << ": " << verdict->what;
    }
}

// Scenes of all kinds, with steps of 1 to 20.
TEST(Promises, QueriesFindWhatOutlinesSay) {
  for (std::uint64_t index = 0; index < 40; ++index) {
    Case one = compose(41, index);
    one.steps = std::min(one.steps, static_cast<int>(1 + index / 2));
    for (const Objection& objection : examine(engine("plumb-float"), one, "queries").objections)
      ADD_FAILURE() << index << ": " << objection.what;
  }
}

TEST(Promises, DigestsDifferWhereSettingsMotionsOrNamesDo) {
  const auto digest = [](const auto& change) {
    World world;
    const BodyId body = world.create_body({.position = {0, 1}}, {.geometry = Circle{0.5}});
    change(world, body);
    return digest_of(world);
  };
  const Digest plain = digest([](World&, BodyId) {});
  EXPECT_EQ(plain, digest([](World&, BodyId) {}));
  const Digest other_gravity = digest([](World& world, BodyId) { world.set_gravity({0, -1}); });
  EXPECT_NE(plain.whole, other_gravity.whole);
  EXPECT_EQ(plain.visible, other_gravity.visible);
  EXPECT_NE(plain.visible, digest([](World& world, BodyId body) {
                             world.set_velocity(body, {1, 0});
                           }).visible);
  EXPECT_EQ(plain.visible, digest([](World& world, BodyId) { label(world); }).visible);
}

TEST(Promises, AWorldToRestoreIntoHasNoSettingOfTheOther) {
  const WorldDefinition usual, other = contrary(usual);
  EXPECT_NE(usual.gravity, other.gravity);
  EXPECT_NE(usual.combine_friction, other.combine_friction);
  EXPECT_NE(usual.combine_restitution, other.combine_restitution);
  EXPECT_NE(usual.sleeping, other.sleeping);
  EXPECT_NE(usual.continuous, other.continuous);
  EXPECT_NE(usual.solver, other.solver);
  EXPECT_NE(usual.integrator, other.integrator);
  EXPECT_NE(usual.iterations, other.iterations);
  EXPECT_NE(usual.direct_islands, other.direct_islands);
  EXPECT_NE(usual.quarantine, other.quarantine);
}

TEST(Promises, CallsThatMustBeRefusedAreAndABodyBeyondTheNumbersIsQuarantined) {
  World world;
  world.create_body({.type = BodyType::Static}, {.geometry = Box{10, 1}});
  world.create_body({.position = {0, 2}}, {.geometry = Box{1, 1}});
  EXPECT_EQ(not_refused(world), "");
  EXPECT_EQ(overrun(world, 1.0 / 60, 4), "");
}

/// A body that a pulse shorter than a step pushes, and drag slows down.
Case pulse() {
  Case one;
  one.scene.gravity = {0, 0};
  one.scene.bodies = {{.name = "ball", .mass = 2, .shapes = {{.geometry = Circle{0.5}}}}};
  one.scene.forces = {PointForce{.body = "ball", .force = {600, 0}, .start = 0.1013, .duration = 0.01},
                      LinearDrag{.body = "ball", .coefficient = 1}};
  one.steps = 60;
  return one;
}

TEST(Integrated, PreciseFollowsAPulseAndDragAndIsSeenWhereItDoesNot) {
  const Case one = pulse();
  const auto judged = [&](const Motion& motion) {
    return integrated_relation(one, engine("plumb-precise"), motion).has_value();
  };
  Motion motion = run(engine("plumb-precise"), one);
  // J/m, less what drag takes away in 0.9 s: v = 3 exp(-t/2) but for the drag during the pulse.
  EXPECT_NEAR(motion.samples.back().states.front().velocity.x, 3 * std::exp(-0.5 * (1 - 0.1063)), 1e-4);
  EXPECT_FALSE(judged(motion));
  for (Sample& sample : motion.samples) sample.states.front().position.x *= 1.001;
  EXPECT_TRUE(judged(motion));
}

}  // namespace
}  // namespace plumb::harness::hunt
