#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/simulation/simulation.h"
#include "tests/simulation/point_masses.h"

/// Springs, attractions and driven forces in both drivers, against closed forms.
namespace plumb {
namespace {

double distance(Vec2d a, Vec2d b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// m x'' = -k x - c x': x = e^(-b t) (cos wd t + b/wd sin wd t) from x = 1 at rest, b = c/2m, wd^2 = k/m -
/// b^2. A rest length of 3 m lies between the spring's ends.
Scene damped_oscillator() {
  return weightless({mass_point("ball", 2, {4, 0})}, {SpringForce{"world", "ball", {}, {}, 3, 50, 1.2}});
}
double damped_place(double t) {
  const double b = 1.2 / 4, wd = std::sqrt(25 - b * b);
  return 3 + std::exp(-b * t) * (std::cos(wd * t) + b / wd * std::sin(wd * t));
}

/// Two masses on a spring: the difference oscillates with the reduced mass, the centre of mass drifts.
Scene two_masses() {
  return weightless({mass_point("a", 1, {0, 0}, {0.5, 0}), mass_point("b", 3, {2.5, 0}, {0.5, 0})},
                    {SpringForce{"a", "b", {}, {}, 2, 12}});
}

/// e = 0.6, mu = 1, from the pericentre: a = 1, T = 2 pi. Kepler's equation M = E - e sin E by Newton's
/// method.
Scene kepler() {
  return weightless({mass_point("planet", 2, {0.4, 0}, {0, 2})},
                    {AttractionForce{.body = "planet", .strength = 1}});
}
Vec2d kepler_place(double t) {
  double anomaly = t;
  for (int i = 0; i < 50; ++i)
    anomaly -= (anomaly - 0.6 * std::sin(anomaly) - t) / (1 - 0.6 * std::cos(anomaly));
  return {std::cos(anomaly) - 0.6, 0.8 * std::sin(anomaly)};
}

/// The same orbit of two equal bodies about each other: each pulls with mu = 1/2, so that the way from one to
/// the other obeys the law with mu = 1.
Scene double_star() {
  return weightless({mass_point("one", 1, {0.2, 0}, {0, 1}), mass_point("other", 1, {-0.2, 0}, {0, -1})},
                    {AttractionForce{"one", "other", {}, 0.5, 2}});
}

/// m x'' = A sin(w t + p) from rest: x = A/(m w) (t cos p - (sin(w t + p) - sin p) / w).
Scene driven() {
  return weightless({mass_point("ball", 2, {0, 0})}, {SinusoidalForce{"ball", {0, 6}, {}, 4, 0.5}});
}
double driven_place(double t) {
  return 6.0 / 8 * (t * std::cos(0.5) - (std::sin(4 * t + 0.5) - std::sin(0.5)) / 4);
}

/// Returns how far each scene is from its closed form after 3 s, in its bodies' places.
std::vector<double> misses(const Accuracy& accuracy, int steps) {
  const double t = 3;
  const auto stars = run(double_star(), accuracy, steps), pair = run(two_masses(), accuracy, steps);
  const double stretch = 2 + 0.5 * std::cos(4 * t);  // k/mu = 12/0.75 = 16
  const Vec2d orbit = kepler_place(t);
  return {distance(run(damped_oscillator(), accuracy, steps)[0].position, {damped_place(t), 0}),
          distance(pair[0].position, {(2.5 * 3 / 4 + 0.5 * t) - 0.75 * stretch, 0}),
          distance(pair[1].position, {(2.5 * 3 / 4 + 0.5 * t) + 0.25 * stretch, 0}),
          distance(run(kepler(), accuracy, steps)[0].position, orbit),
          distance(stars[0].position, 0.5 * orbit),
          distance(stars[1].position, -0.5 * orbit),
          distance(run(driven(), accuracy, steps)[0].position, {0, driven_place(t)})};
}

TEST(ForceLaws, PreciseMeetsItsTolerance) {
  for (const double miss : misses(Precise{}, 180)) EXPECT_LE(miss, 1e-9);
}

TEST(ForceLaws, PreciseOrbitCloses) {
  const int steps = 200;
  const double period = 2 * std::numbers::pi;
  const auto states = run(kepler(), Precise{.max_dt = period / steps}, steps);
  EXPECT_NEAR(states[0].position.x, 0.4, 1e-9);
  EXPECT_NEAR(states[0].position.y, 0, 1e-9);
}

/// Velocity Verlet is of second order: a quarter of the error at half the step. Kepler's pericentre is coarse
/// at the first step: between 3 and 5.
TEST(ForceLaws, RealtimeConvergesWithSecondOrder) {
  Realtime coarse{.dt = kDt, .substeps = 4}, fine{.dt = kDt, .substeps = 8};
  coarse.precision = fine.precision = Precision::Double;
  const auto one = misses(coarse, 180), two = misses(fine, 180);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_LE(one[i], 0.02) << i;
    EXPECT_GT(one[i] / two[i], 3) << i << ": " << one[i] << " and " << two[i];
    EXPECT_LT(one[i] / two[i], 5) << i << ": " << one[i] << " and " << two[i];
  }
}

/// A spring that holds a body at its corner turns it as the torque says: small swings of a bar about its
/// balance, I a'' = -k r^2 a.
TEST(ForceLaws, SpringsTurnBodies) {
  Body bar = mass_point("bar", 1, {0, 0});
  bar.inertia = 0.25;
  bar.angle = 1e-5;
  // Far anchors: the springs' lines keep their direction, to 1e-4 of their length.
  const Scene scene = weightless({bar}, {SpringForce{"world", "bar", {1, 1e4}, {1, 0}, 1e4, 2},
                                         SpringForce{"world", "bar", {-1, 1e4}, {-1, 0}, 1e4, 2}});
  const double w = std::sqrt(2 * 2 * 1 / 0.25);
  const auto states = run(scene, Precise{}, 60);
  EXPECT_NEAR(states[0].angle, 1e-5 * std::cos(w), 1e-5 * 1e-3);
}

/// A kinematic body at the other end carries the spring with it: in its frame the oscillator is at rest.
TEST(ForceLaws, SpringsFollowKinematicBodies) {
  Body cart{.name = "cart", .type = BodyType::Kinematic, .velocity = {2, 0}};
  const Scene scene =
      weightless({cart, mass_point("ball", 1, {3, 0}, {2, 0})}, {SpringForce{"cart", "ball", {}, {}, 2, 9}});
  const double t = 1;
  EXPECT_NEAR(run(scene, Precise{}, 60)[1].position.x, 2 * t + 2 + std::cos(3 * t), 1e-9);
  EXPECT_NEAR(run(scene, Realtime{}, 60)[1].position.x, 2 * t + 2 + std::cos(3 * t), 1e-3);
}

}  // namespace
}  // namespace plumb
