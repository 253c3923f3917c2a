#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/driver/sensitivity.h"
#include "engine/scene/number.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/contact_scenes.h"

// Derivatives of runs of Precise, against closed forms, and against differences of runs at tolerance 1e-12.
namespace plumb {
namespace {

using Names = std::vector<std::string>;

std::array<double, 6> numbers_of(const BodyState& s) {
  return {s.position.x, s.position.y, s.angle, s.velocity.x, s.velocity.y, s.angular_velocity};
}

Simulation derived_run(const Scene& scene, const Names& names, double time, double tolerance = 1e-12) {
  const int steps = static_cast<int>(std::ceil(time * 60));
  Simulation run =
      compile(scene, Precise{.tolerance = tolerance, .max_dt = time / steps}, {.parameters = names});
  run.step(steps);
  return run;
}

std::vector<BodyState> states_with(Scene scene, const std::string& name, double change, double time) {
  for (double* number : numbers_at(scene, name)) *number += change;
  const int steps = static_cast<int>(std::ceil(time * 60));
  Simulation run = compile(scene, Precise{.tolerance = 1e-12, .max_dt = time / steps});
  // States set from outside may open joints, which are then closed.
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    run.set_state(body, initial_state(scene.bodies[body]));
  run.step(steps);
  std::vector<BodyState> states(run.body_count());
  run.read(states);
  return states;
}

/// Expects derivatives by all parameters to be fourth-order differences of runs, to 1e-6 of the largest.
void expect_differences_of_runs(const Scene& scene, const Names& names, double time, double step = 2e-4) {
  const Simulation run = derived_run(scene, names, time);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const std::vector<BodyState> found = run.sensitivities(j);
    std::vector<std::vector<BodyState>> beside;
    for (const int k : {-2, -1, 1, 2}) beside.push_back(states_with(scene, names[j], k * step, time));
    double largest = 1;
    for (const BodyState& s : found)
      for (const double x : numbers_of(s)) largest = std::max(largest, std::abs(x));
    for (std::size_t body = 0; body < found.size(); ++body) {
      for (std::size_t i = 0; i < 6; ++i) {
        const auto at = [&](std::size_t k) { return numbers_of(beside[k][body])[i]; };
        const double difference = (at(0) - at(3) + 8 * (at(2) - at(1))) / (12 * step);
        EXPECT_NEAR(numbers_of(found[body])[i], difference, 1e-6 * largest)
            << names[j] << ", body " << body << ", component " << i;
      }
    }
  }
}

/// Returns the reason why a derivative does not exist.
NoDerivative reason_of(const Scene& scene, const std::string& name, double time) {
  const Simulation run = derived_run(scene, {name}, time);
  try {
    run.sensitivities(0);
  } catch (const NotDifferentiable& error) {
    return error.reason();
  }
  ADD_FAILURE() << "there is a derivative by " << name;
  return NoDerivative::Singular;
}

Scene falling_ball(double height, double restitution) {
  Scene scene{.name = "ball"};
  scene.bodies = {ground(0), disc("ball", {0, height}, {0.3, 0}, 0.5, 0, restitution)};
  return scene;
}

TEST(Sensitivities, FlightObeysItsFormula) {
  Scene scene{.name = "flight"};
  scene.bodies = {ball("ball", {0, 10}, {1, 2})};
  scene.bodies[0].angular_velocity = 3;
  const double t = 0.8;
  const Simulation run = derived_run(scene,
                                     {"gravity.y", "bodies.ball.velocity.x", "bodies.ball.position.y",
                                      "bodies.ball.angular_velocity", "bodies.ball.mass"},
                                     t);
  EXPECT_NEAR(run.sensitivities(0)[0].position.y, t * t / 2, 1e-11);
  EXPECT_NEAR(run.sensitivities(0)[0].velocity.y, t, 1e-11);
  EXPECT_NEAR(run.sensitivities(1)[0].position.x, t, 1e-11);
  EXPECT_NEAR(run.sensitivities(1)[0].velocity.x, 1, 1e-11);
  EXPECT_NEAR(run.sensitivities(2)[0].position.y, 1, 1e-11);
  EXPECT_NEAR(run.sensitivities(3)[0].angle, t, 1e-11);
  EXPECT_NEAR(run.sensitivities(4)[0].position.y, 0, 1e-11);
}

// After the first bounce, at t1 = sqrt(2 h / g) with speed u = g t1, y = e u (t - t1) - g (t - t1)^2 / 2.
TEST(Sensitivities, ABounceMovesItsTimeAndItsSpeed) {
  const double h = 2, e = 0.7, g = 9.81, t = 0.9, t1 = std::sqrt(2 * h / g), u = g * t1, s = t - t1;
  const Simulation run = derived_run(
      falling_ball(h + 0.5, e),
      {"bodies.ball.position.y", "bodies.ball.shapes.restitution", "gravity.y", "bodies.ground.position.y"},
      t);
  const double t1_h = t1 / (2 * h), u_h = g * t1_h, t1_g = -t1 / (2 * g), u_g = t1 + g * t1_g;
  const BodyState by_height = run.sensitivities(0)[1], by_e = run.sensitivities(1)[1],
                  by_gravity = run.sensitivities(2)[1], by_floor = run.sensitivities(3)[1];
  EXPECT_NEAR(by_height.position.y, e * u_h * s - e * u * t1_h + g * s * t1_h, 1e-10);
  EXPECT_NEAR(by_height.velocity.y, e * u_h + g * t1_h, 1e-10);
  EXPECT_NEAR(by_e.position.y, u * s, 1e-10);
  EXPECT_NEAR(by_e.velocity.y, u, 1e-10);
  // gravity.y is minus g.
  EXPECT_NEAR(-by_gravity.position.y, e * u_g * s - e * u * t1_g - s * s / 2 + g * s * t1_g, 1e-9);
  EXPECT_NEAR(by_floor.position.y, 1 - by_height.position.y, 1e-9);
}

TEST(Sensitivities, ManyBouncesAreDifferencesOfRuns) {
  expect_differences_of_runs(falling_ball(1.5, 0.8),
                             {"bodies.ball.position.y", "bodies.ball.velocity.y", "bodies.ball.velocity.x",
                              "bodies.ball.shapes.restitution", "bodies.ball.shapes.radius", "gravity.y"},
                             2.5, 1e-4);
}

/// A disc with spin that strikes a rough floor once.
Scene oblique_impact(double speed, double friction, ImpactRule rule = ImpactRule::Newton) {
  Scene scene{.name = "oblique"};
  scene.contact_rules.impact = rule;
  scene.bodies = {ground(friction), disc("disc", {0, 1.2}, {speed, -1}, 0.5, friction, 0.6)};
  scene.bodies[1].angular_velocity = -0.7;
  return scene;
}

const Names kOfImpact{"bodies.disc.position.y",
                      "bodies.disc.velocity.x",
                      "bodies.disc.velocity.y",
                      "bodies.disc.angular_velocity",
                      "bodies.disc.mass",
                      "bodies.disc.shapes.friction",
                      "bodies.disc.shapes.radius",
                      "bodies.disc.shapes.restitution",
                      "gravity.x",
                      "gravity.y"};

TEST(Sensitivities, AnObliqueImpactThatSlipsIsADifferenceOfRuns) {
  expect_differences_of_runs(oblique_impact(6, 0.2), kOfImpact, 0.7);
}

TEST(Sensitivities, AnObliqueImpactThatSticksIsADifferenceOfRuns) {
  expect_differences_of_runs(oblique_impact(1, 0.8), kOfImpact, 0.7);
}

TEST(Sensitivities, ImpactsByRouthsMethodAreDifferencesOfRuns) {
  for (const ImpactRule rule : {ImpactRule::Poisson, ImpactRule::Stronge}) {
    expect_differences_of_runs(oblique_impact(6, 0.2, rule), kOfImpact, 0.7);
    expect_differences_of_runs(oblique_impact(1, 0.8, rule), kOfImpact, 0.7);
  }
}

/// A capsule of 70 mm x 50 mm that is thrown onto a floor at an angle: eccentric impacts, as an ellipse's.
TEST(Sensitivities, EccentricImpactsOfALongBodyAreDifferencesOfRuns) {
  for (const ImpactRule rule : {ImpactRule::Newton, ImpactRule::Stronge}) {
    Scene scene{.name = "capsule"};
    scene.contact_rules = {.impact = rule,
                           .yield_speed = rule == ImpactRule::Stronge ? 0.5 : 0,
                           .friction_after_stop = rule == ImpactRule::Stronge ? 0.75 : 1};
    Body body{.name = "body",
              .position = {0, 0.12},
              .angle = 0.6,
              .velocity = {0.6, -1.5},
              .angular_velocity = 4,
              .mass = 0.03};
    body.shapes = {
        {.geometry = Capsule{{-0.01, 0}, {0.01, 0}, 0.025}, .friction = 0.19, .restitution = 0.55}};
    scene.bodies = {ground(0.19), body};
    Names names{"bodies.body.position.y",         "bodies.body.angle",
                "bodies.body.velocity.x",         "bodies.body.velocity.y",
                "bodies.body.angular_velocity",   "bodies.body.shapes.friction",
                "bodies.body.shapes.restitution", "gravity.y"};
    if (rule == ImpactRule::Stronge) {
      names.push_back("contact_rules.friction_after_stop");
      names.push_back("contact_rules.yield_speed");
    }
    expect_differences_of_runs(scene, names, 0.2, 1e-5);
  }
}

TEST(Sensitivities, ACollisionOfTwoBodiesIsADifferenceOfRuns) {
  Scene scene{.name = "two bodies", .gravity = {}};
  scene.bodies = {disc("a", {-2, 0.2}, {3, 0}, 0.5, 0.3, 0.5), disc("b", {1, 0}, {-1, 0.1}, 0.7, 0.3, 0.2)};
  scene.bodies[1].mass = 2.5;
  expect_differences_of_runs(
      scene,
      {"bodies.a.position.y", "bodies.a.velocity.x", "bodies.a.mass", "bodies.b.mass", "bodies.b.position.x",
       "bodies.a.shapes.friction", "bodies.b.shapes.radius", "bodies.a.shapes.restitution"},
      1.6);
}

/// A block that is thrown up a slope, comes to rest there, and slides back or sticks.
Scene block_on_slope(double angle, double friction) {
  Scene scene{.name = "slope", .gravity = gravity_on_ramp(angle)};
  scene.bodies = {ground(friction), block("block", {0, 0.25}, 1, 0.5, friction)};
  scene.bodies[1].velocity = {-2, 0};
  return scene;
}

TEST(Sensitivities, SlidingThatStopsAndSticksObeysItsFormula) {
  const double angle = 0.2, mu = 0.6, v = 2, g = 9.81;
  const Simulation run = derived_run(
      block_on_slope(angle, mu), {"bodies.block.velocity.x", "bodies.block.shapes.friction", "gravity.x"}, 1);
  // Up the slope, against gravity's component and friction: it stops after v^2 / (2 a) and sticks there.
  const double a = g * (std::sin(angle) + mu * std::cos(angle));
  const double of_mu = g * std::cos(angle) / 2;  // friction is the geometric mean of the two shapes'
  EXPECT_NEAR(run.sensitivities(0)[1].position.x, v / a, 1e-9);
  EXPECT_NEAR(run.sensitivities(1)[1].position.x, v * v / (2 * a * a) * of_mu, 1e-9);
  EXPECT_NEAR(run.sensitivities(2)[1].position.x, v * v / (2 * a * a), 1e-9);
  for (const std::size_t j : {0, 1, 2}) EXPECT_NEAR(run.sensitivities(j)[1].velocity.x, 0, 1e-9);
}

TEST(Sensitivities, SlidingThatTurnsRoundIsADifferenceOfRuns) {
  expect_differences_of_runs(block_on_slope(0.6, 0.3),
                             {"bodies.block.velocity.x", "bodies.block.shapes.friction", "gravity.x",
                              "gravity.y", "bodies.block.mass"},
                             1);
}

TEST(Sensitivities, ABlockThatBreaksLooseFromStaticFrictionIsADifferenceOfRuns) {
  Scene scene = block_on_slope(0, 0.4);
  scene.contact_rules.friction_while_sliding = 0.5;
  scene.bodies[1].velocity = {};
  scene.forces = {SinusoidalForce{.body = "block", .amplitude = {6, 0}, .angular_frequency = 1}};
  expect_differences_of_runs(scene,
                             {"contact_rules.friction_while_sliding", "bodies.block.shapes.friction",
                              "forces[0].amplitude.x", "forces[0].phase", "bodies.block.mass"},
                             1.5);
}

TEST(Sensitivities, SlidingThatBecomesRollingObeysItsFormula) {
  Scene scene{.name = "slide"};
  scene.bodies = {ground(0.2), disc("disc", {0, 0.5}, {5, 0}, 0.5, 0.2)};
  const Simulation run = derived_run(scene, {"bodies.disc.velocity.x", "bodies.disc.shapes.friction"}, 1.5);
  // It slips until t1 = v / (3 mu g), and rolls at 2 v / 3: x = 2 v t / 3 + v^2 / (18 mu g).
  const double v = 5, mu = 0.2, g = 9.81;
  EXPECT_NEAR(run.sensitivities(0)[1].velocity.x, 2.0 / 3, 1e-9);
  EXPECT_NEAR(run.sensitivities(0)[1].position.x, 1.0 + v / (9 * mu * g), 1e-9);
  EXPECT_NEAR(run.sensitivities(1)[1].velocity.x, 0, 1e-9);
  EXPECT_NEAR(run.sensitivities(1)[1].position.x, -v * v / (18 * mu * mu * g) / 2, 1e-9);
}

TEST(Sensitivities, APendulumByAHingeIsADifferenceOfRuns) {
  Scene scene = rods(2);
  scene.bodies[0].angular_velocity = 1;
  expect_differences_of_runs(scene,
                             {"gravity.y", "gravity.x", "bodies.rod0.mass", "bodies.rod1.inertia",
                              "bodies.rod0.angular_velocity", "bodies.rod1.angle"},
                             2);
}

TEST(Sensitivities, ClosedJointsOfAnyKindAreDifferencesOfRuns) {
  Scene scene{.name = "slider"};
  scene.bodies = {{.name = "cart", .position = {0, 0}, .mass = 2, .inertia = 1},
                  {.name = "bob", .position = {0.6, -0.8}, .mass = 1, .inertia = 0.1}};
  scene.joints = {
      PrismaticJoint{.name = "rail", .body_a = std::string(kWorld), .body_b = "cart", .axis = {1, 0}},
      RevoluteJoint{.name = "pin", .body_a = "cart", .body_b = "bob", .anchor_b = {-0.6, 0.8}}};
  scene.forces = {SpringForce{.body_a = std::string(kWorld),
                              .body_b = "cart",
                              .anchor_a = {-1.5, 0},
                              .rest_length = 1,
                              .stiffness = 30,
                              .damping = 0.4}};
  expect_differences_of_runs(
      scene,
      {"forces[0].stiffness", "forces[0].damping", "forces[0].rest_length", "bodies.cart.mass",
       "bodies.bob.mass", "gravity.y", "bodies.bob.angular_velocity"},
      1.5);
}

// The rope's length is that of the start.
TEST(Sensitivities, AStartFromWhichAJointTakesItsMeasureIsADifferenceOfRuns) {
  Scene scene{.name = "rope"};
  scene.bodies = {{.name = "light", .position = {-0.6, 2.5}, .mass = 1, .inertia = 0.1},
                  {.name = "heavy", .position = {0.6, 2.2}, .mass = 2, .inertia = 0.1}};
  scene.joints = {PulleyJoint{
      .name = "rope", .body_a = "light", .body_b = "heavy", .ground_a = {-0.6, 4}, .ground_b = {0.6, 4}}};
  expect_differences_of_runs(
      scene, {"bodies.light.position.y", "bodies.heavy.position.x", "bodies.heavy.velocity.y", "gravity.y"},
      0.3);
}

TEST(Sensitivities, ALimitOfAJointIsADifferenceOfRuns) {
  Scene scene = rods(1);
  std::get<RevoluteJoint>(scene.joints[0]).limits = Range{-1, 2};
  expect_differences_of_runs(
      scene, {"gravity.y", "bodies.rod0.angular_velocity", "joints.joint0.limits.lower"}, 0.9);
}

TEST(Sensitivities, ABodyThatSlidesOffAnEdgeIsADifferenceOfRuns) {
  Scene scene{.name = "table"};
  scene.bodies = {block("table", {0, -0.5}, 2, 1, 0.1), disc("disc", {0.5, 0.2}, {2, 0}, 0.2, 0.1)};
  scene.bodies[0].type = BodyType::Static;
  expect_differences_of_runs(scene,
                             {"bodies.disc.velocity.x", "bodies.disc.position.x", "gravity.y",
                              "bodies.disc.shapes.friction", "bodies.table.shapes[0].width"},
                             0.8);
}

TEST(Sensitivities, ASpringOnABouncingBodyIsADifferenceOfRuns) {
  Scene scene = falling_ball(1.0, 0.6);
  scene.forces = {SpringForce{
      .body_a = std::string(kWorld), .body_b = "ball", .anchor_a = {0, 4}, .rest_length = 2, .stiffness = 3}};
  expect_differences_of_runs(scene, {"forces[0].stiffness", "bodies.ball.mass", "bodies.ball.position.y"},
                             1.2);
}

TEST(Sensitivities, TheRunKeepsItsBits) {
  const Scene scene = oblique_impact(6, 0.2);
  EXPECT_EQ(derived_run(scene, {}, 0.7).hash(), derived_run(scene, kOfImpact, 0.7).hash());
}

TEST(Sensitivities, ASnapshotCarriesThem) {
  const Scene scene = oblique_impact(6, 0.2);
  const Precise precise{.tolerance = 1e-10, .max_dt = 0.05};
  const CompileOptions options{.parameters = kOfImpact};
  Simulation first = compile(scene, precise, options), second = compile(scene, precise, options);
  first.step(5);
  second.restore(first.save());
  first.step(9), second.step(9);
  for (std::size_t j = 0; j < kOfImpact.size(); ++j)
    EXPECT_EQ(first.sensitivities(j), second.sensitivities(j)) << kOfImpact[j];
}

// Two equal cranks on the ground turn a bar. The linkage is singular where they lie on the bar.
Scene parallelogram() {
  Scene scene{.name = "cranks"};
  const double angle = 0.7, speed = 8;
  const Vec2d tip{std::cos(angle), std::sin(angle)};
  scene.bodies.push_back({.name = "bar",
                          .position = Vec2d{0.5, 0} + tip,
                          .velocity = speed * perpendicular(tip),
                          .mass = 1,
                          .inertia = 1.0 / 12});
  for (int i = 0; i < 2; ++i) {
    const std::string name = "crank" + std::to_string(i);
    const Vec2d pivot{static_cast<double>(i), 0};
    scene.bodies.push_back({.name = name,
                            .position = pivot + 0.5 * tip,
                            .angle = angle,
                            .velocity = 0.5 * speed * perpendicular(tip),
                            .angular_velocity = speed,
                            .mass = 1,
                            .inertia = 1.0 / 12});
    scene.joints.push_back(
        RevoluteJoint{"ground" + std::to_string(i), std::string(kWorld), name, pivot, {-0.5, 0}, false});
    scene.joints.push_back(
        RevoluteJoint{"tip" + std::to_string(i), name, "bar", {0.5, 0}, pivot - Vec2d{0.5, 0}, false});
  }
  return scene;
}

void expect_singular(const Simulation& run) {
  try {
    run.sensitivities(0);
    ADD_FAILURE() << "there is a derivative beyond a singularity";
  } catch (const NotDifferentiable& error) {
    EXPECT_EQ(error.reason(), NoDerivative::Singular);
    EXPECT_LE(error.time(), run.time());
  }
}

TEST(Sensitivities, ALinkageThatLeaptOverASingularityHasNoneRightAfter) {
  const Precise precise{.tolerance = 1e-8, .max_dt = 1e-3};
  const CompileOptions options{.parameters = {"gravity.y"}};
  Simulation run = compile(parallelogram(), precise, options),
             other = compile(parallelogram(), precise, options);
  while (run.statistics().leaps == 0 && run.time() < 0.5) run.step(1);
  ASSERT_EQ(run.statistics().leaps, 1);
  expect_singular(run);
  other.restore(run.save());
  expect_singular(other);
  run.step(30), other.step(30);
  expect_singular(run);
  expect_singular(other);
}

TEST(Sensitivities, AskingForThemChangesNothing) {
  const Scene scene = oblique_impact(6, 0.2);
  const Precise precise{.tolerance = 1e-10, .max_dt = 0.05};
  Simulation asked = compile(scene, precise, {.parameters = kOfImpact});
  Simulation silent = compile(scene, precise, {.parameters = kOfImpact});
  for (int i = 0; i < 14; ++i) {
    asked.step(1), silent.step(1);
    for (std::size_t j = 0; j < kOfImpact.size(); ++j) asked.sensitivities(j);
    EXPECT_EQ(asked.save(), silent.save()) << i;
  }
}

TEST(Sensitivities, AnEstimateOfTheErrorLeavesThemAsTheyAre) {
  const Scene scene = oblique_impact(6, 0.2);
  const CompileOptions options{.parameters = kOfImpact};
  Simulation alone = compile(scene, Precise{.max_dt = 0.05}, options);
  Simulation estimated = compile(scene, Precise{.max_dt = 0.05, .estimate_error = true}, options);
  alone.step(14), estimated.step(14);
  for (std::size_t j = 0; j < kOfImpact.size(); ++j)
    EXPECT_EQ(alone.sensitivities(j), estimated.sensitivities(j)) << kOfImpact[j];
}

TEST(Sensitivities, AStateSetFromOutsideDependsOnNothingBefore) {
  Simulation run = compile(falling_ball(5, 0.5), Precise{.max_dt = 0.1}, {.parameters = {"gravity.y"}});
  run.step(2);
  run.set_state(1, {{0, 5}, 0, {}, 0});
  EXPECT_EQ(run.sensitivities(0)[1], BodyState{});
  run.step(3);
  EXPECT_NEAR(run.sensitivities(0)[1].position.y, 0.3 * 0.3 / 2, 1e-10);
}

// At the speed at which friction just stops the slip the impact has a kink.
TEST(Sensitivities, AKinkOfAnImpactIsAnError) {
  // A disc sticks up to a slip of 3 mu (1 + e) u.
  const double u = std::sqrt(1 + 2 * 9.81 * 0.7), mu = 0.2, e = 0.6;
  Scene scene = oblique_impact(3 * mu * (1 + e) * u, mu);
  scene.bodies[1].angular_velocity = 0;
  EXPECT_EQ(reason_of(scene, "bodies.disc.velocity.x", 0.5), NoDerivative::Kink);
  scene.bodies[1].velocity.x *= 1.001;
  expect_differences_of_runs(scene, {"bodies.disc.velocity.x"}, 0.5, 1e-5);
}

TEST(Sensitivities, AGrazingContactIsAnError) {
  Scene scene{.name = "graze"};
  // A disc at the top of its flight meets the underside of a beam.
  scene.bodies = {block("beam", {0, 2}, 4, 1, 0), disc("disc", {0, 0}, {0, 0}, 0.5, 0, 0.5)};
  scene.bodies[0].type = BodyType::Static;
  scene.bodies[1].velocity.y = std::sqrt(2 * 9.81 * 1.0);
  Simulation run = compile(scene, Precise{.max_dt = 0.05}, {.parameters = {"bodies.disc.velocity.y"}});
  bool met = false;
  try {
    run.step(12);
    met = run.statistics().impacts > 0;
    run.sensitivities(0);
  } catch (const NotDifferentiable& error) {
    EXPECT_EQ(error.reason(), NoDerivative::Grazing);
    return;
  }
  ADD_FAILURE() << "a grazing contact has a derivative; an impact: " << met;
}

TEST(Sensitivities, SimultaneousImpactsThatAParameterSeparatesAreAnError) {
  Scene scene{.name = "flat"};
  scene.bodies = {ground(0.3), block("block", {0, 1}, 1, 0.5, 0.3, 0.4)};
  EXPECT_EQ(reason_of(scene, "bodies.block.angle", 0.5), NoDerivative::Simultaneous);
  // The height moves both corners alike.
  expect_differences_of_runs(
      scene, {"bodies.block.position.y", "gravity.y", "bodies.block.shapes.restitution"}, 0.5);
}

// Of two wheels that reach their motors' speed at once the parameter makes one earlier.
TEST(Sensitivities, MotorsThatReachTheirSpeedAtOnceAndAreSeparatedAreAnError) {
  Scene scene{.name = "two wheels", .gravity = {0, 0}};
  for (const char* name : {"left", "right"}) {
    const double x = scene.bodies.empty() ? -1 : 1;
    scene.bodies.push_back({.name = name, .position = {x, 0}, .mass = 1, .inertia = 0.2});
  }
  scene.bodies.push_back({.name = "frame", .position = {0, 0.5}, .mass = 1, .inertia = 0.5});
  for (std::size_t i = 0; i < 2; ++i)
    scene.joints.push_back(RevoluteJoint{.name = "pin" + std::to_string(i),
                                         .body_a = "frame",
                                         .body_b = scene.bodies[i].name,
                                         .anchor_a = {scene.bodies[i].position.x, -0.5},
                                         .motor = Motor{.speed = 8, .max_force = 16}});
  EXPECT_EQ(reason_of(scene, "bodies.right.angular_velocity", 0.2), NoDerivative::Simultaneous);
  // A heavier frame delays both alike.
  expect_differences_of_runs(scene, {"bodies.frame.inertia"}, 0.2);
}

TEST(Sensitivities, TheLimitOfBouncesIsAnError) {
  EXPECT_EQ(reason_of(falling_ball(1, 0.3), "gravity.y", 2), NoDerivative::Zeno);
}

TEST(Sensitivities, AContactOfTheStartThatOpensIsAnError) {
  const Scene scene = block_on_slope(0.2, 0.6);
  EXPECT_EQ(reason_of(scene, "bodies.block.position.y", 0.1), NoDerivative::Start);
  EXPECT_EQ(reason_of(scene, "bodies.block.angle", 0.1), NoDerivative::Start);
  EXPECT_EQ(reason_of(scene, "bodies.block.velocity.y", 0.1), NoDerivative::Start);
}

// Friction takes a time proportional to a slight slip to end it, and leaves what rolling shares out.
TEST(Sensitivities, ASlipAtTheStartOfARollingContactIsEndedByFriction) {
  Scene scene{.name = "rolling"};
  scene.bodies = {ground(0.3), disc("disc", {0, 0.5}, {1, 0}, 0.5, 0.3)};
  scene.bodies[1].angular_velocity = -2;
  const Simulation run = derived_run(scene, {"bodies.disc.velocity.x", "bodies.disc.angular_velocity"}, 0.5);
  // v' = (2 v - w r) / 3 after the slip, as of a uniform disc.
  EXPECT_NEAR(run.sensitivities(0)[1].velocity.x, 2.0 / 3, 1e-9);
  EXPECT_NEAR(run.sensitivities(0)[1].position.x, 1.0 / 3, 1e-9);
  EXPECT_NEAR(run.sensitivities(1)[1].velocity.x, -0.5 / 3, 1e-9);
}

TEST(Sensitivities, UnknownParametersAreErrorsByName) {
  for (const char* name :
       {"gravity", "gravity.z", "bodies.ball", "bodies.nobody.mass", "bodies.ball.shapes[3].friction",
        "joints.a.length", "forces[0].stiffness", "", "bodies[7].mass"}) {
    EXPECT_THROW(compile(falling_ball(1, 0.5), Precise{}, {.parameters = {name}}), Error) << name;
  }
  EXPECT_THROW(compile(falling_ball(1, 0.5), Realtime{}, {.parameters = {"gravity.y"}}), Error);
  EXPECT_THROW(compile(falling_ball(1, 0.5), Precise{}).sensitivities(0), Error);
}

}  // namespace
}  // namespace plumb
