#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/precise/contact_scenes.h"
#include "tests/precise/truth.h"

// Contacts of capsules, polygons, segments and chains under Precise, against closed forms.
namespace plumb {
namespace {

using truth::Real;

constexpr double kGravity = 9.81;

Body shaped(const std::string& name, Vec2d position, const Geometry& geometry, double friction,
            Vec2d velocity = {}) {
  Body body{.name = name, .position = position, .velocity = velocity, .mass = 2, .inertia = 0.3};
  body.shapes = {{.geometry = geometry, .friction = friction}};
  return body;
}

/// A floor that is seen from above: chains have their front to the right of their way.
Body floor_of(const Geometry& geometry, double friction) {
  Body body{.name = "floor", .type = BodyType::Static};
  body.shapes = {{.geometry = geometry, .friction = friction}};
  return body;
}

Chain seamed(double from, double to, int segments) {
  Chain chain;
  for (int i = 0; i <= segments; ++i) chain.points.push_back({from + (to - from) * i / segments, 0});
  return chain;
}

TEST(PreciseShapes, CapsuleTopplesOverItsRoundEnd) {
  // Rolling without slip on a cap of radius r with the centre of mass at d from its centre, q from the
  // vertical: (m (r^2 + d^2 + 2 r d cos q) + I) q'' = m d sin q (g + r q'^2).
  const Real r = 0.2L, d = 0.6L, m = 2, inertia = 0.3L, g = 9.81L;
  const truth::Rate rate = [&](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    out = {y[1], m * d * std::sin(y[0]) * (g + r * y[1] * y[1]) /
                     (m * (r * r + d * d + 2 * r * d * std::cos(y[0])) + inertia)};
  };
  const auto y = truth::integrate_twice(rate, {0.3L, 0}, 0, 0.5L, 2000);
  Scene scene{.name = "topple"};
  scene.bodies = {floor_of(Segment{{-50, 0}, {50, 0}}, 1),
                  shaped("capsule", {static_cast<double>(d) * std::sin(0.3), 0.2 + 0.6 * std::cos(0.3)},
                         Capsule{{0, -0.6}, {0, 0.6}, 0.2}, 1)};
  scene.bodies[1].angle = -0.3;
  const BodyState s = run(scene, 30)[1];
  EXPECT_NEAR(s.angle, static_cast<double>(-y[0]), 1e-11);
  EXPECT_NEAR(s.position.x, static_cast<double>(r * (y[0] - 0.3L) + d * std::sin(y[0])), 1e-11);
  EXPECT_NEAR(s.position.y, static_cast<double>(r + d * std::cos(y[0])), 1e-11);
}

TEST(PreciseShapes, EverythingSlidesFlatByCoulombsLaw) {
  // x = v t - mu g t^2 / 2 until t = v / (mu g) = 1.019 s, and rests at its radius and half height.
  const double mu = 0.3, v = 3;
  const Geometry sliders[] = {Capsule{{-0.5, 0}, {0.5, 0}, 0.25},
                              Polygon{{{0.4, 0.2}, {-0.4, -0.2}, {0.4, -0.2}, {-0.4, 0.2}}, 0.05},
                              Polygon{{{-0.6, -0.25}, {0.6, -0.25}, {0, 0.5}}, 0}};
  const Geometry floors[] = {Segment{{30, 0}, {-30, 0}}, seamed(30, -30, 97)};
  for (const Geometry& floor : floors) {
    for (const Geometry& slider : sliders) {
      Scene scene{.name = "slide"};
      scene.bodies = {floor_of(floor, mu), shaped("slider", {0, 0.25}, slider, mu, {v, 0})};
      const auto driver = make_precise_driver(scene, {}, {});
      BodyState s = advance(*driver, 2, 60)[1];
      EXPECT_NEAR(s.position.x, v - mu * kGravity / 2, 1e-12);
      EXPECT_NEAR(s.velocity.x, v - mu * kGravity, 1e-12);
      EXPECT_NEAR(s.position.y, 0.25, 1e-14);
      EXPECT_NEAR(s.angle, 0, 1e-13);
      s = advance(*driver, 2, 60)[1];
      EXPECT_NEAR(s.position.x, v * v / (2 * mu * kGravity), 1e-11);
      EXPECT_NEAR(s.velocity.x, 0, 1e-14);
    }
  }
}

TEST(PreciseShapes, BallRollsOverSeamsAsOverALine) {
  for (const double friction : {0.0, 0.8}) {
    Scene scene{.name = "seams"};
    scene.bodies = {floor_of(seamed(6, -2, 23), friction),
                    shaped("ball", {-1, 0.5}, Circle{0.5}, friction, {2, 0})};
    scene.bodies[1].angular_velocity = -4;
    const auto s = run(scene, 120);
    EXPECT_NEAR(s[1].position.x, 3, 1e-12) << friction;
    EXPECT_NEAR(s[1].position.y, 0.5, 1e-13) << friction;
    EXPECT_NEAR(s[1].velocity.x, 2, 1e-12) << friction;
    EXPECT_NEAR(s[1].angle, -8, 1e-12) << friction;
  }
}

TEST(PreciseShapes, BallGoesRoundAVertexAndDownTheSlope) {
  // Without friction the centre goes on a circle about the vertex, q'' = g sin q / r from q' = v/r, until it
  // stands off the slope: then down it at g sin(slope).
  const double slope = 0.3, r = 0.5, v = 0.4;
  Scene scene{.name = "hill"};
  scene.bodies = {floor_of(Chain{{{9 * std::cos(slope), -9 * std::sin(slope)}, {0, 0}, {-5, 0}}}, 0),
                  shaped("ball", {-0.2, r}, Circle{r}, 0, {v, 0})};
  const truth::Rate rate = [&](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    out = {y[1], 9.81L * std::sin(y[0]) / 0.5L};
  };
  // When q reaches the slope: by Newton's method on the integral.
  Real turned = 0.3L;
  std::vector<Real> y;
  for (int i = 0; i < 30; ++i) {
    y = truth::integrate_twice(rate, {0, 0.8L}, 0, turned, 2000);
    turned -= (y[0] - 0.3L) / y[1];
  }
  const Real on_slope = 1.5L - 0.5L - turned, speed = y[1] * 0.5L;
  const double along =
      static_cast<double>(speed * on_slope + 9.81L * std::sin(0.3L) * on_slope * on_slope / 2);
  const BodyState s = run(scene, 90)[1];
  EXPECT_NEAR(s.position.x, along * std::cos(slope) + r * std::sin(slope), 1e-9);
  EXPECT_NEAR(s.position.y, -along * std::sin(slope) + r * std::cos(slope), 1e-9);
  EXPECT_NEAR(s.velocity.x, std::cos(slope) * static_cast<double>(speed + 9.81L * std::sin(0.3L) * on_slope),
              1e-9);
}

TEST(PreciseShapes, BallMeetsARampWhereItsSurfaceDoes) {
  // It touches the ramp r tan(a/2) before the seam, and keeps the share cos a of its speed.
  const double a = 0.4, r = 0.5, v = 3;
  Scene scene{.name = "ramp"};
  scene.bodies = {floor_of(Chain{{{9 * std::cos(a), 9 * std::sin(a)}, {0, 0}, {-5, 0}}}, 0),
                  shaped("ball", {-1, r}, Circle{r}, 0, {v, 0})};
  const double reach = r * std::tan(a / 2), left = 0.5 - (1 - reach) / v;
  const double along = reach + v * std::cos(a) * left - kGravity * std::sin(a) * left * left / 2;
  const BodyState s = run(scene, 30)[1];
  EXPECT_NEAR(s.position.x, along * std::cos(a) - r * std::sin(a), 1e-11);
  EXPECT_NEAR(s.position.y, along * std::sin(a) + r * std::cos(a), 1e-11);
}

TEST(PreciseShapes, ChainsLetThroughFromTheBack) {
  Scene scene{.name = "through"};
  scene.bodies = {floor_of(seamed(3, -3, 6), 0.5), shaped("ball", {0.1, -2}, Circle{0.3}, 0.5, {0, 9})};
  const auto driver = make_precise_driver(scene, {}, {});
  BodyState s = advance(*driver, 2, 48)[1];
  EXPECT_NEAR(s.position.y, -2 + 9 * 0.8 - kGravity * 0.32, 1e-13);
  s = advance(*driver, 2, 120)[1];
  EXPECT_NEAR(s.position.y, 0.3, 1e-13);
  EXPECT_NEAR(s.velocity.y, 0, 1e-13);
}

TEST(PreciseShapes, PolygonRestsOnAVertexOfAHill) {
  // A plank in balance on the vertex of a roof: the sharp vertex touches its under side.
  Scene scene{.name = "roof"};
  scene.bodies = {floor_of(Chain{{{4, -2}, {0, 0}, {-4, -2}}}, 1),
                  shaped("plank", {0, 0.1}, Polygon{{{-1, -0.1}, {1, -0.1}, {1, 0.1}, {-1, 0.1}}, 0}, 1)};
  const BodyState s = run(scene, 30)[1];
  EXPECT_NEAR(s.position.y, 0.1, 1e-14);
  EXPECT_NEAR(s.angle, 0, 1e-13);
}

}  // namespace
}  // namespace plumb
