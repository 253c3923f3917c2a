#include "bench/features/scenes.h"

#include <string>
#include <utility>

namespace plumb::bench {
namespace {

constexpr int kRest = 64;
constexpr double kFar = 1000;  // m, between the bodies that use a feature and the other bodies

// Returns a shape that collides with nothing, for the bodies of all features but contacts.
Shape ghost() {
  Shape shape{.geometry = Box{1, 0.5}};
  shape.filter.mask = 0;
  return shape;
}

Body body(std::string name, Vec2d position, Shape shape) {
  return {.name = std::move(name),
          .position = position + Vec2d{kFar, 0},
          .mass = 1,
          .inertia = 0.1,
          .shapes = {std::move(shape)}};
}

void add_pair(Scene& scene) {
  scene.bodies.push_back(body("a", {0, 0}, ghost()));
  scene.bodies.push_back(body("b", {1, 0}, ghost()));
}

void add_spring(Scene& scene) {
  add_pair(scene);
  scene.forces.push_back(SpringForce{.body_a = "a", .body_b = "b", .rest_length = 0.8, .stiffness = 50});
}

void add_drag(Scene& scene) {
  add_pair(scene);
  scene.forces.push_back(QuadraticDrag{.body = "a", .coefficient = 0.1});
}

void add_attraction(Scene& scene) {
  add_pair(scene);
  scene.forces.push_back(AttractionForce{.body = "a", .centre = {kFar, 5}, .strength = 1});
}

void add_thrust(Scene& scene) {
  add_pair(scene);
  scene.forces.push_back(PointForce{.body = "a", .force = {1, 0}, .point = {0, 0.2}, .frame = Frame::Body});
}

void add_joint(Scene& scene) {
  add_pair(scene);
  scene.joints.push_back(RevoluteJoint{
      .name = "hinge", .body_a = "a", .body_b = "b", .anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}});
}

// Adds a disc above a floor that no other body can reach.
void add_disc(Scene& scene, double height, Vec2d velocity, double restitution, double friction) {
  Shape disc{.geometry = Circle{0.5}, .friction = friction, .restitution = restitution};
  Body ball = body("a", {0, 0.5 + height}, disc);
  ball.velocity = velocity;
  scene.bodies.push_back(std::move(ball));
  Shape floor{.geometry = Box{200, 1}, .friction = friction, .restitution = restitution};
  Body ground = body("b", {0, -0.5}, floor);
  ground.type = BodyType::Static;
  ground.inertia.reset();
  scene.bodies.push_back(std::move(ground));
}

void declare_contact(Body& body) { body.shapes.push_back(ghost()); }

void declare_friction(Body& body) {
  body.shapes.push_back(ghost());
  body.shapes.back().friction = 1;
}

void declare_restitution(Body& body) {
  body.shapes.push_back(ghost());
  body.shapes.back().restitution = 1;
}

void add_contact(Scene& scene) { add_disc(scene, 0, {0, 0}, 0, 0); }
void add_friction(Scene& scene) { add_disc(scene, 0, {3, 0}, 0, 0.5); }
void add_restitution(Scene& scene) { add_disc(scene, 0.2, {0, 0}, 0.9, 0); }

}  // namespace

const std::vector<Feature>& features() {
  static const std::vector<Feature> all{
      {"spring", "a spring between two bodies", add_spring},
      {"drag", "quadratic drag on a body", add_drag},
      {"attraction", "a point that attracts a body", add_attraction},
      {"thrust", "a force at a point of a body, turning with it", add_thrust},
      {"joint", "a hinge between two bodies", add_joint},
      {"contact", "a disc resting on a floor", add_contact, declare_contact},
      {"friction", "a disc sliding and rolling on a floor", add_friction, declare_friction},
      {"restitution", "a disc bouncing on a floor", add_restitution, declare_restitution},
  };
  return all;
}

void add_rest(Scene& scene, const Feature* declared) {
  for (int i = 0; i < kRest; ++i) {
    scene.bodies.push_back({.name = "rest" + std::to_string(i),
                            .position = {3.0 * i, 2},
                            .velocity = {1, 5},
                            .angular_velocity = 1,
                            .mass = 1,
                            .inertia = 0.1});
    if (declared != nullptr && declared->declare != nullptr) declared->declare(scene.bodies.back());
  }
}

}  // namespace plumb::bench
