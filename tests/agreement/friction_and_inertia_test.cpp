// Friction and the inertia that follows from shapes: closed forms for what no scenario holds yet. The ground
// is level and gravity is tilted instead, which is the same motion in turned axes.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace plumb {

void PrintTo(Precision precision, std::ostream* out) { *out << name_of(precision); }

namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr double kTime = 1;        // s
constexpr int kSteps = 60;

class ClosedForm : public testing::TestWithParam<Precision> {
 protected:
  /// Gravity of a slope that falls towards +x, and the ground, whose top is y = 0.
  static Scene slope(double tilt, double friction) {
    Scene scene{.name = "slope", .gravity = {kGravity * std::sin(tilt), -kGravity * std::cos(tilt)}};
    scene.bodies = {{.name = "ground",
                     .type = BodyType::Static,
                     .position = {0, -1},
                     .shapes = {{.geometry = Box{200, 2}, .friction = friction}}}};
    return scene;
  }

  static Shape shape(const Geometry& geometry, double friction) {
    return {.geometry = geometry, .friction = friction};
  }

  BodyState after_a_second(const Scene& scene) const {
    Simulation world = compile(scene, Realtime{.dt = kTime / kSteps, .precision = GetParam()});
    world.step(kSteps);
    return world.state(scene.bodies.size() - 1);
  }

  /// Of a second of sums of terms below ten.
  double rounding() const { return GetParam() == Precision::Float ? 1e-4 : 5e-13; }

  static double substep() { return kTime / kSteps / Realtime{}.substeps; }
  /// Contacts begin without a load: the friction of the first substep may be missing.
  double late_friction(double tilt, double friction) const {
    return friction * kGravity * std::cos(tilt) * substep() + rounding();
  }
  /// Bodies in contact move by x += h v with the new v, of first order: a h t/2 too far.
  double too_far(double acceleration) const { return std::abs(acceleration) * substep() * kTime / 2; }
};

// A block slides iff tan(tilt) > mu, then at a = g (sin - mu cos). The mean of the two coefficients is
// geometric.
TEST_P(ClosedForm, BlockOnASlope) {
  const double settling = 0.01 * kGravity * substep();
  for (const double tilt : {0.2, 0.4, 0.6}) {
    for (const double friction : {0.1, 0.3, 0.6}) {
      Scene scene = slope(tilt, friction * friction / 0.9);
      scene.bodies.push_back({.name = "block", .position = {0, 0.25}, .shapes = {shape(Box{1, 0.5}, 0.9)}});
      const double pull = kGravity * (std::sin(tilt) - friction * std::cos(tilt));
      const double acceleration = std::max(0.0, pull);
      const BodyState end = after_a_second(scene);
      SCOPED_TRACE(testing::Message() << "tilt " << tilt << ", friction " << friction);
      const double late = late_friction(tilt, friction);
      EXPECT_NEAR(end.velocity.x, acceleration * kTime, late);
      EXPECT_NEAR(end.position.x, acceleration * kTime * kTime / 2, too_far(acceleration) + late * kTime);
      EXPECT_NEAR(end.position.y, 0.25, settling);
      EXPECT_NEAR(end.angle, 0, settling);
    }
  }
}

