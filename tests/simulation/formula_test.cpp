#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/simulation/simulation.h"
#include "tests/simulation/point_masses.h"

/// Forces, springs, supports and motors by formulas, in both drivers, against closed forms and against the
/// same laws written without formulas.
namespace plumb {
namespace {

const Precise kPrecise{.tolerance = 1e-11, .max_dt = kDt};

Realtime fine(int substeps) { return {.dt = kDt, .substeps = substeps, .precision = Precision::Double}; }

/// Error of `of(states)` after 2 s in Precise, and in worlds with 8 and 16 substeps.
struct Errors {
  double precise, coarse, fine;
};
template <class Of>
Errors errors(const Scene& scene, double expected, const Of& of) {
  const int steps = 120;
  return {std::abs(of(run(scene, kPrecise, steps)) - expected),
          std::abs(of(run(scene, fine(8), steps)) - expected),
          std::abs(of(run(scene, fine(16), steps)) - expected)};
}

// m x'' = A t^2 - c x': x = A (t^3/(3 c) - m t^2/c^2 + 2 m^2 t/c^3 - 2 m^3/c^4 (1 - e^(-c t/m))), from rest.
TEST(Formulas, ForceOfTimeAndVelocityFollowsItsClosedForm) {
  const Scene scene = weightless({mass_point("cart", 2, {})},
                                 {FormulaForce{.body = "cart", .x = "3*t^2 - 0.8*vx", .y = "-m*exp(-t)"}});
  const double t = 2, A = 3, m = 2, c = 0.8;
  const double x = A * (t * t * t / (3 * c) - m * t * t / (c * c) + 2 * m * m * t / (c * c * c) -
                        2 * m * m * m / (c * c * c * c) * (1 - std::exp(-c * t / m)));
  const Errors e = errors(scene, x, [](const auto& s) { return s[0].position.x; });
  EXPECT_LT(e.precise, 1e-10);
  EXPECT_LT(e.coarse, 1e-5);
  EXPECT_LT(e.fine, 0.3 * e.coarse);  // second order
  // y'' = -e^-t: y = -(t - 1 + e^-t).
  const Errors fall = errors(scene, -(t - 1 + std::exp(-t)), [](const auto& s) { return s[0].position.y; });
  EXPECT_LT(fall.precise, 1e-10);
  EXPECT_LT(fall.coarse, 1e-5);
}

// Gravity g0 (1 + y/H)^-2 of a planet of radius H: v^2 = v0^2 - 2 g0 H (1 - 1/(1 + y/H)).
TEST(Formulas, GravityThatVariesWithHeightKeepsItsEnergy) {
  Scene scene = weightless({mass_point("stone", 3, {0, 0}, {0, 20})},
                           {FormulaForce{.body = "stone", .y = "-m*9.81/(1 + y/50)^2"}});
  const auto energy = [](const std::vector<BodyState>& s) {
    return s[0].velocity.y * s[0].velocity.y / 2 - 9.81 * 50 / (1 + s[0].position.y / 50);
  };
  const Errors e = errors(scene, 200 - 9.81 * 50, energy);
  EXPECT_LT(e.precise, 1e-8);
  EXPECT_LT(e.coarse, 1e-3);
}

// A formula that writes down a known law gives what that law gives: a spring, and a force at a point.
TEST(Formulas, AgreeWithTheLawsThatTheyWriteDown) {
  Body plank = mass_point("plank", 2, {2, 0.5});
  plank.angular_velocity = 1;
  const Scene by_law = weightless({plank}, {SpringForce{"world", "plank", {0, 0}, {0.5, 0.25}, 1, 30, 0.5},
                                            SinusoidalForce{"plank", {1, 2}, {0.25, 0}, 3, 0.5}});
  const Scene by_formula = weightless(
      {plank},
      {FormulaSpring{"world", "plank", {0, 0}, {0.5, 0.25}, "30*(length - 1) + 0.5*rate"},
       FormulaForce{.body = "plank", .x = "sin(3*t + 0.5)", .y = "2*sin(3*t + 0.5)", .point = {0.25, 0}}});
  for (const MotionMethod method : {MotionMethod::Automatic, MotionMethod::Implicit}) {
    Precise precise = kPrecise;
    precise.method = method;  // the implicit method also needs the formulas' derivatives
    const BodyState a = run(by_law, precise, 120)[0], b = run(by_formula, precise, 120)[0];
    EXPECT_NEAR(a.position.x, b.position.x, 1e-9);
    EXPECT_NEAR(a.angle, b.angle, 1e-9);
  }
  // Springs conserve energy, formulas follow the midpoint method: both are of second order.
  const auto apart = [&](int substeps) {
    const BodyState a = run(by_law, fine(substeps), 120)[0], b = run(by_formula, fine(substeps), 120)[0];
    return std::abs(a.position.x - b.position.x);
  };
  EXPECT_LT(apart(8), 1e-3);
  EXPECT_NEAR(apart(8) / apart(16), 4, 0.1);
}

// A force that swings quickly shakes a block that lies still between its slips: events are found although the
// motion alone would allow long steps.
TEST(Formulas, ShakeABlockLooseAsASinusoidalForceDoes) {
  Scene by_law{.name = "formulas", .gravity = {0, -9.81}};
  by_law.bodies = {{.name = "floor", .type = BodyType::Static, .shapes = {{.geometry = Box{40, 1}}}},
                   {.name = "block", .position = {0, 1}, .mass = 2, .shapes = {{.geometry = Box{1, 1}}}}};
  by_law.forces = {SinusoidalForce{"block", {11, 0}, {0, -0.5}, 60, 0.3}};
  Scene by_formula = by_law;
  by_formula.forces = {FormulaForce{.body = "block", .x = "11*sin(60*t + 0.3)", .point = {0, -0.5}}};
  const Precise precise{.tolerance = 1e-9, .max_dt = kDt};
  const BodyState a = run(by_law, precise, 60)[1], b = run(by_formula, precise, 60)[1];
  EXPECT_NEAR(a.position.x, b.position.x, 1e-8);
  EXPECT_NEAR(a.velocity.x, b.velocity.x, 1e-7);
  EXPECT_GT(std::abs(a.position.x), 1e-5);  // it has slipped
}

// Duffing's spring m x'' = -k (x + x^3) by a table of its force in steps of 1/64 m: straight lines err by at
// most f''/8 h^2 = 6 k x h^2/8 in the force, a relative change of the energy below that times x over k x^2/2.
TEST(Formulas, SpringByTableMovesAsDuffingsEquation) {
  const double k = 8, h = 1.0 / 64;
  std::string table = "table(length";
  for (int i = 0; i <= 96; ++i) {
    const double x = i * h;
    table += ", " + std::to_string(x) + ", " + std::to_string(k * (x + x * x * x));
  }
  table += ")";
  Scene scene =
      weightless({mass_point("ball", 1, {1.25, 0})}, {FormulaSpring{"world", "ball", {}, {}, table}});
  scene.bodies[0].velocity = {0, 2};  // past the anchor, not through it
  Scene closed = scene;
  closed.forces = {FormulaSpring{"world", "ball", {}, {}, "8*(length + length^3)"}};
  const auto energy = [&](const BodyState& s) {
    const double r2 = length_squared(s.position);
    return length_squared(s.velocity) / 2 + k * (r2 / 2 + r2 * r2 / 4);
  };
  const double start = 2 + k * (1.25 * 1.25 / 2 + std::pow(1.25, 4) / 4);
  const double allowed = k * 6 * 1.25 * h * h / 8 * 1.25;
  EXPECT_NEAR(energy(run(closed, kPrecise, 120)[0]), start, 1e-8);
  EXPECT_NEAR(energy(run(scene, kPrecise, 120)[0]), start, allowed);
  EXPECT_NEAR(energy(run(scene, fine(8), 120)[0]), start, allowed + 1e-3 * start);
}

/// A rod of length l, as a point mass on a massless link, on a pivot that moves as a cos(w t).
Scene vibrated_pendulum(double angle, double a, double w) {
  Scene scene{.name = "formulas", .gravity = {0, -9.81}};
  scene.bodies = {
      {.name = "pivot", .type = BodyType::Kinematic},
      {.name = "bob", .position = {std::sin(angle), a - std::cos(angle)}, .mass = 1, .fixed_rotation = true}};
  scene.bodies[0].motion.y = std::to_string(a) + "*cos(" + std::to_string(w) + "*t)";
  scene.joints = {DistanceJoint{.name = "rod", .body_a = "pivot", .body_b = "bob", .length = 1}};
  return scene;
}

// phi'' = -((g - a w^2 cos w t)/l) sin phi, phi from the lower vertical, integrated by the classical
// Runge-Kutta method with 200 steps per period of the pivot.
double vibrated_angle(double phi, double a, double w, double until) {
  const int steps = static_cast<int>(until * w / (2 * std::numbers::pi) * 200) + 1;
  const double h = until / steps;
  double speed = 0;
  const auto f = [&](double t, double p) { return -(9.81 - a * w * w * std::cos(w * t)) * std::sin(p); };
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const double k1 = f(t, phi), l1 = speed, k2 = f(t + h / 2, phi + h / 2 * l1), l2 = speed + h / 2 * k1;
    const double k3 = f(t + h / 2, phi + h / 2 * l2), l3 = speed + h / 2 * k2;
    const double k4 = f(t + h, phi + h * l3), l4 = speed + h * k3;
    phi += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
    speed += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return phi;
}

// P. L. Kapitza 1951: a pendulum stands on its head if (a w)^2 > 2 g l, and falls otherwise.
TEST(Formulas, VibratedPivotHoldsAPendulumUprightAsKapitzaFound) {
  const double start = std::numbers::pi - 0.1;
  const auto angle = [](const std::vector<BodyState>& s) {
    return std::atan2(s[1].position.x - s[0].position.x, s[0].position.y - s[1].position.y);
  };
  const auto after = [&](double a, double w, const Accuracy& accuracy) {
    return angle(run(vibrated_pendulum(start, a, w), accuracy, 120));
  };
  // 0.1 * 60 = 6 > 4.43: it stands for 2 s. Precise follows the equation.
  EXPECT_NEAR(after(0.1, 60, kPrecise), vibrated_angle(start, 0.1, 60, 2), 1e-6);
  for (const Accuracy& accuracy : {Accuracy(kPrecise), Accuracy(fine(32))}) {
    Simulation stands = compile(vibrated_pendulum(start, 0.1, 60), accuracy);
    Simulation falls = compile(vibrated_pendulum(start, 0.1, 30), accuracy);
    double lowest = 10, fallen = 10;
    std::vector<BodyState> s(2);
    for (int i = 0; i < 120; ++i) {
      stands.step(), stands.read(s);
      lowest = std::min(lowest, std::abs(angle(s)));
      falls.step(), falls.read(s);
      fallen = std::min(fallen, std::abs(angle(s)));
    }
    EXPECT_GT(lowest, std::numbers::pi - 0.3);
    EXPECT_LT(fallen, 1);
  }
}

// A table that shakes as a sin(w t) carries a block: it leaves when its acceleration exceeds g.
TEST(Formulas, ShakenTableLosesItsBlockAtTheAccelerationOfGravity) {
  const auto leaves = [](double w, const Accuracy& accuracy) {
    Scene scene{.name = "formulas", .gravity = {0, -9.81}};
    scene.bodies = {{.name = "table", .type = BodyType::Kinematic, .shapes = {{.geometry = Box{4, 1}}}},
                    {.name = "block", .position = {0, 1}, .mass = 2, .shapes = {{.geometry = Box{1, 1}}}}};
    // From rest, with velocity and acceleration 0.
    scene.bodies[0].motion.y =
        "0.05*(sin(" + std::to_string(w) + "*t) - " + std::to_string(w) + "*t*exp(-20*t))";
    scene.bodies[1].velocity = {0, 0};
    Simulation simulation = compile(scene, accuracy);
    std::vector<BodyState> s(2);
    double gap = 0;
    for (int i = 0; i < 60; ++i) {
      simulation.step(), simulation.read(s);
      if (i >= 20) gap = std::max(gap, s[1].position.y - s[0].position.y - 1);
    }
    return gap;
  };
  // a w^2 = 5.0 and 20 m/s^2.
  for (const Accuracy& accuracy : {Accuracy(Precise{.tolerance = 1e-9, .max_dt = kDt}), Accuracy(fine(8))}) {
    EXPECT_LT(leaves(10, accuracy), 2e-3);
    EXPECT_GT(leaves(20, accuracy), 0.02);
  }
}

// A motor that is driven at 2 cos 3t turns its wheel by 2/3 sin 3t, and a motor at 1 + t^2 that is too weak
// for it turns by T/I t^2/2.
TEST(Formulas, DrivenMotorsTurnByTheIntegralOfTheirSpeed) {
  Scene scene{.name = "formulas", .gravity = {0, -9.81}};
  scene.bodies = {{.name = "wheel", .mass = 2, .inertia = 0.5}, {.name = "weak", .mass = 2, .inertia = 0.5}};
  scene.joints = {RevoluteJoint{.name = "axle", .body_a = "world", .body_b = "wheel", .motor = Motor{0, 1e4}},
                  RevoluteJoint{.name = "slow", .body_a = "world", .body_b = "weak", .motor = Motor{0, 0.2}}};
  scene.drives = {{"axle", "2*cos(3*t)"}, {"slow", "1 + t^2"}};
  scene.bodies[0].angular_velocity = 2;
  const Errors e = errors(scene, 2.0 / 3 * std::sin(6), [](const auto& s) { return s[0].angle; });
  EXPECT_LT(e.precise, 1e-9);
  EXPECT_LT(e.coarse, 1e-3);
  const Errors weak = errors(scene, 0.2 / 0.5 * 2, [](const auto& s) { return s[1].angle; });
  EXPECT_LT(weak.precise, 1e-9);
  EXPECT_LT(weak.coarse, 1e-3);
}

// Snapshots go on with the same bits, and scenes read back as they were written.
TEST(Formulas, SurviveSnapshotsAndJson) {
  Scene scene = vibrated_pendulum(2, 0.1, 40);
  scene.bodies.push_back(mass_point("wheel", 1, {3, 0}));
  scene.joints.push_back(RevoluteJoint{
      .name = "axle", .body_a = "world", .body_b = "wheel", .anchor_a = {3, 0}, .motor = Motor{0, 5}});
  scene.drives = {{"axle", "sin(t)"}};
  scene.forces = {FormulaForce{.body = "bob", .x = "sin(9*t)", .torque = "0"},
                  FormulaSpring{"world", "bob", {}, {0.5, 0}, "table(length, 0, 0, 2, 5)"}};
  const std::string text = to_json(scene);
  EXPECT_EQ(scene_from_json(text), scene);
  EXPECT_NE(hash(scene), hash(vibrated_pendulum(2, 0.1, 40)));
  for (const Accuracy& accuracy : {Accuracy(kPrecise), Accuracy(fine(4))}) {
    Simulation one = compile(scene, accuracy), other = compile(scene, accuracy);
    one.step(30);
    const auto snapshot = one.save();
    one.step(30);
    other.restore(snapshot);
    other.step(30);
    std::vector<BodyState> a(3), b(3);
    one.read(a), other.read(b);
    EXPECT_EQ(a, b);
  }
}

std::string refusal(const std::string& parts) {
  try {
    (void)scene_from_json(R"({"bodies": [{"name": "a", "inertia": 1},
      {"name": "k", "type": "kinematic")" +
                          parts);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Formulas, AreRefusedWithThePlaceOfTheMistake) {
  EXPECT_NE(
      refusal(R"x(, "motion": {"y": "0.1*sin(w*t)"}}]})x")
          .find("line 2: body 'k': motion.y is 0.1*sin(w*t): is not a formula: it has an unknown name, 'w'"),
      std::string::npos);
  EXPECT_NE(refusal(R"(, "motion": {"z": 1}}]})").find("is not a field of a motion"), std::string::npos);
  EXPECT_NE(refusal(R"(}], "forces": [{"type": "formula_force", "body": "a", "force": ["sin(t", 0]}]})")
                .find("force[0] is sin(t: is not a formula: it ends where ')' is missing"),
            std::string::npos);
  EXPECT_NE(
      refusal(R"(}], "drives": [{"joint": "axle", "speed": "t"}]})").find("must be the name of a joint"),
      std::string::npos);
  EXPECT_NE(refusal(R"(, "motion": {"x": "1/t"}}]})").find("two finite numbers of m"), std::string::npos);
}

}  // namespace
}  // namespace plumb
