#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/precise/support.h"
#include "tests/precise/truth.h"

namespace plumb {
namespace {

using truth::Real;

/// The error after `seconds` with a tolerance.
using ErrorOf = std::function<double(const Precise&)>;

/// Errors at tolerances from 1 to 1e-10 fall by more than six decades, and by most of what each step down
/// asks.
void expect_convergence(const std::string& what, const ErrorOf& error_of) {
  std::vector<double> errors;
  for (const double tolerance : {1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    errors.push_back(error_of({.tolerance = tolerance, .max_dt = 0.5}));
    EXPECT_LT(errors.back(), tolerance) << what << " at " << tolerance;
  }
  EXPECT_GT(std::log10(errors.front() / errors.back()), 6)
      << what << ": " << errors.front() << " to " << errors.back();
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_LT(errors[i], std::max(errors[i - 1] / 3, 1e-13)) << what << " " << i;
  }
}

TEST(PreciseConvergence, Chain) {
  expect_convergence("chain", [](const Precise& precise) {
    const Vec2d tip = rod_end(run(rods(5), 2, precise).back(), 0.5);
    return std::sqrt(length_squared(tip - Vec2d{0.533569475142432, -4.91970959757084}));
  });
}

TEST(PreciseConvergence, Kepler) {
  // mu = 1, e = 0.6: after a period of 2 pi back at the pericentre.
  Scene scene{.name = "kepler", .gravity = {0, 0}};
  scene.bodies = {{.name = "planet", .position = {0.4, 0}, .velocity = {0, 2}, .inertia = 1}};
  scene.forces = {AttractionForce{.body = "planet", .strength = 1}};
  expect_convergence("kepler", [&](Precise precise) {
    precise.max_dt = 2 * kPi;
    return std::sqrt(length_squared(run(scene, 1, precise)[0].position - Vec2d{0.4, 0}));
  });
}

TEST(PreciseConvergence, QuadraticDrag) {
  Scene scene{.name = "fall"};
  scene.bodies = {{.name = "ball", .mass = 2, .inertia = 1}};
  scene.forces = {QuadraticDrag{"ball", 1}};
  const Real terminal = std::sqrt(2 * 9.81L), fall = terminal * terminal / 9.81L;
  expect_convergence("drag", [&](const Precise& precise) {
    const BodyState s = run(scene, 4, precise)[0];
    return static_cast<double>(std::abs(s.position.y + fall * std::log(std::cosh(2 * 9.81L / terminal))));
  });
}

TEST(PreciseConvergence, DrivenAndDampedOscillator) {
  // x'' + 2 b x' + w^2 x = a sin(W t): x = A sin W t + B cos W t + e^(-b t) (C cos v t + D sin v t).
  const Real w2 = 25, b = 0.4L, W = 3, a = 2, x0 = 0.5L;
  Scene scene{.name = "driven", .gravity = {0, 0}};
  scene.bodies = {{.name = "mass", .position = {10.5, 0}, .inertia = 1, .fixed_rotation = true}};
  scene.forces = {
      SpringForce{.body_a = "world", .body_b = "mass", .rest_length = 10, .stiffness = 25, .damping = 0.8},
      SinusoidalForce{.body = "mass", .amplitude = {2, 0}, .angular_frequency = 3}};
  const Real d = (w2 - W * W) * (w2 - W * W) + 4 * b * b * W * W, A = a * (w2 - W * W) / d,
             B = -2 * a * b * W / d;
  const Real v = std::sqrt(w2 - b * b), C = x0 - B, D = (b * C - A * W) / v;
  expect_convergence("oscillator", [&](const Precise& precise) {
    const Real t = 4;
    const Real x = A * std::sin(W * t) + B * std::cos(W * t) +
                   std::exp(-b * t) * (C * std::cos(v * t) + D * std::sin(v * t));
    return static_cast<double>(std::abs(run(scene, 8, precise)[0].position.x - 10 - x));
  });
}

/// Ten light rods with a heavy one at their end, in a line at `angle` from the vertical.
Scene heavy_tip(double ratio, double angle) {
  Scene scene = rods(10);
  scene.bodies.back().mass = ratio;
  scene.bodies.back().inertia = ratio / 12;
  const Vec2d along{std::sin(angle), -std::cos(angle)};
  for (int i = 0; i < 10; ++i) {
    scene.bodies[i].position = (i + 0.5) * along;
    scene.bodies[i].angle = angle - kPi / 2;
  }
  return scene;
}

TEST(PreciseHeavyTip, NeitherStretchesNorCostsWithoutEnd) {
  for (const double ratio : {1e4, 1e6}) {
    for (const double angle : {0.0, 0.5}) {
      for (const bool in_angles : {true, false}) {
        Scene scene = heavy_tip(ratio, angle);
        if (!in_angles)
          scene.forces = {LinearDrag{"rod3", 1e-300}};  // of no effect: all coordinates are followed
        const auto driver = make_precise_driver(scene, {}, {});
        double gap = 0;
        for (int i = 0; i < 30; ++i) gap = std::max(gap, check_rods(advance(*driver, 10, 1)).gap);
        EXPECT_LT(gap, 3e-14) << ratio << " " << angle;
        EXPECT_LT(driver->statistics().steps, 20000) << ratio << " " << angle;
      }
    }
  }
}

TEST(PreciseScale, ResultsDoNotDependOnUnitsOfLengthOrPlace) {
  // Lengths and gravity times k, and for k = 1 also 1e7 m off the origin, where a double resolves 2e-9 m.
  const auto reference = run(rods(3), 60);
  for (const double k : {1e-6, 1e6}) {
    Scene scaled = rods(3);
    scaled.gravity = k * scaled.gravity;
    for (Body& body : scaled.bodies) body.position = k * body.position, body.inertia = k * k * *body.inertia;
    for (Joint& joint : scaled.joints) {
      auto& hinge = std::get<RevoluteJoint>(joint);
      hinge.anchor_a = k * hinge.anchor_a, hinge.anchor_b = k * hinge.anchor_b;
    }
    const auto states = run(scaled, 60);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(states[i].position.x / k, reference[i].position.x, 1e-11) << k;
      EXPECT_NEAR(states[i].angle, reference[i].angle, 1e-11) << k;
    }
  }
  Scene far = rods(3);
  const Vec2d off{1e7, -1e7};
  for (Body& body : far.bodies) body.position += off;
  std::get<RevoluteJoint>(far.joints[0]).anchor_a = off;
  const auto states = run(far, 60);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR((states[i].position - off).x, reference[i].position.x, 2e-9);
    EXPECT_NEAR(states[i].angle, reference[i].angle, 1e-11);
  }
}

