#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulation/scenes.h"

namespace plumb {
namespace {

using namespace plumb::testing;

/// Two discs that meet once, without friction: closed form, with the normal at the time of contact.
struct Meeting {
  BodyState a, b;
  double mass_a = 1, mass_b = 1, radii = 1, restitution = 1;

  double time() const {  // |d + t v| = radii
    const Vec2d d = b.position - a.position, v = b.velocity - a.velocity;
    const double half = dot(d, v), square = length_squared(v);
    return (-half - std::sqrt(half * half - square * (length_squared(d) - radii * radii))) / square;
  }
  void after(double t, BodyState& out_a, BodyState& out_b) const {
    const double met = time();
    const Vec2d d = b.position - a.position, v = b.velocity - a.velocity;
    const Vec2d normal = (1 / radii) * (d + met * v);
    const Vec2d impulse = (-(1 + restitution) * dot(v, normal) / (1 / mass_a + 1 / mass_b)) * normal;
    out_a.velocity = a.velocity - (1 / mass_a) * impulse;
    out_b.velocity = b.velocity + (1 / mass_b) * impulse;
    out_a.position = a.position + met * a.velocity + (t - met) * out_a.velocity;
    out_b.position = b.position + met * b.velocity + (t - met) * out_b.velocity;
  }
};

void expect_meeting(const Meeting& meeting, double tolerance, Precision precision = Precision::Double) {
  Body a = disc("a", meeting.a.position, 0.6 * meeting.radii, 0, meeting.restitution);
  Body b = disc("b", meeting.b.position, 0.4 * meeting.radii, 0, meeting.restitution);
  a.velocity = meeting.a.velocity, a.mass = meeting.mass_a;
  b.velocity = meeting.b.velocity, b.mass = meeting.mass_b;
  Simulation world = compile(with(empty_scene({0, 0}), {a, b}), Realtime{.precision = precision});
  world.step(60);
  BodyState expected[2];
  meeting.after(world.time(), expected[0], expected[1]);
  for (int i = 0; i < 2; ++i) {
    const BodyState state = world.state(i);
    EXPECT_NEAR(state.velocity.x, expected[i].velocity.x, tolerance) << i;
    EXPECT_NEAR(state.velocity.y, expected[i].velocity.y, tolerance) << i;
    EXPECT_NEAR(state.position.x, expected[i].position.x, 2 * tolerance) << i;
    EXPECT_NEAR(state.position.y, expected[i].position.y, 2 * tolerance) << i;
  }
}

/// Rounding, where bodies bounce. What stays together is the contact solver's, whose softness leaves 1e-7 of
/// an impact.
double tolerance_of(double restitution) { return restitution > 0 ? 3e-13 : 1e-7; }

TEST(Impacts, HeadOnIsExactAtAnyMassRatioAndRestitution) {
  for (const double e : {0.0, 0.3, 1.0})
    for (const double mass : {1.0, 10.0, 1e3, 1e6}) {
      expect_meeting({{{0, 0}, 0, {2, 0}}, {{2.3, 0}, 0, {-1, 0}}, mass, 1, 0.9, e}, tolerance_of(e));
      expect_meeting({{{0, 0}, 0, {2, 0}}, {{2.3, 0}, 0, {-1, 0}}, 1, mass, 0.9, e}, tolerance_of(e));
    }
}

/// Equal discs swap velocities. With gaps that the last but one crosses in a later substep of the same step,
/// nothing near it moved when pairs were looked for.
TEST(Impacts, PassDownARowWithinOneStep) {
  constexpr double kSpeed = 2, kGaps[] = {0.83, 0.077, 0.111, 0.053};
  Scene scene = with(empty_scene({0, 0}), {disc("0", {0, 0}, 0.25, 0, 1)});
  scene.bodies[0].velocity = {kSpeed, 0};
  double path = 0;
  for (const double gap : kGaps) {
    path += gap;
    Body next = disc(std::to_string(scene.bodies.size()), scene.bodies.back().position, 0.25, 0, 1);
    next.position.x += 0.5 + gap;
    scene.bodies.push_back(next);
  }
  Simulation world = compile(scene, Realtime{.dt = 1.0 / 17});
  world.step(17);
  const double flown = kSpeed * world.time() - path;
  EXPECT_NEAR(world.state(4).position.x, scene.bodies[4].position.x + flown, 1e-13);
  EXPECT_NEAR(world.state(4).velocity.x, kSpeed, 1e-15);
}

TEST(Impacts, ObliqueIsExact) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double offset : {-0.4, 0.1, 0.35, 0.6})
      for (const Precision precision : {Precision::Double, Precision::Float})
        expect_meeting({{{0, 0}, 0, {2, 0}}, {{2.3, offset}, 0, {-1, 0.2}}, 1, 3, 0.9, e},
                       precision == Precision::Double ? tolerance_of(e) : 2e-6, precision);
}

