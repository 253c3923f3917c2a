// The judges, with motions that are right or wrong by construction.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/hunt/examine.h"
#include "harness/hunt/outline.h"
#include "harness/hunt/relations.h"

namespace plumb::harness::hunt {
namespace {

const Engine& world() {
  static const Engine engine(reference::find_backend("plumb-float"));
  return engine;
}

Case falling() {
  Case one;
  one.scene = {.name = "a ball falls", .gravity = {0, -10}};
  one.scene.bodies = {{.name = "ball", .position = {0, 5}, .shapes = {{.geometry = Circle{0.5}}}}};
  one.steps = 60;
  return one;
}

/// The motion that `state` says, sampled as a run is.
template <class State>
Motion made_up(const Case& one, const State& state) {
  Motion out{.dt = one.dt};
  for (int k = 0; k <= one.steps; ++k) {
    Sample sample;
    for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
      sample.states.push_back(state(i, k * one.dt));
      sample.present.push_back(true);
      sample.asleep.push_back(false);
    }
    out.samples.push_back(std::move(sample));
  }
  return out;
}

TEST(Laws, AFallKeepsThemAll) {
  const Case one = falling();
  const Motion motion = made_up(one, [](std::size_t, double t) {
    return BodyState{.position = {0, 5 - 5 * t * t}, .velocity = {0, -10 * t}};
  });
  for (const Law& law : laws()) EXPECT_FALSE(law.judge(one, world(), motion)) << law.name;
}

TEST(Laws, WhatFallsTooFastHasGainedEnergyAndMomentum) {
  const Case one = falling();
  const Motion motion = made_up(one, [](std::size_t, double t) {
    return BodyState{.position = {0, 5 - 5 * t * t}, .velocity = {0, -11 * t}};
  });
  EXPECT_TRUE(energy_law(one, world(), motion));
  EXPECT_TRUE(momentum_law(one, world(), motion));
}

TEST(Laws, ABodyThatStartsToSpinByItselfBreaksTheLawOfAngularMomentum) {
  Case one = falling();
  one.scene.gravity = {0, 0};
  const Motion motion = made_up(one, [](std::size_t, double t) {
    return BodyState{.position = {0, 5}, .angular_velocity = t};
  });
  EXPECT_TRUE(angular_momentum_law(one, world(), motion));
  EXPECT_FALSE(momentum_law(one, world(), motion));
}

TEST(Laws, RoundingsOfWhatIsAtRestAreNoMomentum) {
  Case one = falling();
  one.scene.gravity = {0, 0};
  const auto drifts = [](double speed) {
    return [speed](std::size_t, double t) {
      return BodyState{.position = {speed * t, 5},
                       .velocity = {t > 0 ? speed : 0, 0},
                       .angular_velocity = t > 0 ? speed : 0};
    };
  };
  EXPECT_FALSE(momentum_law(one, world(), made_up(one, drifts(1e-9))));
  EXPECT_FALSE(angular_momentum_law(one, world(), made_up(one, drifts(1e-9))));
  EXPECT_TRUE(momentum_law(one, world(), made_up(one, drifts(1e-2))));
  EXPECT_TRUE(angular_momentum_law(one, world(), made_up(one, drifts(1e-2))));
}

TEST(Laws, ARopeIsJudgedUntilItsLoadIsAtThePulley) {
  Case one = falling();
  one.scene.bodies.push_back({.name = "other", .position = {2, 5}, .shapes = {{.geometry = Circle{0.5}}}});
  one.scene.joints = {PulleyJoint{
      .name = "rope", .body_a = "ball", .body_b = "other", .ground_a = {0, 6}, .ground_b = {2, 8}}};
  // The first goes up by itself; later both of them are where the rope has its length of 4 m no more.
  const auto rises = [](double speed) {
    return [speed](std::size_t i, double t) {
      return BodyState{.position = {i == 0 ? 0.0 : 2.0, i == 0 ? 5 + speed * t : 5.0},
                       .velocity = {0, i == 0 ? speed : 0}};
    };
  };
  EXPECT_TRUE(joint_gap_law(one, world(), made_up(one, rises(0.5))));
  EXPECT_FALSE(joint_gap_law(one, world(), made_up(one, rises(30))));
}

TEST(Laws, ShapesThatStayInEachOtherAreSeenAndThoseThatPartAreNot) {
  Case one = falling();
  one.scene.bodies.push_back({.name = "floor",
                              .type = BodyType::Static,
                              .position = {0, -0.5},
                              .shapes = {{.geometry = Box{10, 1}}}});
  const auto sunk = [](double depth) {
    return [depth](std::size_t i, double t) {
      return BodyState{.position = i == 0 ? Vec2d{0, t < 0.1 ? 0.6 : 0.5 - depth} : Vec2d{0, -0.5}};
    };
  };
  EXPECT_TRUE(penetration_law(one, world(), made_up(one, sunk(0.3))));
  EXPECT_FALSE(penetration_law(one, world(), made_up(one, sunk(0.005))));
}

// A box sleeps on a tile whose middle is 6 m off the origin of its body.
TEST(Laws, StaticBodiesAreWhereTheirOriginsAre) {
  Case one = falling();
  one.scene.bodies.front().position = {-16, 0.5};
  one.scene.bodies.front().shapes = {{.geometry = Box{2, 1}}};
  one.scene.bodies.push_back({.name = "floor",
                              .type = BodyType::Static,
                              .position = {-22, -1},
                              .shapes = {{.geometry = Box{3, 2}, .position = {6, 0}}}});
  one.steps = 120, one.sleeping = true;
  const Motion motion = run(world(), one);
  EXPECT_EQ(motion.samples.back().states.back().position, (Vec2d{-22, -1}));
  EXPECT_TRUE(motion.samples.back().asleep.front());
  EXPECT_FALSE(sleep_law(one, world(), motion));
}

TEST(Laws, AnOpenJointIsSeen) {
  Case one = falling();
  one.scene.joints = {
      RevoluteJoint{.name = "pin", .body_a = std::string(kWorld), .body_b = "ball", .anchor_a = {0, 5}}};
  EXPECT_FALSE(joint_gap_law(one, world(), made_up(one, [](std::size_t, double) {
                               return BodyState{.position = {0, 5}};
                             })));
  EXPECT_TRUE(joint_gap_law(one, world(), made_up(one, [](std::size_t, double t) {
                              return BodyState{.position = {0, 5 - t}, .velocity = {0, -1}};
                            })));
}

TEST(Laws, AJointThatAMovingPlatformTearsOpenIsNotJudged) {
  Case one;
  one.scene.bodies = {{.name = "bar", .position = {0.5, 1}, .shapes = {{.geometry = Box{1, 0.2}}}},
                      {.name = "platform",
                       .type = BodyType::Kinematic,
                       .position = {0, 0},
                       .velocity = {0, 1},
                       .shapes = {{.geometry = Box{4, 0.2}}}}};
  one.scene.joints = {
      WeldJoint{.name = "held", .body_a = "", .body_b = "bar", .anchor_a = {0, 1}, .anchor_b = {-0.5, 0}}};
  one.steps = 120;
  // The bar is carried once the platform has reached it, or moves without anything that pushes it.
  const auto carried_from = [](double start) {
    return [start](std::size_t body, double t) {
      const double rise = std::max(t - start, 0.0);
      return body == 0 ? BodyState{.position = {0.5, 1 + rise}} : BodyState{.position = {0, t}};
    };
  };
  EXPECT_FALSE(joint_gap_law(one, world(), made_up(one, carried_from(0.81))));
  EXPECT_TRUE(joint_gap_law(one, world(), made_up(one, carried_from(0.2))));
}

TEST(Laws, GapsBetweenPointsAreHeldAgainstTheScene) {
  Case one;
  one.scene = {.name = "two points and a ball", .gravity = {0, 0}};
  one.scene.bodies = {{.name = "a", .position = {0, 0}},
                      {.name = "b", .position = {1, 0}},
                      {.name = "ball", .position = {3, 0}, .shapes = {{.geometry = Circle{0.5}}}}};
  one.scene.joints = {DistanceJoint{.name = "rod", .body_a = "a", .body_b = "b", .length = 1}};
  one.steps = 30;
  const auto stretched = [](double by) {
    return [by](std::size_t i, double t) {
      return BodyState{.position = {i == 0 ? 0 : i == 1 ? 1 + (t > 0 ? by : 0) : 3, 0}};
    };
  };
  EXPECT_FALSE(joint_gap_law(one, world(), made_up(one, stretched(1e-6))));
  EXPECT_TRUE(joint_gap_law(one, world(), made_up(one, stretched(0.1))));
}

TEST(Laws, ExpectationsAreHeldAgainstTheStates) {
  Case one = falling();
  one.expectations = {
      {.name = "stays", .body = "ball", .quantity = Quantity::Y, .lower = 4, .why = "it does"}};
  const auto fall = [](std::size_t, double t) { return BodyState{.position = {0, 5 - 5 * t * t}}; };
  const Verdict verdict = expectation_law(one, world(), made_up(one, fall));
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->judge, "stays");
  one.expectations.front().to = 0.2;
  EXPECT_FALSE(expectation_law(one, world(), made_up(one, fall)));
}

