#include <algorithm>
#include <cmath>

#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

struct Expected {
  Quantity quantity;
  double right, slack;
};

// Returns e^-x from its series, with the same bits everywhere.
double decay(double x) {
  const double part = x / 64;
  double term = 1, sum = 1;
  for (int i = 1; i < 12; ++i) term *= part / i, sum += term;
  for (int i = 0; i < 6; ++i) sum *= sum;
  return 1 / sum;
}

// Builds one body under one force with a known motion: a rocket, a propeller, a parachute, a planet, a
// shaker.
void build(Draft& draft) {
  Random& random = draft.random;
  Case& out = draft.out;
  const double s = draft.size, dt = out.dt;
  draft.site.kind = Site::Kind::Air;
  out.scene.gravity = {0, 0};
  const double from = random.within(-3, 3);
  const bool disc = random.chance(0.5);
  const double width = s * random.within(0.3, 1), height = s * random.within(0.3, 1);
  const int made = disc ? draft.disc({0, 0}, width / 2) : draft.box({0, 0}, width, height, from);
  Body& body = draft.body(made);
  body.angle = from;
  const double mass = body.mass;
  const double inertia = mass * (disc ? width * width / 8 : (width * width + height * height) / 12);
  const int steps = out.steps = std::max(10, static_cast<int>(random.within(0.3, 2) / dt));
  const double t = steps * dt, speed = random.within(0.5, 10) * s;
  const double push = random.within(1, 20) * s;  // m/s^2
  std::vector<Expected> expected;
  switch (random.whole(0, 6)) {
    case 0: {  // a thrust along a spinning body
      const double rate = body.angular_velocity = random.pick({-1.0, 1.0}) * random.within(0.5, 6);
      out.scene.forces.push_back(
          PointForce{.body = body.name, .force = {mass * push, 0}, .frame = Frame::Body});
      const Vec2d first = direction(from), last = direction(from + rate * t);
      const double slack = push / std::abs(rate) * (0.02 + std::abs(rate) * dt);
      expected = {{Quantity::VelocityX, push / rate * (last.y - first.y), slack},
                  {Quantity::VelocityY, -push / rate * (last.x - first.x), slack}};
      break;
    }
    case 1: {  // an off-centre force, or a torque, for a limited time
      const double arm = random.within(-0.5, 0.5) * height, lasts = random.within(0.2, 1.2) * t;
      const double turn = -arm * mass * push;
      if (random.chance(0.5)) {
        out.scene.forces.push_back(PointForce{.body = body.name,
                                              .force = {mass * push, 0},
                                              .point = {0, arm},
                                              .frame = Frame::Body,
                                              .duration = lasts});
      } else {
        out.scene.forces.push_back(Torque{.body = body.name, .torque = turn, .duration = lasts});
      }
      const double right = turn / inertia * std::min(t, lasts);
      expected = {
          {Quantity::AngularVelocity, right, 0.01 * std::abs(right) + 2 * dt * std::abs(turn) / inertia}};
      break;
    }
    case 2: {                                      // a parachute
      const double share = random.within(0.2, 2);  // 1/s
      body.velocity = {speed, 0};
      out.scene.forces.push_back(LinearDrag{.body = body.name, .coefficient = share * mass});
      expected = {{Quantity::VelocityX, speed * decay(share * t), speed * (0.01 + share * dt)}};
      break;
    }
    case 3: {
      const double share = random.within(0.2, 2) / speed;  // 1/m
      body.velocity = {0, speed};
      out.scene.forces.push_back(QuadraticDrag{.body = body.name, .coefficient = share * mass});
      expected = {
          {Quantity::VelocityY, speed / (1 + share * speed * t), speed * (0.01 + share * speed * dt)}};
      break;
    }
    case 4: {  // a sinusoidal force
      const double rate = random.within(1, 6), phase = random.within(0, 6);
      out.scene.forces.push_back(SinusoidalForce{
          .body = body.name, .amplitude = {0, mass * push}, .angular_frequency = rate, .phase = phase});
      expected = {{Quantity::VelocityY, push / rate * (direction(phase).x - direction(rate * t + phase).x),
                   push / rate * (0.02 + rate * dt)}};
      break;
    }
    case 5: {  // a planet on a circle
      const double radius = random.within(2, 5) * s, rate = random.within(0.5, 3);
      const int exponent = random.pick({-1, 0, 1, 2});
      double strength = rate * rate * radius;
      for (int i = 0; i < std::abs(exponent); ++i)
        strength = exponent > 0 ? strength * radius : strength / radius;
      body.position = {radius, 0}, body.velocity = {0, rate * radius};
      out.scene.forces.push_back(
          AttractionForce{.body = body.name, .strength = strength, .exponent = exponent});
      const Vec2d last = direction(rate * t);
      const double slack = radius * (0.02 + rate * dt * (1 + rate * t));
      expected = {{Quantity::X, radius * last.x, slack}, {Quantity::Y, radius * last.y, slack}};
      break;
    }
    default: {  // a load on a spring
      const double rate = random.within(0.5, 4), rest = 3 * s, away = random.within(0.1, 1) * s;
      body.position = {rest + away, 0};
      out.scene.forces.push_back(SpringForce{.body_a = std::string(kWorld),
                                             .body_b = body.name,
                                             .rest_length = rest,
                                             .stiffness = rate * rate * mass});
      expected = {
          {Quantity::X, rest + away * direction(rate * t).x, away * (0.02 + rate * dt * (1 + rate * t))}};
    }
  }
  for (const Expected& each : expected) {
    Expectation& moves = draft.expect("follows_its_force", made, each.quantity);
    moves.lower = each.right - each.slack, moves.upper = each.right + each.slack;
    moves.from = moves.to = t;
    moves.needs = {std::string(kMasses)};
    moves.why = "a body moves under the force on it; each of these motions has a closed form";
  }
}

const Register r{{.name = "forces",
                  .title = "a body under a force whose motion has a closed form",
                  .weight = 1,
                  .air = true,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
