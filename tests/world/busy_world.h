#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/world/world.h"

/// A world with some of everything, for tests that save, repeat and draw.
namespace plumb::test {

/// Numbers in [0, 1) that are the same everywhere.
class Random {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  double next(double lower, double upper) { return lower + (upper - lower) * next(); }
  int below(int count) { return static_cast<int>(next() * count); }

 private:
  std::uint64_t state_ = 2463534242u;
};

struct Handles {
  BodyId ground{}, platform{}, anchor{};
  ShapeId sensor{};
  ChainId chain{};
  std::vector<BodyId> pile, links;
  std::vector<JointId> joints;
};

template <class Real>
struct BusyWorld : Handles {
  BasicWorld<Real> world;
  Handles& handles() { return *this; }
};

/// Shape `i` of five kinds, about half a metre in size.
inline ShapeDefinition shape_of(int i) {
  ShapeDefinition shape{.material = {.friction = 0.5, .restitution = 0.1}};
  switch (i % 5) {
    case 0:
      shape.geometry = Circle{0.25};
      shape.material.rolling_resistance = 0.02;
      break;
    case 1:
      shape.geometry = Box{0.6, 0.4};
      break;
    case 2:
      shape.geometry = Capsule{{-0.25, 0}, {0.25, 0}, 0.15};
      break;
    case 3:
      shape.geometry = Polygon{{{-0.3, -0.2}, {0.3, -0.2}, {0.2, 0.2}, {-0.1, 0.3}}, 0.02};
      break;
    default:
      shape.geometry = Polygon{{{-0.25, -0.25}, {0.3, -0.2}, {0, 0.3}}};
      shape.hit_events = true;
  }
  return shape;
}

/// A trough of a chain, a platform that slides to and fro, a sensor, a pile of `size` bodies (more than 12)
/// of all kinds of shapes that fall into it, a hanging chain of revolute joints and one joint each of several
/// other kinds.
template <class Real>
BusyWorld<Real> make_busy_world(int size = 40) {
  BusyWorld<Real> busy;
  BasicWorld<Real>& world = busy.world;
  busy.ground = world.create_body({.name = "ground", .type = BodyType::Static});
  // Its front looks up: to the right of the way from point to point.
  busy.chain = world.create_chain(
      busy.ground, {.points = {{8, 6}, {8, 0}, {4, -0.5}, {0, 0}, {-4, -0.5}, {-8, 0}, {-8, 6}},
                    .material = {.friction = 0.7}});
  world.create_shape(busy.ground, {.geometry = Segment{{-12, -2}, {12, -2}}});
  busy.sensor = world.create_shape(busy.ground, {.geometry = Box{4, 1}, .position = {0, 1}, .sensor = true});
  busy.platform = world.create_body(
      {.name = "platform", .type = BodyType::Kinematic, .position = {0, 2}, .velocity = {0.5, 0}},
      {.geometry = Box{2, 0.2}});
  Random random;
  for (int i = 0; i < size; ++i) {
    const BodyDefinition body{.name = "body " + std::to_string(i),
                              .position = {random.next(-5, 5), 3 + 0.25 * i},
                              .angle = random.next(-3, 3),
                              .velocity = {random.next(-2, 2), 0},
                              .angular_velocity = random.next(-4, 4),
                              .user_data = static_cast<std::uint64_t>(i)};
    busy.pile.push_back(world.create_body(body, shape_of(i)));
  }
  busy.anchor = world.create_body({.type = BodyType::Static, .position = {-3, 9}});
  BodyId previous = busy.anchor;
  for (int i = 0; i < 6; ++i) {
    const BodyId link = world.create_body({.position = {-2.7 + 0.6 * i, 9}}, {.geometry = Box{0.5, 0.2}});
    busy.links.push_back(link);
    const double left = i == 0 ? 0 : 0.3;
    busy.joints.push_back(world.create_joint(
        previous, link, {.kind = RevoluteDefinition{.anchor_a = {left, 0}, .anchor_b = {-0.3, 0}}}));
    previous = link;
  }
  const auto join = [&](int a, int b, const JointKind& kind, double break_force = 0) {
    busy.joints.push_back(
        world.create_joint(busy.pile[a], busy.pile[b], {.kind = kind, .break_force = break_force}));
  };
  join(0, 1, DistanceDefinition{.length = 2, .range = Range{0.5, 2}});
  join(2, 3, DistanceDefinition{.length = 1, .spring = Spring{3, 0.3}});
  join(4, 5, RevoluteDefinition{.anchor_a = {0.4, 0}, .anchor_b = {-0.4, 0}, .limits = Range{-1, 1}}, 400);
  join(6, 7, PrismaticDefinition{.limits = Range{-1, 1}, .motor = Motor{1, 50}});
  join(8, 9, WeldDefinition{.anchor_a = {0.3, 0}, .anchor_b = {-0.3, 0}, .angular_spring = Spring{4, 0.5}});
  join(10, 11, WheelDefinition{.anchor_a = {0.3, 0}, .spring = Spring{4, 0.7}, .motor = Motor{5, 20}});
  return busy;
}

/// Does what a game does between two steps: turns the platform round, pushes, lets bodies come and go. The
/// same for the same step and world.
template <class Real>
void act(BusyWorld<Real>& busy, std::int64_t step) {
  BasicWorld<Real>& world = busy.world;
  if (step % 120 == 60) world.set_velocity(busy.platform, {-0.5, 0});
  if (step % 120 == 0 && step > 0) world.set_velocity(busy.platform, {0.5, 0});
  const std::size_t count = busy.pile.size();
  const BodyId pushed = busy.pile[static_cast<std::size_t>(step * 7) % count];
  if (step % 5 == 0 && world.valid(pushed)) {
    world.apply_impulse(pushed, {0.1, 0.3});
    world.apply_torque(pushed, 0.5);
  }
  if (step % 37 == 36) {
    BodyId& gone = busy.pile[12 + static_cast<std::size_t>(step) % (count - 12)];
    const Vec2d above{static_cast<double>(step % 7) - 3, 8};
    world.destroy(gone);
    gone = world.create_body({.name = "new", .position = above}, shape_of(static_cast<int>(step)));
  }
  if (step == 100) world.destroy(busy.joints[3]);
}

template <class Real>
void run(BusyWorld<Real>& busy, int steps) {
  for (int i = 0; i < steps; ++i) {
    act(busy, busy.world.step_count());
    busy.world.step();
  }
}

}  // namespace plumb::test