TEST(PreciseScale, EverythingThatIsFixedToTheWorldMovesWithIt) {
  // Springs, fields, rails, ropes and shapes 1e7 m off the origin, as at it.
  const auto scene_at = [](Vec2d off) {
    const auto at = [&](Vec2d place) { return off + place; };
    Scene scene{.name = "far"};
    scene.bodies = {{.name = "floor", .type = BodyType::Static, .position = at({0, -3})},
                    ball("ball", at({0.1, 0}), {1, 0}),
                    {.name = "left", .position = at({-2, 1}), .inertia = 1},
                    {.name = "right", .position = at({-4, 1}), .mass = 2, .inertia = 1},
                    {.name = "slider", .position = at({5, 0}), .inertia = 1},
                    {.name = "planet", .position = at({8, 0}), .velocity = {0, 2}, .inertia = 1}};
    scene.bodies[0].shapes = {{.geometry = Segment{{9, 0}, {-9, 0}}, .friction = 0, .restitution = 1}};
    scene.joints = {PulleyJoint{.name = "rope",
                                .body_a = "left",
                                .body_b = "right",
                                .ground_a = at({-2, 3}),
                                .ground_b = at({-4, 4})},
                    PrismaticJoint{.name = "rail",
                                   .body_a = std::string(kWorld),
                                   .body_b = "slider",
                                   .anchor_a = at({5, 1}),
                                   .axis = {0, 1},
                                   .spring = Spring{2, 0.1}}};
    scene.forces = {SpringForce{.body_a = std::string(kWorld),
                                .body_b = "ball",
                                .anchor_a = at({0, 1}),
                                .rest_length = 0.5,
                                .stiffness = 3},
                    AttractionForce{.body = "planet", .centre = at({7, 0}), .strength = 4}};
    return scene;
  };
  const Vec2d off{1e7, -1e7};
  const auto near = run(scene_at({}), 60), far = run(scene_at(off), 60);
  for (std::size_t i = 0; i < near.size(); ++i) {
    EXPECT_NEAR(far[i].position.x - off.x, near[i].position.x, 4e-9) << i;
    EXPECT_NEAR(far[i].position.y - off.y, near[i].position.y, 4e-9) << i;
    EXPECT_NEAR(far[i].velocity.y, near[i].velocity.y, 2e-8) << i;  // places of 0.1 m are rounded there
  }
}

