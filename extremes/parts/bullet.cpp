#include "extremes/parts/bullet.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb::extremes {
namespace {

double norm(Vec2d v) { return std::hypot(v.x, v.y); }

Body bullet_body(std::string name, const Bullet& bullet, double speed, double side) {
  return {.name = std::move(name),
          .position = {side * (bullet.reach + kFlight * kDt * speed), 0},
          .angle = bullet.angle,
          .velocity = {-side * speed, 0},
          .shapes = {{.geometry = bullet.geometry, .friction = 0, .restitution = 1}}};
}

// Returns the exact state of the body that comes from `side` (-1: the left).
BodyState exact_state(const Bullet& bullet, double speed, double side, double time) {
  const double hit = kFlight * kDt, away = bullet.reach + speed * std::abs(hit - time);
  return {.position = {side * away, 0},
          .angle = bullet.angle,
          .velocity = {time < hit ? -side * speed : side * speed, 0}};
}

Rule speed_before(double speed, std::size_t body, double side) {
  Rule rule{.measure = "relative error of the velocity before the impact",
            .bound = 0.01,
            .beyond = Verdict::Freezes,
            .explodes = 10};
  rule.figure = [=](double time, std::span<const BodyState> states) {
    if (time > (kFlight - 0.25) * kDt) return 0.0;
    return norm(states[body].velocity - Vec2d{-side * speed, 0}) / speed;
  };
  return rule;
}

Rule speed_after(double speed, std::size_t body, double side) {
  Rule rule{.measure = "relative error of the velocity after the impact",
            .bound = 0.05,
            .beyond = Verdict::Freezes,
            .explodes = 10};
  rule.figure = [=](double time, std::span<const BodyState> states) {
    if (time < (kSteps - 0.5) * kDt) return 0.0;
    return norm(states[body].velocity - Vec2d{side * speed, 0}) / speed;
  };
  return rule;
}

// `beyond` returns the distance by which a body is beyond the obstacle, m.
Rule nothing_beyond(std::function<double(std::span<const BodyState>)> beyond) {
  Rule rule{.measure = "distance past the obstacle",
            .unit = "m",
            .bound = 0,
            .beyond = Verdict::Tunnels,
            .sane = 0};
  rule.figure = [beyond = std::move(beyond)](double, std::span<const BodyState> states) {
    return std::max(0.0, beyond(states));
  };
  return rule;
}

}  // namespace

Trial shot(std::string name, const Bullet& bullet, double speed, double thickness) {
  Trial trial{.scene = {.name = std::move(name), .gravity = {}}, .stretches = {{kSteps, 1}}};
  trial.scene.bodies = {bullet_body("bullet", bullet, speed, -1),
                        {.name = "wall",
                         .type = BodyType::Static,
                         .position = {thickness / 2, 0},
                         .shapes = {{.geometry = Box{thickness, 20}, .friction = 0, .restitution = 1}}}};
  trial.exact = [=, wall = initial_state(trial.scene.bodies[1])](double t, std::span<BodyState> out) {
    out[0] = exact_state(bullet, speed, -1, t);
    out[1] = wall;
  };
  trial.judge = [=](const Scene&) {
    const auto beyond = [=](std::span<const BodyState> states) {
      return states[0].position.x - thickness / 2;
    };
    return judge_by({nothing_beyond(beyond), speed_before(speed, 0, -1), speed_after(speed, 0, -1)});
  };
  return trial;
}

Trial two_shots(std::string name, const Bullet& bullet, double speed) {
  Trial trial{.scene = {.name = std::move(name), .gravity = {}}, .stretches = {{kSteps, 1}}};
  trial.scene.bodies = {bullet_body("left", bullet, speed, -1), bullet_body("right", bullet, speed, 1)};
  trial.exact = [=](double t, std::span<BodyState> out) {
    out[0] = exact_state(bullet, speed, -1, t);
    out[1] = exact_state(bullet, speed, 1, t);
  };
  trial.judge = [=](const Scene&) {
    const auto beyond = [](std::span<const BodyState> states) {
      return states[0].position.x - states[1].position.x;
    };
    return judge_by({nothing_beyond(beyond), speed_before(speed, 0, -1), speed_before(speed, 1, 1),
                     speed_after(speed, 0, -1), speed_after(speed, 1, 1)});
  };
  return trial;
}

}  // namespace plumb::extremes