TEST(Outline, DistancesAreThoseOfGeometry) {
  const auto at = [](const Geometry& geometry, Vec2d position, double angle = 0) {
    return placed(outlines_of({.geometry = geometry}).front(), {.position = position, .angle = angle});
  };
  const Outline box = at(Box{2, 2}, {0, 0});
  EXPECT_NEAR(separation(box, at(Circle{0.5}, {3, 0})), 1.5, 1e-12);
  EXPECT_NEAR(separation(box, at(Circle{0.5}, {2, 2})), std::sqrt(2.0) - 0.5, 1e-12);
  EXPECT_NEAR(separation(box, at(Circle{0.5}, {1, 0})), -0.5, 1e-12);
  EXPECT_NEAR(separation(box, at(Box{2, 2}, {1.5, 0})), -0.5, 1e-12);
  EXPECT_NEAR(separation(box, at(Box{1, 1}, {3, 0}, M_PI / 4)), 2 - std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(separation(box, at(Capsule{{-1, 0}, {1, 0}, 0.25}, {0, 2})), 0.75, 1e-12);
  EXPECT_NEAR(separation(at(Circle{0.5}, {0, 0}), at(Circle{0.25}, {0.6, 0.8})), 0.25, 1e-12);
  EXPECT_NEAR(separation(at(Circle{0.5}, {0, 0}), at(Circle{0.25}, {0.3, 0.4})), -0.25, 1e-12);
  const Capsule link{{-0.5, 0}, {0.5, 0}, 0.1};
  EXPECT_NEAR(separation(at(link, {0, 0}, 0.3), at(link, 1.5 * Vec2d{std::cos(0.3), std::sin(0.3)}, 0.3)),
              0.3, 1e-12)
      << "in a row, but for rounding";
  EXPECT_NEAR(width_of(outlines_of({.geometry = Box{3, 0.5}}).front()), 0.5, 1e-12);
}

TEST(Laws, PreciseMayBeOffByItsToleranceAndNoMore) {
  const Engine precise(reference::find_backend("plumb-precise"));
  Case one = falling();
  one.scene.bodies.front().position = {0, 0.5};
  one.scene.bodies.push_back({.name = "floor",
                              .type = BodyType::Static,
                              .position = {0, -0.5},
                              .shapes = {{.geometry = Box{10, 1}}}});
  const auto at_rest = [](double creep) {
    return [creep](std::size_t i, double t) {
      return BodyState{.position = {creep * t, i == 0 ? 0.5 : -0.5}, .velocity = {creep, 0}};
    };
  };
  Motion motion = made_up(one, at_rest(1e-9));
  motion.samples.front() = made_up(one, at_rest(0)).samples.front();
  EXPECT_FALSE(energy_law(one, precise, motion));
  motion = made_up(one, at_rest(1e-2));
  motion.samples.front() = made_up(one, at_rest(0)).samples.front();
  EXPECT_TRUE(energy_law(one, precise, motion));
}

TEST(Examine, AnEngineThatSaysWhyItStopsIsNotWrong) {
  Case one = falling();
  one.scene.bodies.push_back(one.scene.bodies.front());
  one.scene.bodies.back().name = "another", one.scene.bodies.back().position.x = 0.3;
  const Engine precise(reference::find_backend("plumb-precise"));
  const Motion motion = run(precise, one);
  EXPECT_NE(motion.stopped.find("overlap"), std::string::npos) << motion.stopped;
  EXPECT_FALSE(finite_law(one, precise, motion));
}

// A rod falls on a table with friction and bounces: Newton's law would make energy, and Precise keeps it.
TEST(Examine, PreciseMakesNoEnergyWhereNewtonsLawWould) {
  Case one = falling();
  Body& rod = one.scene.bodies.front();
  rod.angle = 90, rod.position = {-2, 1}, rod.velocity = {-2, -3};
  rod.shapes = {{.geometry = Capsule{{-0.35, 0}, {0.35, 0}, 0.2}, .friction = 0.6, .restitution = 1}};
  one.scene.bodies.push_back({.name = "table",
                              .type = BodyType::Static,
                              .position = {-2, -2},
                              .shapes = {{.geometry = Box{2, 2}, .friction = 0.6}}});
  const Engine precise(reference::find_backend("plumb-precise"));
  EXPECT_FALSE(energy_law(one, precise, run(precise, one)));
  EXPECT_TRUE(examine(world(), one, "precise").objections.empty());
  EXPECT_TRUE(examine(world(), one, "jury").objections.empty());
}

// A box falls on its corner and bounces without friction: Box2D and Bullet are 0.3 m and 0.15 m off, and
// nearer to each other than a step's way.
TEST(Examine, RivalsThatLeaveThemselvesWithHalfTheStepAreNoJury) {
  Case one = falling();
  Body& box = one.scene.bodies.front();
  box.position = {-1.5, 2.876}, box.angle = -109.62815022205297, box.angular_velocity = -6.88;
  box.shapes = {{.geometry = Box{0.4, 0.37768}, .friction = 0, .restitution = 0.8}};
  one.scene.gravity = {0, -9.81};
  one.scene.bodies.push_back({.name = "floor",
                              .type = BodyType::Static,
                              .position = {0, -0.1},
                              .shapes = {{.geometry = Box{6.5, 0.25}, .friction = 0}}});
  one.steps = 90;
  const Examined seen = examine(Engine(reference::find_backend("plumb-precise")), one, "jury");
  EXPECT_TRUE(seen.objections.empty()) << seen.objections.front().what;
}

TEST(Examine, ABallThatIsAtRestOnTheGroundIsRightInEveryEngine) {
  Case one = falling();
  one.scene.bodies.front().position = {0, 0.5};
  one.scene.bodies.push_back({.name = "floor",
                              .type = BodyType::Static,
                              .position = {0, -0.5},
                              .shapes = {{.geometry = Box{10, 1}}}});
  for (const char* name : {"plumb-float", "plumb", "plumb-precise"}) {
    const Engine engine(reference::find_backend(name));
    for (const std::string& judge : judge_names()) {
      const Examined seen = examine(engine, one, judge);
      EXPECT_TRUE(seen.skipped.empty()) << seen.skipped;
      for (const Objection& objection : seen.objections)
        ADD_FAILURE() << name << ": " << judge << ": " << objection.what;
    }
  }
}

// A light body is pulled at a point 5 m beside its centre: it turns by several rad within a step, and no
// method of fixed steps knows where the force points then.
TEST(Relations, ForcesThatTurnWithABodyAreKnownWhileItTurnsLittleInAStep) {
  Case one;
  one.scene = {.name = "pulled beside its centre", .gravity = {0, 0}};
  one.scene.bodies = {
      {.name = "heavy",
       .position = {3, 1.384},
       .velocity = {2.452, 2.837},
       .mass = 0.9979,
       .shapes = {{.geometry = Circle{0.5}, .filter = {.group = -1}}}},
      {.name = "light",
       .position = {6, -1.976},
       .angle = 0.372,
       .velocity = {-2.978, -1.996},
       .angular_velocity = 1.1,
       .mass = 0.05513,
       .shapes = {{.geometry = Capsule{{-0.28168, 0}, {0.28168, 0}, 0.04362}, .filter = {.group = -1}}}}};
  one.scene.forces = {AttractionForce{.body = "heavy",
                                      .centre_body = "light",
                                      .centre = {0.1748, 5.025},
                                      .strength = 8.254,
                                      .exponent = 2},
                      QuadraticDrag{.body = "light", .coefficient = 0.0055}};
  one.dt = 1.0 / 30, one.steps = 4;
  EXPECT_FALSE(integrated_relation(one, world(), run(world(), one)));
  const Engine precise(reference::find_backend("plumb-precise"));
  EXPECT_FALSE(integrated_relation(one, precise, run(precise, one)));
}

// A spring drives a disc 63 mm into the floor within a step. A World pushes it out at a limited speed, whose
// unit is the extent a second.
TEST(Relations, UnitsAreJudgedUntilBodiesArePushedApart) {
  Case one;
  one.scene = {.name = "on a spring", .gravity = {0, -20}};
  const Body bar{.name = "bar", .position = {0, 9.368}, .mass = 45.6, .inertia = 5.25};
  one.scene.bodies = {{.name = "floor",
                       .type = BodyType::Static,
                       .position = {0, -2},
                       .shapes = {{.geometry = Box{4, 4}, .friction = 0, .restitution = 0}}},
                      {.name = "disc",
                       .position = {0, 7.768},
                       .mass = 45.6,
                       .shapes = {{.geometry = Circle{0.48}, .friction = 0, .restitution = 0.8}}},
                      bar,
                      bar};
  one.scene.bodies[2].name = "lower", one.scene.bodies[3].name = "upper";
  one.scene.bodies[3].position.y = 10.968;
  one.scene.joints = {
      WeldJoint{.name = "spring",
                .body_a = "disc",
                .body_b = "lower",
                .anchor_a = {0, 0.8},
                .anchor_b = {0, -0.8},
                .linear_spring = Spring{.hertz = 50, .damping_ratio = 0.5}},
      WeldJoint{
          .name = "weld", .body_a = "lower", .body_b = "upper", .anchor_a = {0, 0.8}, .anchor_b = {0, -0.8}}};
  one.dt = 1.0 / 120, one.substeps = 16, one.steps = 256;
  for (const char* name : {"plumb-float", "plumb"})
    EXPECT_TRUE(examine(Engine(reference::find_backend(name)), one, "units").objections.empty()) << name;
}

// A capsule stands on its end at a wall: it has lost all perturbations of its start in blows, and rounding
// alone says when it falls.
TEST(Relations, WhatComesToStandOnItsEndIsNotHeldAgainstATighterTolerance) {
  const Engine precise(reference::find_backend("plumb-precise"));
  Case one;
  one.scene = {.name = "stands at a wall", .gravity = {0, -10}};
  const auto add = [&](Body body, const Geometry& geometry) {
    body.shapes = {{.geometry = geometry, .friction = 0, .restitution = 0}};
    one.scene.bodies.push_back(body);
  };
  add({.name = "floor", .type = BodyType::Static, .position = {0, -0.02}}, Box{1.08, 0.04});
  add({.name = "wall", .type = BodyType::Static, .position = {0.5, 0.5}}, Box{0.04, 1.08});
  add({.name = "capsule", .position = {0.23, 0.38}, .angle = 64 - 20 * M_PI, .velocity = {2.2, -1.2}},
      Capsule{{-0.027412, 0}, {0.027412, 0}, 0.006390912});
  one.steps = 128;
  const Motion motion = run(precise, one);
  ASSERT_EQ(motion.samples.size(), 129u);
  const double upright = std::abs(std::sin(motion.samples[60].states.back().angle));
  ASSERT_NEAR(upright, 1, 1e-6);
  EXPECT_TRUE(examine(precise, one, "tolerance").objections.empty());
  EXPECT_TRUE(examine(precise, one, "sampling").objections.empty());
}

}  // namespace
}  // namespace plumb::harness::hunt
