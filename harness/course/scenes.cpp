#include "harness/course/scenes.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
  pass({-2.5, 0.98}, {2, 0});
  return most;
}

}  // namespace plumb::course
