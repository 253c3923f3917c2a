#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/contact_scenes.h"

// Holds the forces of joints and contacts against statics and closed forms.
namespace plumb {
namespace {

constexpr double kG = 9.81;

void expect_force(Vec2d force, Vec2d expected, double tolerance) {
  EXPECT_NEAR(force.x, expected.x, tolerance);
  EXPECT_NEAR(force.y, expected.y, tolerance);
}

Simulation precise(const Scene& scene, double tolerance = 1e-9) {
  return compile(scene, Precise{.tolerance = tolerance});
}

TEST(PreciseForces, RodLetGoAtOneEndWeighsAQuarterOnTheOtherAtOnce) {
  Scene scene = rods(1);
  scene.bodies[0].mass = 3, scene.bodies[0].inertia = 3.0 / 12;
  const Simulation one = precise(scene);
  ASSERT_EQ(one.forces().joints.size(), 1u);
  EXPECT_EQ(one.forces().joints[0].joint, "joint0");
  expect_force(one.forces().joints[0].force, {0, 3 * kG / 4}, 1e-12);
  expect_force(one.forces().joints[0].position, {0, 0}, 0);
  EXPECT_NEAR(one.forces().joints[0].torque, 0, 1e-12) << "about the hinge";

  scene.joints.push_back(RevoluteJoint{"far", std::string(kWorld), "rod0", {1, 0}, {0.5, 0}, false});
  Simulation held = precise(scene);
  for (int i = 0; i < 2; ++i, held.step()) {
    const Reactions forces = held.forces();
    EXPECT_NEAR(forces.joints[0].force.y, 3 * kG / 2, 1e-12);
    EXPECT_NEAR(forces.joints[1].force.y, 3 * kG / 2, 1e-12);
    EXPECT_NEAR(forces.joints[0].force.x + forces.joints[1].force.x, 0, 1e-12) << "along it one of many";
  }
}

TEST(PreciseForces, PendulumPullsByItsWeightAndItsTurning) {
  Scene scene{.name = "pendulum"};
  scene.bodies = {{.name = "bob", .position = {2, 0}, .mass = 1.5, .inertia = 1}};
  scene.joints = {DistanceJoint{.name = "rod", .body_a = std::string(kWorld), .body_b = "bob", .length = 2}};
  for (const double tolerance : {1e-6, 1e-9, 1e-11}) {
    Simulation simulation = precise(scene, tolerance);
    for (int i = 0; i < 60; ++i) {
      simulation.step();
      const BodyState bob = simulation.state(0);
      const JointReaction rod = simulation.forces().joints[0];
      // From rest at the height of the pivot: m v^2 / l = 2 m g sin q, and m g sin q of its own weight.
      const Vec2d inwards = -0.5 * bob.position;
      expect_force(rod.force, (3 * 1.5 * kG * inwards.y) * inwards, 100 * tolerance + 1e-12);
    }
  }
}

TEST(PreciseForces, BlockOnARampPressesWithItsShareAndSticksOrSlips) {
  for (const double friction : {0.2, 0.8}) {
    const double angle = 0.5;
    Scene scene{.name = "ramp", .gravity = gravity_on_ramp(angle)};
    scene.bodies = {ground(friction), block("block", {0, 0.5}, 2, 1, friction)};
    scene.bodies[1].mass = 2, scene.bodies[1].inertia = 1;
    Simulation simulation = precise(scene);
    simulation.step(10);
    const Reactions forces = simulation.forces();
    double normal = 0, tangent = 0, moment = 0;
    for (const ContactReaction& contact : forces.contacts) {
      EXPECT_EQ(contact.body_a, 0u);
      EXPECT_EQ(contact.body_b, 1u);
      normal += contact.normal_force, tangent += contact.tangent_force;
      const Vec2d force =
          contact.normal_force * contact.normal + contact.tangent_force * perpendicular(contact.normal);
      moment += cross(contact.position - simulation.state(1).position, force);
    }
    EXPECT_NEAR(normal, 2 * kG * std::cos(angle), 1e-10);
    const bool holds = friction > std::tan(angle);
    EXPECT_NEAR(std::abs(tangent), 2 * kG * (holds ? std::sin(angle) : friction * std::cos(angle)), 1e-10);
    EXPECT_NEAR(moment, 0, 1e-9) << "it does not turn";
  }
}

TEST(PreciseForces, BeamOnAHingeAndASupportSharesItsWeight) {
  // Joints beside a contact: the hinge takes what the support does not.
  Scene scene{.name = "beam"};
  scene.bodies = {ground(0), block("beam", {0, 1}, 4, 0.2, 0), block("post", {1, 0.45}, 0.2, 0.9, 0)};
  scene.bodies[2].type = BodyType::Static;
  scene.bodies[1].mass = 3;
  scene.joints = {RevoluteJoint{"hinge", std::string(kWorld), "beam", {-2, 1}, {-2, 0}, false}};
  Simulation simulation = precise(scene);
  simulation.step(5);
  const Reactions forces = simulation.forces();
  double support = 0, moment = 0;
  for (const ContactReaction& contact : forces.contacts) {
    const double up = contact.normal_force * contact.normal.y * (contact.body_b == 1 ? 1 : -1);
    support += up, moment += up * (contact.position.x + 2);
  }
  EXPECT_NEAR(moment, 3 * kG * 2, 1e-9);
  EXPECT_NEAR(support + forces.joints[0].force.y, 3 * kG, 1e-9);
}

TEST(PreciseForces, LimitsMotorsAndSpringsAreTheJointsOwn) {
  Scene scene{.name = "lift"};
  scene.bodies = {{.name = "cage", .mass = 2, .inertia = 1}};
  PrismaticJoint rail{.name = "rail", .body_a = std::string(kWorld), .body_b = "cage", .axis = {0, 1}};
  rail.limits = Range{0, 5};
  scene.joints = {rail};
  Simulation limited = precise(scene);
  limited.step(3);
  expect_force(limited.forces().joints[0].force, {0, 2 * kG}, 1e-10);

  rail.limits = {};
  rail.motor = Motor{.speed = 0, .max_force = 100};
  scene.joints = {rail};
  Simulation driven = precise(scene);
  driven.step(3);
  expect_force(driven.forces().joints[0].force, {0, 2 * kG}, 1e-10);
  rail.motor = Motor{.speed = 0, .max_force = 15};  // too weak
  scene.joints = {rail};
  Simulation weak = precise(scene);
  weak.step(3);
  expect_force(weak.forces().joints[0].force, {0, 15}, 1e-10);

  rail.motor = {};
  rail.spring = Spring{.hertz = 2, .damping_ratio = 0.3};
  scene.joints = {rail};
  Simulation sprung = precise(scene);
  for (int i = 0; i < 20; ++i) {
    sprung.step();
    const BodyState cage = sprung.state(0);
    const double w = 2 * kPi * 2;
    expect_force(sprung.forces().joints[0].force,
                 {0, -2 * (w * w * cage.position.y + 2 * 0.3 * w * cage.velocity.y)}, 1e-9);
  }
}

TEST(PreciseForces, AskingChangesNothingAndFarOffIsTheSame) {
  Scene scene = rods(3);
  Simulation asked = precise(scene), quiet = precise(scene);
  for (int i = 0; i < 30; ++i) {
    asked.step(), quiet.step();
    (void)asked.forces(), (void)quiet.state(0);
  }
  EXPECT_EQ(asked.hash(), quiet.hash());
  EXPECT_EQ(asked.statistics().evaluations, quiet.statistics().evaluations);

  Scene far = scene;
  const Vec2d off{1e6, -1e6};
  for (Body& body : far.bodies) body.position += off;
  std::get<RevoluteJoint>(far.joints[0]).anchor_a += off;
  Simulation there = precise(far);
  there.step(30);
  const JointReaction here_hinge = asked.forces().joints[0], far_hinge = there.forces().joints[0];
  expect_force(far_hinge.force, here_hinge.force, 1e-7);
  expect_force(far_hinge.position, here_hinge.position + off, 1e-8);
}

double weight_on(const Reactions& forces, std::size_t body) {
  double up = 0;
  for (const ContactReaction& contact : forces.contacts) {
    const Vec2d force =
        contact.normal_force * contact.normal + contact.tangent_force * perpendicular(contact.normal);
    up += contact.body_b == body ? force.y : contact.body_a == body ? -force.y : 0;
  }
  return up;
}

TEST(PreciseForces, BeforeTheFirstStepLimitsRopesAndMotorsHoldTheirLoad) {
  Scene arm{.name = "arm on its limit"};
  arm.bodies = {{.name = "arm", .position = {1, 0}, .mass = 2, .inertia = 1}};
  RevoluteJoint hinge{"hinge", std::string(kWorld), "arm", {0, 0}, {-1, 0}, false};
  hinge.limits = Range{0, 1};
  arm.joints = {hinge};
  const JointReaction limit = precise(arm).forces().joints[0];
  expect_force(limit.force, {0, 2 * kG}, 1e-12);
  EXPECT_NEAR(limit.torque, 2 * kG, 1e-12);

  Scene rope{.name = "taut rope", .gravity = {0, 0}};
  rope.bodies = {{.name = "stone", .position = {2, 0}, .velocity = {0, 3}, .mass = 1.5, .inertia = 1}};
  rope.joints = {DistanceJoint{
      .name = "rope", .body_a = std::string(kWorld), .body_b = "stone", .length = 2, .range = Range{0, 2}}};
  expect_force(precise(rope).forces().joints[0].force, {-1.5 * 3 * 3 / 2, 0}, 1e-12);

  const double slope = 1.2;
  Scene rail{.name = "rail with a brake"};
  rail.bodies = {{.name = "car", .mass = 2, .inertia = 1}};
  PrismaticJoint axle{.name = "rail",
                      .body_a = std::string(kWorld),
                      .body_b = "car",
                      .axis = {std::cos(slope), std::sin(slope)}};
  axle.motor = Motor{.speed = 0, .max_force = 100};
  rail.joints = {axle};
  expect_force(precise(rail).forces().joints[0].force, {0, 2 * kG}, 1e-12);
}

TEST(PreciseForces, BeforeTheFirstStepEachBlockOfAPileBearsThoseAboveIt) {
  Scene pile{.name = "pile"};
  pile.bodies = {ground(0.5)};
  for (int i = 0; i < 4; ++i) {
    pile.bodies.push_back(block("b" + std::to_string(i), {0.1 * i, 0.5 + i}, 1, 1, 0.5));
    pile.bodies.back().mass = 1 + i, pile.bodies.back().inertia = (1 + i) / 6.0;
  }
  const Reactions forces = precise(pile).forces();
  EXPECT_EQ(forces.contacts.size(), 8u);
  for (std::size_t body = 1; body <= 4; ++body)
    EXPECT_NEAR(weight_on(forces, body), static_cast<double>(body) * kG, 1e-10) << body;
}

TEST(PreciseForces, ABodyThatIsPutSomewhereElseHasTheForcesOfThatPlaceAtOnce) {
  Scene scene{.name = "lifted and put down"};
  scene.bodies = {ground(0.5), block("block", {0, 3}, 1, 1, 0.5)};
  Simulation simulation = precise(scene), quiet = precise(scene);
  simulation.step(3), quiet.step(3);
  EXPECT_TRUE(simulation.forces().contacts.empty()) << "it falls";
  for (Simulation* each : {&simulation, &quiet}) each->set_state(1, {.position = {2, 0.5}});
  EXPECT_NEAR(weight_on(simulation.forces(), 1), scene.bodies[1].mass * kG, 1e-10);
  const Simulation copy = [&] {
    Simulation other = precise(scene);
    other.restore(simulation.save());
    return other;
  }();
  EXPECT_NEAR(weight_on(copy.forces(), 1), scene.bodies[1].mass * kG, 1e-10);
  EXPECT_EQ(simulation.hash(), quiet.hash());
  simulation.step(5), quiet.step(5);
  EXPECT_EQ(simulation.hash(), quiet.hash()) << "asking changed the motion";
  simulation.set_state(1, {.position = {2, 2}});
  EXPECT_TRUE(simulation.forces().contacts.empty()) << "it hangs in the air";
  simulation.step();
  EXPECT_NEAR(simulation.state(1).position.y, 2 - 0.5 * kG / 3600, 1e-9);
}

// Forces are continuous where nothing strikes: those at the start are those a microsecond later.
TEST(PreciseForces, AtTheStartAreThoseOfTheNextInstant) {
  std::mt19937 random_bits(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random_bits()) / 4294967296.0;
  };
  const auto chance = [&] { return between(0, 1) < 0.5; };
  for (int trial = 0; trial < 40; ++trial) {
    Scene scene{.name = "mixed", .gravity = {between(-3, 3), -kG}};
    scene.bodies = {ground(between(0, 1))};
    const int blocks = 1 + trial % 3;
    for (int i = 0; i < blocks; ++i) {
      scene.bodies.push_back(block("block" + std::to_string(i), {2.0 * i, 0.5}, 1, 1, between(0, 1)));
      scene.bodies.back().velocity = {chance() ? 0 : between(-2, 2), 0};
    }
    scene.bodies.push_back({.name = "arm", .position = {1, 9}, .mass = between(1, 3), .inertia = 1});
    RevoluteJoint hinge{"hinge", std::string(kWorld), "arm", {0, 9}, {-1, 0}, false};
    if (chance()) hinge.limits = Range{0, 1};
    if (chance()) hinge.motor = Motor{.speed = 0, .max_force = between(1, 60)};
    scene.joints = {hinge};
    Simulation simulation = compile(scene, Precise{.tolerance = 1e-9, .max_dt = 1e-6});
    const Reactions first = simulation.forces();
    simulation.step();
    const Reactions next = simulation.forces();
    ASSERT_EQ(first.contacts.size(), next.contacts.size()) << trial;
    for (std::size_t i = 0; i < first.contacts.size(); ++i) {
      EXPECT_NEAR(first.contacts[i].normal_force, next.contacts[i].normal_force, 1e-3) << trial;
      EXPECT_NEAR(first.contacts[i].tangent_force, next.contacts[i].tangent_force, 1e-3) << trial;
    }
    expect_force(first.joints[0].force, next.joints[0].force, 1e-3);
    EXPECT_NEAR(first.joints[0].torque, next.joints[0].torque, 1e-3) << trial;
  }
}

TEST(PreciseForces, FixedStepsSayThatTheyHaveNone) {
  const Simulation realtime = compile(rods(1));
  try {
    (void)realtime.forces();
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Unsupported);
    EXPECT_NE(std::string(error.what()).find("plumb-precise"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace plumb