/// Parallel cranks of length 1 on a bar, all at `angle` and turning at `speed`. Two of them have one degree
/// of freedom; every further one repeats a constraint.
Scene parallel_cranks(int n, double angle, double speed) {
  Scene scene{.name = "cranks"};
  const double length = 2.0 * (n - 1);
  const Vec2d along{std::cos(angle), std::sin(angle)}, across = perpendicular(along);
  scene.bodies.push_back(
      {.name = "bar", .position = Vec2d{length / 2, 0} + along, .velocity = speed * across, .inertia = 1});
  for (int i = 0; i < n; ++i) {
    const std::string name = "crank" + std::to_string(i);
    scene.bodies.push_back({.name = name,
                            .position = Vec2d{2.0 * i, 0} + 0.5 * along,
                            .angle = angle,
                            .velocity = (0.5 * speed) * across,
                            .angular_velocity = speed,
                            .inertia = 1.0 / 12});
    scene.joints.push_back(RevoluteJoint{
        "ground" + std::to_string(i), std::string(kWorld), name, {2.0 * i, 0}, {-0.5, 0}, false});
    scene.joints.push_back(
        RevoluteJoint{"pin" + std::to_string(i), name, "bar", {0.5, 0}, {2.0 * i - length / 2, 0}, false});
  }
  return scene;
}

/// Their one angle q: (n/3 + 1) q'' = -g (n/2 + 1) cos q, with masses of 1.
double crank_angle(int n, double angle, double speed, double seconds) {
  const auto f = [n](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    out = {y[1], -9.81L * (n / 2.0L + 1) * std::cos(y[0]) / (n / 3.0L + 1)};
  };
  return static_cast<double>(truth::integrate_twice(f, {angle, speed}, 0, seconds, 1000)[0]);
}

TEST(PreciseLoops, RedundantJointsAreFoundNamedAndWithoutForce) {
  for (const int n : {2, 3, 5}) {
    const auto driver = make_precise_driver(parallel_cranks(n, 0.7, 3), {}, {});
    EXPECT_EQ(driver->statistics().redundant_joints, n - 2);
    std::string why;
    for (const Stage& stage : driver->plan().stages)
      why += stage.name == "joint_accelerations" ? stage.why : "";
    EXPECT_EQ(why.find("redundant") != std::string::npos, n > 2) << why;
    const auto states = advance(*driver, n + 1, 30);  // short of the line where all cranks lie on the bar
    EXPECT_NEAR(states[1].angle, crank_angle(n, 0.7, 3, 0.5), 1e-11) << n;
    EXPECT_NEAR(states[0].angle, 0, 1e-13) << n;
  }
}

TEST(PreciseLoops, CranksPassThroughTheLinesWhereTheyAreSingular) {
  // On a line the bars might also go on as a crossed parallelogram: the smooth way is the one that goes on.
  // More than two cranks have rows that follow from others besides.
  for (const int n : {2, 3, 4, 5}) {
    for (const double speed : {5.0, 8.0, 12.0}) {
      const auto driver = make_precise_driver(parallel_cranks(n, 0.7, speed), {.tolerance = 1e-6}, {});
      for (int i = 1; i <= 12; ++i) {
        const auto states = advance(*driver, n + 1, 10);
        EXPECT_NEAR(states[1].angle, crank_angle(n, 0.7, speed, i / 6.0), 1e-8) << n << " at " << speed;
        EXPECT_NEAR(states[2].angle, states[1].angle, 1e-9) << n << " at " << speed;
      }
      EXPECT_GT(driver->statistics().leaps, 0) << n << " at " << speed;
    }
  }
  for (const int n : {2, 3}) {
    const auto driver = make_precise_driver(parallel_cranks(n, 0.7, 8), {}, {});
    for (int i = 1; i <= 12; ++i) {
      EXPECT_NEAR(advance(*driver, n + 1, 10)[1].angle, crank_angle(n, 0.7, 8, i / 6.0), 2e-9) << n;
    }
  }
}

TEST(PreciseLoops, FoldedChainUnfoldsAndHangingOneHangs) {
  Scene folded = rods(4);
  for (int i = 0; i < 4; ++i) {
    folded.bodies[i].position = {0.5, 0};
    folded.bodies[i].angle = i % 2 ? kPi : 0;
  }
  const auto driver = make_precise_driver(folded, {}, {});
  for (int i = 0; i < 120; ++i) {
    const RodsCheck now = check_rods(advance(*driver, 4, 1));
    EXPECT_LT(now.gap, 2e-14);
    EXPECT_LT(std::abs(now.energy), 1e-10);
  }
  Scene hanging = rods(4);
  for (int i = 0; i < 4; ++i) {
    hanging.bodies[i].position = {0, -i - 0.5};
    hanging.bodies[i].angle = -kPi / 2;
  }
  const auto still = run(hanging, 600);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(still[i].position.y, -i - 0.5, 1e-12);
}

}  // namespace
}  // namespace plumb
