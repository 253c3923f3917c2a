#pragma once

#include <string>
#include <vector>

#include "engine/math/trigonometry.h"
#include "engine/scene/scene.h"

/// Scenes that are taken to extremes.
namespace plumb::test {

inline constexpr double kGravity = 9.81;

/// A box of a mass; no restitution, friction 0.5.
inline Body tight_aabb(std::string name, Vec2d position, double width, double height, double mass) {
  Body body;
  body.name = std::move(name);
  body.position = position;
  body.mass = mass;
  body.shapes = {Shape{Box{width, height}, {}, 0, 0.5, 0}};
  return body;
}

inline Body fixed(Body body) {
  body.type = BodyType::Static;
  return body;
}

/// A uniform rod of a length and mass about its end, at rest level, without a shape.
inline Scene rod_pendulum(Vec2d pivot, double length = 1, double mass = 1) {
  Scene scene{.name = "pendulum"};
  Body rod = tight_aabb("rod", pivot + Vec2d{length / 2, 0}, length, length / 10, mass);
  rod.shapes.clear();
  rod.inertia = mass * length * length / 12;
  scene.bodies = {rod};
  scene.joints = {RevoluteJoint{"hinge", std::string(kWorld), "rod", pivot, {-length / 2, 0}}};
  return scene;
}

/// Ten links of 1 m and 1 kg from the origin in a direction, the last one of mass `tip`. They do not touch.
inline Scene chain_with_tip(double angle, double tip) {
  Scene scene{.name = "chain"};
  const Rotation<double> q = rotation_of(angle);
  for (int i = 0; i < 10; ++i) {
    Body link = tight_aabb("link " + std::to_string(i), q * Vec2d{i + 0.5, 0}, 1, 0.2, i == 9 ? tip : 1);
    link.angle = angle;
    link.shapes[0].filter.group = -1;
    scene.joints.push_back(RevoluteJoint{"joint " + std::to_string(i),
                                         i == 0 ? std::string(kWorld) : scene.bodies.back().name,
                                         link.name,
                                         i == 0 ? Vec2d{} : Vec2d{0.5, 0},
                                         {-0.5, 0}});
    scene.bodies.push_back(link);
  }
  return scene;
}

/// A box on a lighter one of 1 kg, on a ground; bodies 0 ground, 1 light, 2 heavy.
inline Scene heavy_on_light(double ratio) {
  Scene scene{.name = "heavy on light"};
  scene.bodies = {fixed(tight_aabb("ground", {0, -0.5}, 20, 1, 1)), tight_aabb("light", {0, 0.5}, 1, 1, 1),
                  tight_aabb("heavy", {0, 1.5}, 1, 1, ratio)};
  return scene;
}

}  // namespace plumb::test
