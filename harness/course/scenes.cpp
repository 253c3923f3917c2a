#include "harness/course/scenes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace plumb::course {

Body make(const Ball& ball) {
  Body body;
  body.name = ball.name;
  body.position = ball.position;
  body.velocity = ball.velocity;
  body.mass = ball.mass;
  body.shapes.push_back({.geometry = Circle{ball.radius}, .friction = 0, .restitution = ball.restitution});
  return body;
}

Body make(const Crate& crate) {
  Body body;
  body.name = crate.name;
  body.position = crate.position;
  body.velocity = crate.velocity;
  body.angle = crate.angle;
  body.angular_velocity = crate.angular_velocity;
  body.mass = crate.mass;
  body.shapes.push_back({.geometry = Box{crate.width, crate.height},
                         .friction = crate.friction,
                         .restitution = crate.restitution});
  return body;
}

Body fixed(Body body) {
  body.type = BodyType::Static;
  body.velocity = {};
  body.angular_velocity = 0;
  return body;
}

Scene scene_of(std::string name, Vec2d gravity, std::vector<Body> bodies) {
  Scene scene;
  scene.name = std::move(name);
  scene.gravity = gravity;
  scene.bodies = std::move(bodies);
  return scene;
}

PointForce push(const std::string& body, Vec2d force, Vec2d point) {
  PointForce law;
  law.body = body;
  law.force = force;
  law.point = point;
  return law;
}

double least_gain_above(const Lab& lab, const Trace& trace, double r, double g) {
  double least = 1;
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    const BodyState &before = trace.states[k - 1][0], &after = trace.states[k][0];
    const bool rises = before.velocity.y > 0 && after.velocity.y > 0;
    const bool above = rises && before.position.y > r + 1e-3 && after.position.y > r + 1e-3;
    if (above) least = std::min(least, (before.velocity.y - after.velocity.y) / (g * lab.dt()));
  }
  return least;
}

double turn_at_platform(const Lab& lab) {
  const Body platform = fixed(make(Crate{.name = "platform", .width = 2, .height = 1}));
  double most = 0;
  const auto pass = [&](Vec2d from, Vec2d velocity) {
    const Body ball = make(Ball{.position = from, .velocity = velocity, .radius = 0.4});
    const Vec2d change = lab.run(scene_of("platform", {}, {ball, platform}), 2).last(0).velocity - velocity;
    most = std::max(most, std::hypot(change.x, change.y));
  };
  pass({1.7, 2}, {0, -2});
  pass({-0.16, 2.34}, {1.5, -1.5});  // past the corner, within a radius of it along x and along y
  pass({-2.5, 0.98}, {2, 0});
  return most;
}

std::string wall_passed(const BodyState& s, double half_width, double half_height) {
  if (s.position.x > half_width) return "right";
  if (s.position.x < -half_width) return "left";
  if (s.position.y > half_height) return "upper";
  return s.position.y < -half_height ? "lower" : "";
}

bool leaves_straight(const Trace& trace, double x, double y, double r) {
  const auto at = [&](std::size_t i) { return trace.states[i][0]; };
  const std::size_t last = trace.states.size() - 1;
  const bool by_side = std::abs(at(last).position.x) > x;
  const auto axis = by_side ? &Vec2d::x : &Vec2d::y;
  std::size_t k = last;
  while (k > 0 && std::abs(at(k).position.*axis) >= (by_side ? x : y)) --k;
  const double step = at(std::min(k + 1, last)).position.*axis - at(k).position.*axis;
  return at(k).velocity.*axis == at(last).velocity.*axis && std::abs(step) < r;
}

Fling fling(const Lab& lab, double speed, double duration) {
  const Vec2d v{speed, 0.3 * speed};
  const Ball ball{.position = {-0.4 * speed * duration, 0}, .velocity = v};
  const Trace trace = lab.run(scene_of("fling", {}, {make(ball)}), duration);
  const Vec2d early = trace.states[1][0].velocity, end = trace.last(0).velocity;
  const auto much = [](Vec2d a, Vec2d b) {
    return std::abs(a.x - b.x) + std::abs(a.y - b.y) > 0.01 * (std::abs(a.x) + std::abs(a.y));
  };
  const bool cut = much(v, early) && early.x > 0 && early.x <= v.x && early.y > 0 && early.y <= v.y;
  Fling out{.way = trace.last(0).position.x - ball.position.x, .due = v.x * trace.duration()};
  out.speed = std::max(early.x, early.y);
  out.held = trace.still(0) && (end == v || end == Vec2d{});
  out.limited = cut && early == end;
  return out;
}

std::optional<std::string> wall_of_no_scene(const Lab& lab) {
  constexpr double kRadius = 0.4, kAway = 1000;  // m
  // Engines that go through the static boxes and put walls of their own in their place need a box.
  const Body far = fixed(make(Crate{.name = "far", .position = {kAway, -kAway}}));
  for (const Vec2d v : {Vec2d{-12, -9}, Vec2d{12, 9}}) {
    const Scene empty =
        scene_of("empty", {}, {make(Ball{.position = -0.25 * v, .velocity = v, .radius = kRadius}), far});
    const Trace trace = lab.run(empty, 3);
    std::size_t k = 1;
    while (k < trace.states.size() && trace.states[k][0].velocity == v) ++k;
    if (k == trace.states.size()) continue;
    const BodyState& turned = trace.states[k][0];
    const auto wall = [&](const char* axis, double at, double before, double after) {
      const double place = at + std::copysign(kRadius, before);
      return before * after < 0 ? std::optional(fmt::format(
                                      "A ball that is far from every wall turns round at {} = {:.2g}: the "
                                      "walls are the scene's static boxes, and no others.",
                                      axis, std::abs(place) < 0.05 ? 0 : place))
                                : std::nullopt;
    };
    if (auto found = wall("x", turned.position.x, v.x, turned.velocity.x)) return found;
    if (auto found = wall("y", turned.position.y, v.y, turned.velocity.y)) return found;
  }
  return std::nullopt;
}

std::string limit_text(double speed) {
  return fmt::format(
      "A ball is thrown at {:.4g} m/s, and moves at {:.4g} m/s from the first step on: nothing limits speeds "
      "here, so leave that out.",
      kFast, speed);
}

}  // namespace plumb::course