// A disc rolls iff mu >= tan(tilt)/3, at a = (2/3) g sin; else it slides at a = g (sin - mu cos), and
// friction turns it at mu m g cos r / (m r^2/2).
TEST_P(ClosedForm, DiscOnASlope) {
  constexpr double kRadius = 0.5;
  for (const double tilt : {0.2, 0.4, 0.6}) {
    for (const double friction : {0.05, 0.1, 0.5}) {
      Scene scene = slope(tilt, friction);
      scene.bodies.push_back({.name = "disc",
                              .position = {0, kRadius},
                              .mass = 2,
                              .shapes = {shape(Circle{kRadius}, friction)}});
      const bool rolls = friction >= std::tan(tilt) / 3;
      const double acceleration =
          rolls ? kGravity * std::sin(tilt) * 2 / 3 : kGravity * (std::sin(tilt) - friction * std::cos(tilt));
      const double turning =
          rolls ? acceleration / kRadius : 2 * friction * kGravity * std::cos(tilt) / kRadius;
      const BodyState end = after_a_second(scene);
      SCOPED_TRACE(testing::Message() << "tilt " << tilt << ", friction " << friction);
      const double late = late_friction(tilt, friction);
      EXPECT_NEAR(end.velocity.x, acceleration * kTime, late);
      EXPECT_NEAR(end.position.x, acceleration * kTime * kTime / 2, too_far(acceleration) + late * kTime);
      EXPECT_NEAR(end.angular_velocity, -turning * kTime, 2 * late / kRadius);
    }
  }
}

// A disc that slides at v0 rolls from t = v0 / (3 mu g) on, at 2 v0/3, having gone 5 v0^2 / (18 mu g) by
// then.
TEST_P(ClosedForm, SlidingDiscStartsToRoll) {
  constexpr double kSpeed = 5, kFriction = 0.2, kRadius = 0.25;
  Scene scene = slope(0, kFriction);
  scene.bodies.push_back({.name = "disc",
                          .position = {0, kRadius},
                          .velocity = {kSpeed, 0},
                          .shapes = {shape(Circle{kRadius}, kFriction)}});
  const double rolls_from = kSpeed / (3 * kFriction * kGravity);
  const double way =
      5 * kSpeed * kSpeed / (18 * kFriction * kGravity) + 2 * kSpeed / 3 * (kTime - rolls_from);
  const BodyState end = after_a_second(scene);
  // It lies at most a ten-thousandth of its radius in the ground, which makes the lever of friction shorter.
  EXPECT_NEAR(end.velocity.x, 2 * kSpeed / 3, 1e-4 * kSpeed);
  EXPECT_NEAR(end.angular_velocity, -2 * kSpeed / 3 / kRadius, 1e-4 * kSpeed / kRadius);
  EXPECT_NEAR(end.position.x, way, kFriction * kGravity * rolls_from * substep() / 2 + 1e-4 * kSpeed * kTime);
}

// A torque T for a time t turns a body at T t / I: m (w^2 + h^2)/12 for a box, m r^2/2 for a disc, and shapes
// off the centre by the parallel axes.
TEST_P(ClosedForm, InertiaOfShapes) {
  const double mass = 3;
  const auto spin = [&](std::vector<Shape> shapes) {
    Scene scene{.name = "spin", .gravity = {}};
    scene.bodies = {{.name = "body", .mass = mass, .shapes = std::move(shapes)}};
    scene.forces = {Torque{.body = "body", .torque = 1.5}};
    return after_a_second(scene).angular_velocity;
  };
  const auto expected = [&](double inertia) { return 1.5 * kTime / inertia; };
  const auto tolerance = [&](double value) { return value * rounding(); };

  const double box = expected(mass * (0.8 * 0.8 + 0.3 * 0.3) / 12);
  EXPECT_NEAR(spin({shape(Box{0.8, 0.3}, 0)}), box, tolerance(box));
  const double disc = expected(mass * 0.4 * 0.4 / 2);
  EXPECT_NEAR(spin({shape(Circle{0.4}, 0)}), disc, tolerance(disc));
  const double dumbbell = expected(mass * (0.4 * 0.4 / 2 + 0.7 * 0.7));
  EXPECT_NEAR(spin({{.geometry = Circle{0.4}, .position = {-0.7, 0}},
                    {.geometry = Circle{0.4}, .position = {0.7, 0}}}),
              dumbbell, tolerance(dumbbell));
}

INSTANTIATE_TEST_SUITE_P(plumb, ClosedForm, testing::Values(Precision::Float, Precision::Double),
                         [](const auto& which) { return std::string(name_of(which.param)); });

}  // namespace
}  // namespace plumb
