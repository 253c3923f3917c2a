#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/world/passages.h"

// Rooms whose wall is one closed chain with bends to both sides. Nothing leaves them, at any speed.
namespace plumb {
namespace {

using passages::Draw;

using Wall = std::vector<Vec2d>;

// Returns true if a point is inside of a polygon: a ray from it crosses an odd number of edges.
bool contains(const Wall& wall, Vec2d point) {
  bool inside = false;
  for (std::size_t i = 0, j = wall.size() - 1; i < wall.size(); j = i++) {
    const Vec2d a = wall[i], b = wall[j];
    if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x)
      inside = !inside;
  }
  return inside;
}

// Draws a wall of 3 to 40 vertices, 2 m from the middle but for a part `bend` of that, with its front
// inwards.
Wall draw_wall(Draw& draw, double bend) {
  Wall wall;
  const int count = 3 + draw.choose(38);
  for (int i = 0; i < count; ++i) {
    const double angle = -2 * std::numbers::pi * i / count, radius = 2 * (1 + bend * draw.even(-1, 1));
    wall.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return wall;
}

ShapeDefinition draw_shape(Draw& draw, double size) {
  ShapeDefinition shape;
  switch (draw.choose(3)) {
    case 0:
      shape.geometry = Box{size, size * draw.even(0.1, 1)};
      break;
    case 1:
      shape.geometry = Capsule{{0, -size / 3}, {0, size / 3}, size * draw.even(0.03, 0.3)};
      break;
    default:
      shape.geometry = Polygon{{{-size / 2, -size / 3}, {size / 2, -size / 3}, {0, size / 2}}};
      break;
  }
  shape.filter.group = -1;
  return shape;
}

// Throws bodies in a room, again and again, at 1 to 300 m/s. Returns true if none is outside afterwards.
template <class Real>
bool keeps_bodies(std::uint64_t seed, double bend) {
  Draw draw(seed);
  BasicWorld<Real> world({.gravity = {0, draw.choose(2) == 0 ? 0.0 : -9.81}});
  const Wall wall = draw_wall(draw, bend);
  const BodyId room = world.create_body({.type = BodyType::Static});
  world.create_chain(room, {.points = wall, .closed = true, .material = {.friction = draw.even(0, 1)}});
  const auto throw_at = [&](BodyId body, double fastest) {
    const double speed = draw.spread(1, fastest);
    world.set_velocity(body, speed * draw.direction());
  };
  std::vector<BodyId> bodies;
  for (int i = 2 + draw.choose(5); i > 0; --i) {
    const double size = draw.spread(0.05, 0.8);
    // The shape must fit in where it starts.
    if (2 * (1 - bend) * std::cos(std::numbers::pi / double(wall.size())) < 0.6 * size) continue;
    bodies.push_back(world.create_body({.angle = draw.even(0, 6)}, draw_shape(draw, size)));
    throw_at(bodies.back(), 300);
    world.set_angular_velocity(bodies.back(), draw.even(-40, 40));
  }
  for (int step = 0; step < 120; ++step) {
    world.step(1.0 / 60);
    for (const BodyId body : bodies) {
      if (!contains(wall, world.centre(body))) return false;
      if (draw.choose(30) == 0) throw_at(body, 200);
    }
  }
  return true;
}

// A body that is deeper over a convex bend than it is wide has its least overlap along the wall. Neither
// segment of the bend took it for its own, and it left.
TEST(RoomsOfChains, KeepWhatIsThrownAtTheirBends) {
  for (const double bend : {0.1, 0.3}) {
    for (std::uint64_t seed = 0; seed < 400; ++seed)
      EXPECT_TRUE(keeps_bodies<double>(seed, bend)) << "bend " << bend << ", seed " << seed;
  }
}

}  // namespace
}  // namespace plumb