TEST(Impacts, FastDiscsThatPassDoNotTouch) {
  for (const double e : {0.0, 1.0}) {
    Body a = disc("a", {0, 0}, 0.5, 0, e), b = disc("b", {200, 1.001}, 0.5, 0, e);
    a.velocity = {1000, 0};
    b.velocity = {-1000, 0};
    Simulation world = compile(with(empty_scene({0, 0}), {a, b}));
    world.step(30);
    EXPECT_EQ(world.state(0).velocity, (Vec2d{1000, 0}));
    EXPECT_EQ(world.state(1).velocity, (Vec2d{-1000, 0}));
  }
}

// With gaps each hit passes the whole velocity on, in whatever step it falls.
TEST(Impacts, CradleWithGaps) {
  const double gap = 0.3;
  Scene scene = empty_scene({0, 0});
  for (int i = 0; i < 5; ++i)
    scene.bodies.push_back(disc("ball " + std::to_string(i), {i * (1 + gap), 0}, 0.5, 0, 1));
  scene.bodies[0].velocity = {3, 0};
  const double path = 4 * gap;  // the motion is handed on over four gaps
  Simulation world = compile(scene);
  world.step(static_cast<int>(std::ceil(path / 3 * 60)) + 3);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(world.state(i).velocity.x, 0) << i;
    EXPECT_NEAR(world.state(i).position.x, i * (1 + gap) + gap, 3e-13) << i;
  }
  EXPECT_NEAR(world.state(4).velocity.x, 3, 1e-12);
  EXPECT_NEAR(world.state(4).position.x, 4 * (1 + gap) + 3 * world.time() - path, 1e-12);
}

// Drops and bounces under gravity: the parabola inside the substep makes them exact.
TEST(Impacts, BouncingBallIsExact) {
  for (const double e : {1.0, 0.8}) {
    Simulation world = compile(with(empty_scene(), {plane(0, e), disc("ball", {0, 1.5}, 0.5, 0, e)}));
    for (int i = 0; i < 150; ++i) {
      world.step();
      double t = world.time() - std::sqrt(2 / kGravity), speed = e * std::sqrt(2 * kGravity);
      double height = 1 - kGravity * world.time() * world.time() / 2;
      if (t > 0) {
        for (; t > 2 * speed / kGravity; speed *= e) t -= 2 * speed / kGravity;
        height = speed * t - kGravity * t * t / 2;
      }
      EXPECT_NEAR(world.state(1).position.y - 0.5, height, 2e-11) << world.time();
    }
  }
}

// T = sqrt(2h/g) (1+e)/(1-e) = 4.0637 s for e = 0.8 and h = 1 m; then it lies still.
TEST(Impacts, BouncesEndInRest) {
  Simulation world = compile(with(empty_scene(), {plane(0, 0.8), disc("ball", {0, 1.5}, 0.5, 0, 0.8)}));
  world.step(300);
  for (int i = 0; i < 60; ++i) {
    world.step();
    EXPECT_NEAR(world.state(1).position.y, 0.5, 2e-5);
    EXPECT_NEAR(world.state(1).velocity.y, 0, 1e-6);
  }
}

// A rod that falls on its end, no friction: w = (1+e) m v (L/2) cos / (I (1 + 3 cos^2)), at the moment of
// contact.
TEST(Impacts, FallingRodTurnsAsTheClosedFormSays) {
  const double theta = 0.6, e = 0.5, height = 1.7, thickness = 1e-3;
  Body rod = box("rod", {0, height}, 1, thickness, 0, e);
  rod.angle = theta;
  Simulation world = compile(with(empty_scene(), {plane(0, e), rod}));
  const double fall = height - (std::sin(theta) + thickness * std::cos(theta)) / 2;
  const double speed = std::sqrt(2 * kGravity * fall), inertia = (1 + thickness * thickness) / 12;
  const double lever = (std::cos(theta) - thickness * std::sin(theta)) / 2;
  const double impulse = (1 + e) * speed / (1 + lever * lever / inertia);
  const double contact = speed / kGravity;
  world.step(static_cast<int>(contact * 60) + 2);
  EXPECT_NEAR(world.state(1).angular_velocity, -impulse * lever / inertia, 3e-11);
  EXPECT_NEAR(world.state(1).velocity.y, -speed + impulse - kGravity * (world.time() - contact), 3e-11);
}

TEST(Impacts, NothingTunnels) {
  for (const double speed : {100.0, 1000.0, 1e4}) {
    for (const double e : {0.0, 1.0}) {
      Body ball = disc("ball", {0.3, 0.1}, 0.5, 0, e), pellet = disc("pellet", {0.3, 40}, 0.05, 0, e);
      ball.velocity = pellet.velocity = {speed, 0};
      Simulation world =
          compile(with(empty_scene({0, 0}), {fixed(box("wall", {50, 0}, 0.1, 4, 0, e)),
                                             fixed(disc("post", {50, 40}, 0.05, 0, e)), ball, pellet}));
      world.step(60);
      const double from = 50 - 0.05 - 0.5, path = speed * 1 - (from - 0.3);
      EXPECT_NEAR(world.state(2).position.x, from - e * path, 1e-11 * speed) << speed;
      EXPECT_NEAR(world.state(2).velocity.x, -e * speed, 1e-11 * speed);
      EXPECT_NEAR(world.state(3).velocity.x, -e * speed, 1e-11 * speed);
    }
  }
}

}  // namespace
}  // namespace plumb
