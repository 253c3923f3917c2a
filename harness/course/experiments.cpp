#include "harness/course/experiments.h"

#include <cmath>
#include <string>
#include <utility>

#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr double kGravity = 9.81;
// The chapters in which forces act, balls collide and boxes turn.
constexpr int kForces = 2, kCollisions = 3, kBoxes = 4;

Body disc(Ball ball, double spin, double friction) {
  Body out = make(ball);
  out.angular_velocity = spin;
  out.shapes.front().friction = friction;
  return out;
}

Body crate(Crate of, double friction) {
  of.friction = friction;
  return make(of);
}

Body ground(double restitution, double friction) {
  return fixed(make(Crate{.name = "ground",
                          .position = {0.2, -1},
                          .width = 20,
                          .height = 2,
                          .restitution = restitution,
                          .friction = friction}));
}

// Two discs of unequal mass that meet off their centres, then a static one.
Experiment three_discs(double friction) {
  return {scene_of("three discs", {},
                   {disc({.name = "a",
                          .position = {-2, 0.1},
                          .velocity = {5, 0.3},
                          .mass = 1,
                          .radius = 0.3,
                          .restitution = 0.6},
                         friction > 0 ? 3 : 0, friction),
                    disc({.name = "b",
                          .position = {-0.6, 0.3},
                          .velocity = {-0.4, 0},
                          .mass = 3,
                          .radius = 0.5,
                          .restitution = 0.3},
                         friction > 0 ? -2 : 0, friction),
                    fixed(disc({.name = "c", .position = {0.7, 0.5}, .radius = 0.4, .restitution = 0.5}, 0,
                               friction))}),
          2};
}

// Two balls that fall side by side and meet more slowly than the speed below which restitution is 0.
Experiment slow_meeting() {
  return {
      scene_of(
          "slow meeting", {0, -kGravity},
          {make(Ball{
               .name = "a", .position = {-0.43, 0}, .velocity = {0.1, 2}, .mass = 1, .restitution = 0.6}),
           make(Ball{
               .name = "b", .position = {0.4, 0.1}, .velocity = {-0.08, 2}, .mass = 3, .restitution = 0.6})}),
      0.5};
}

// Two balls of unequal mass on a damped spring that fall together: the sum of their velocities is not 0.
Experiment falling_spring(Vec2d a, Vec2d b) {
  Scene scene = scene_of("falling spring", {0.5, -7},
                         {make(Ball{.name = "a", .position = a, .mass = 1, .radius = 0.2}),
                          make(Ball{.name = "b", .position = b, .mass = 3, .radius = 0.2})});
  SpringForce spring;
  spring.body_a = "a";
  spring.body_b = "b";
  spring.stiffness = 12;
  spring.damping = 0.8;
  spring.rest_length = 1.3;
  scene.forces.emplace_back(spring);
  return {std::move(scene), 1};
}

// A ball in the air with drag, whose velocities along x and y change their signs.
Experiment ball_with_drag() {
  Scene scene = scene_of("ball with drag", {6, -7},
                         {make(Ball{.position = {1, 2}, .velocity = {-1.5, 2}, .mass = 2, .radius = 0.3})});
  LinearDrag drag;
  drag.body = scene.bodies[0].name;
  drag.coefficient = 1.5;
  scene.forces.emplace_back(drag);
  return {std::move(scene), 1};
}

// A ball in the air.
Experiment free_ball() {
  return {scene_of("free ball", {0, -7},
                   {make(Ball{.position = {1, 2}, .velocity = {-1, 3}, .mass = 3, .radius = 0.3})}),
          1};
}

Scene turning_box() {
  return scene_of("turning box", {0, -kGravity},
                  {make(Crate{.name = "box",
                              .position = {1, 2},
                              .velocity = {0.5, 1},
                              .angle = 0.5,
                              .angular_velocity = -1,
                              .mass = 3,
                              .width = 1.2,
                              .height = 0.4})});
}

// A ball that lands with more than a step's gravity and less than two steps', the speed below which
// restitution is 0; a bounce would lift it off the floor.
Experiment soft_landing() {
  return {scene_of("soft landing", {0, -kGravity},
                   {make(Ball{.position = {0, 0.401}, .velocity = {0, -0.1}, .restitution = 0.9}),
                    ground(0.5, 0)}),
          0.5};
}

// A ball that lands on a floor which comes first in the scene, and stays.
Experiment landing_ball() {
  return {scene_of("landing ball", {0, -kGravity},
                   {ground(0.2, 0),
                    make(Ball{.position = {0.3, 0.5}, .velocity = {0.5, -1}, .restitution = 0.3})}),
          1};
}

// A ball that overlaps the floor at the start and leaves it: no impulse has acted that a sum could hold.
Experiment leaving_ball() {
  return {
      scene_of("leaving ball", {},
               {make(Ball{.position = {0, 0.39}, .velocity = {0.5, 1}, .restitution = 0.6}), ground(0.2, 0)}),
      0.5};
}

// A force at a point of a box that turns in the air.
Experiment pushed_box() {
  Scene scene = turning_box();
  scene.forces.emplace_back(push("box", {2, -7}, {0.4, 0.1}));
  return {std::move(scene), 0.8};
}

// A torque on a box that rotates in the air.
Experiment twisted_box() {
  Scene scene = turning_box();
  Torque torque;
  torque.body = "box";
  torque.torque = 1.5;
  scene.forces.emplace_back(torque);
  return {std::move(scene), 0.8};
}

