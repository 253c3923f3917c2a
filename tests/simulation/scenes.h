#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/math/trigonometry.h"
#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

/// Small scenes that several tests share.
namespace plumb::testing {

inline constexpr double kGravity = 9.81;

inline Scene empty_scene(Vec2d gravity = {0, -kGravity}) {
  Scene scene;
  scene.name = "test";
  scene.gravity = gravity;
  return scene;
}

inline Body with_shape(std::string name, Geometry geometry, Vec2d position, double friction,
                       double restitution) {
  Body body;
  body.name = std::move(name);
  body.position = position;
  body.shapes = {Shape{geometry, {}, 0, friction, restitution}};
  return body;
}

inline Body disc(std::string name, Vec2d position, double radius = 0.5, double friction = 0,
                 double restitution = 0) {
  return with_shape(std::move(name), Circle{radius}, position, friction, restitution);
}

inline Body box(std::string name, Vec2d position, double width, double height, double friction = 0.5,
                double restitution = 0) {
  return with_shape(std::move(name), Box{width, height}, position, friction, restitution);
}

inline Body fixed(Body body) {
  body.type = BodyType::Static;
  return body;
}

/// A plane through the origin, tilted by `angle`: a plate 1 m thick below it.
inline Body plane(double friction = 0.5, double restitution = 0, double angle = 0) {
  Body body =
      fixed(box("plane", {0.5 * std::sin(angle), -0.5 * std::cos(angle)}, 400, 1, friction, restitution));
  body.angle = angle;
  return body;
}

inline Scene with(Scene scene, std::vector<Body> bodies) {
  scene.bodies.insert(scene.bodies.end(), bodies.begin(), bodies.end());
  return scene;
}

/// Boxes of an edge, m, one on the other.
inline Scene tower(int boxes, double edge = 1) {
  Scene scene = with(empty_scene(), {plane()});
  for (int i = 0; i < boxes; ++i)
    scene.bodies.push_back(box("box " + std::to_string(i), {0, (i + 0.5) * edge}, edge, edge));
  return scene;
}

/// `count` uniform rods of 1 m and 1 kg in a row from the origin along +x, hinged to each other and to the
/// world.
inline Scene rods(int count) {
  Scene scene = empty_scene();
  for (int i = 0; i < count; ++i) {
    Body rod = box("rod " + std::to_string(i), {i + 0.5, 0}, 1, 0.1);
    rod.inertia = 1.0 / 12;
    rod.shapes.clear();
    scene.bodies.push_back(rod);
    scene.joints.push_back(RevoluteJoint{"hinge " + std::to_string(i),
                                         i == 0 ? std::string(kWorld) : "rod " + std::to_string(i - 1),
                                         "rod " + std::to_string(i),
                                         i == 0 ? Vec2d{} : Vec2d{0.5, 0},
                                         {-0.5, 0}});
  }
  return scene;
}

/// The largest distance between the anchors of those hinges.
inline double hinge_gap(const Simulation& world) {
  double largest = 0;
  Vec2d end{};
  for (std::size_t i = 0; i < world.body_count(); ++i) {
    const BodyState rod = world.state(i);
    const Vec2d half = rotation_of(rod.angle) * Vec2d{0.5, 0};
    largest = std::fmax(largest, std::sqrt(length_squared(rod.position - half - end)));
    end = rod.position + half;
  }
  return largest;
}

inline double energy(const Scene& scene, const Simulation& world) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    const BodyState s = world.state(i);
    sum += body.mass * (length_squared(s.velocity) / 2 - dot(scene.gravity, s.position)) +
           inertia_of(body) * s.angular_velocity * s.angular_velocity / 2;
  }
  return sum;
}

/// Boxes, discs and joints that fall into a trough.
inline Scene pile(int count, double restitution) {
  Scene scene =
      with(empty_scene(), {plane(0.5, restitution), fixed(box("left", {-6, 5}, 1, 30, 0.5, restitution)),
                           fixed(box("right", {6, 5}, 1, 30, 0.5, restitution))});
  for (int i = 0; i < count; ++i) {
    const Vec2d position{-4.5 + (i % 9) * 1.1 + 0.05 * (i % 7), 1 + 1.2 * (i / 9)};
    const std::string name = "body " + std::to_string(i);
    Body body = i % 2 == 0 ? box(name, position, 0.9, 0.6 + 0.1 * (i % 3), 0.5, restitution)
                           : disc(name, position, 0.45, 0.5, restitution);
    body.angle = 0.2 * i;
    body.velocity = {0.3 * (i % 5) - 0.6, 0};
    body.angular_velocity = 0.5 * (i % 4) - 1;
    scene.bodies.push_back(body);
  }
  for (int i = 0; i + 9 <= count; i += 9) {
    const auto name = [i](int k) { return "body " + std::to_string(i + k); };
    scene.joints.push_back(RevoluteJoint{"hinge " + name(0), name(0), name(1), {0.55, 0}, {-0.55, 0}});
    scene.joints.push_back(DistanceJoint{"bar " + name(3), name(3), name(4), {}, {}, 1.1});
  }
  return scene;
}

inline Realtime with_integrator(Integrator integrator) {
  Realtime realtime;
  realtime.integrator = integrator;
  return realtime;
}

}  // namespace plumb::testing
