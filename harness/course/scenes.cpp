#include "harness/course/scenes.h"

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

}  // namespace plumb::course