// A disc that spins and lands on the ground; the ground is the first body.
Experiment spinning_disc() {
  return {scene_of("spinning disc", {0, -kGravity},
                   {ground(0.2, 0.5), disc({.name = "disc",
                                            .position = {-0.5, 0.8},
                                            .velocity = {1, -1},
                                            .mass = 2,
                                            .radius = 0.4,
                                            .restitution = 0.4},
                                           9, 0.7)}),
          1};
}

Experiment landing_box(double friction, double angle) {
  return {scene_of("landing box", {0, -kGravity},
                   {crate({.name = "box",
                           .position = {-0.7, 1.1},
                           .velocity = {2, -1},
                           .angle = angle,
                           .angular_velocity = angle == 0 ? 0.0 : -2.0,
                           .mass = 2,
                           .width = 1,
                           .height = 0.6,
                           .restitution = 0.3},
                          friction),
                    ground(0.2, friction)}),
          0.8};
}

// Two boxes that meet off their centres in the air.
Experiment two_boxes(double friction) {
  return {scene_of("two boxes", {},
                   {crate({.name = "a",
                           .position = {-1.2, 0.2},
                           .velocity = {2, 0.2},
                           .angle = 0.4,
                           .angular_velocity = 1,
                           .mass = 1,
                           .width = 0.8,
                           .height = 0.5,
                           .restitution = 0.5},
                          friction),
                    crate({.name = "b",
                           .position = {0.3, -0.1},
                           .velocity = {-0.5, 0},
                           .angle = -0.2,
                           .mass = 3,
                           .width = 0.6,
                           .height = 1.4,
                           .restitution = 0.4},
                          friction)}),
          1};
}

void add_stick(Scene& scene, const std::string& a, const std::string& b, double length, Vec2d anchor_a = {}) {
  DistanceJoint stick;
  stick.name = "stick " + a + " " + b;
  stick.body_a = a;
  stick.body_b = b;
  stick.anchor_a = anchor_a;
  stick.length = length;
  scene.joints.emplace_back(stick);
}

// Joins the last body to the one before it, or to the world, and moves it such that the hinge has no gap.
void add_hinge(Scene& scene, Vec2d anchor_a, Vec2d anchor_b) {
  Body& b = scene.bodies.back();
  const auto turned = [](const Body& body, Vec2d local) {
    return Rotation<double>{std::cos(body.angle), std::sin(body.angle)} * local;
  };
  RevoluteJoint hinge;
  hinge.name = "hinge of " + b.name;
  hinge.body_b = b.name;
  hinge.anchor_a = anchor_a;
  hinge.anchor_b = anchor_b;
  if (scene.bodies.size() == 1) {
    hinge.body_a = kWorld;
    b.position = anchor_a - turned(b, anchor_b);
  } else {
    const Body& a = scene.bodies[scene.bodies.size() - 2];
    hinge.body_a = a.name;
    b.position = a.position + turned(a, anchor_a) - turned(b, anchor_b);
  }
  scene.joints.emplace_back(hinge);
}

// Three balls of unequal masses on two sticks, in the air.
Experiment two_sticks() {
  Scene scene = scene_of(
      "two sticks", {0, -kGravity},
      {make(Ball{.name = "a", .position = {0, 1}, .velocity = {0, 1}, .mass = 1, .radius = 0.1}),
       make(Ball{.name = "b", .position = {0.8, 1}, .mass = 3, .radius = 0.1}),
       make(Ball{.name = "c", .position = {0.8, 2.1}, .velocity = {1.5, 0}, .mass = 2, .radius = 0.1})});
  add_stick(scene, "a", "b", 0.8);
  add_stick(scene, "b", "c", 1.1);
  return {std::move(scene), 0.6};
}

// Two rods on a hinge that is off their axes; the first is on another hinge of the world, or in the air.
Experiment two_rods(bool hangs) {
  Scene scene = scene_of("two rods", {0, -kGravity},
                         {make(Crate{.name = "a",
                                     .position = {0.2, 1},
                                     .angle = 0.3,
                                     .angular_velocity = 1,
                                     .mass = 2,
                                     .width = 1,
                                     .height = 0.2})});
  if (hangs) add_hinge(scene, {0.5, 1.2}, {-0.4, 0.05});
  scene.bodies.push_back(make(
      Crate{.name = "b", .angle = -0.8, .angular_velocity = -2, .mass = 1, .width = 0.7, .height = 0.15}));
  add_hinge(scene, {0.4, -0.05}, {-0.3, 0.04});
  return {std::move(scene), 0.6};
}

}  // namespace

std::vector<Experiment> experiments(int chapter) {
  if (chapter == kForces)
    return {free_ball(), falling_spring({-1, 2}, {0.6, 2.9}), falling_spring({1, 2.9}, {-0.6, 2}),
            ball_with_drag()};
  if (chapter < kCollisions) return {free_ball(), soft_landing(), leaving_ball(), landing_ball()};
  if (chapter == kCollisions) return {free_ball(), three_discs(0), slow_meeting()};
  if (chapter == kBoxes)
    return {pushed_box(),        twisted_box(),       three_discs(0), three_discs(0.8),      spinning_disc(),
            landing_box(0, 0.4), landing_box(0.5, 0), two_boxes(0),   landing_box(0.5, 0.3), two_boxes(0.6)};
  return {pushed_box(), twisted_box(), two_sticks(), two_rods(false), two_rods(true), two_boxes(0)};
}

}  // namespace plumb::course
