#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/world/support.h"

// In the corner of a room floor and wall overlap. The part of each side that lies in the other is no surface,
// and the rest of it is. Bodies thrown into the corner come to rest in front of both.
namespace plumb {
namespace {

template <class Real>
class CornersOfRooms : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(CornersOfRooms, Reals);

constexpr double kInside = 6;  // m, of the square room

template <class Real>
void add_walls(BasicWorld<Real>& world, double wall) {
  const double half = kInside / 2, length = kInside + 2 * wall;
  const auto add = [&](Vec2d at, double width, double height) {
    world.create_body({.type = BodyType::Static, .position = at}, {.geometry = Box{width, height}});
  };
  add({0, -wall / 2}, length, wall), add({0, kInside + wall / 2}, length, wall);
  add({-half - wall / 2, half}, wall, length), add({half + wall / 2, half}, wall, length);
}

// How deep a body's corners are in the walls, m.
template <class Real>
double depth_of(const BasicWorld<Real>& world, BodyId body, const std::vector<Vec2d>& points) {
  double deepest = 0;
  for (const Vec2d point : points) {
    const Vec2d at = world.world_point(body, point);
    deepest = std::max({deepest, -at.y, at.y - kInside, std::abs(at.x) - kInside / 2});
  }
  return deepest;
}

// Bound: a shape overlaps another by at most 2 % of its extent (the invariant monitor's bound) once it has
// had a second to come to rest; a depth by which a corner has sunk in grows as nothing holds it.
TYPED_TEST(CornersOfRooms, HoldWhatIsThrownIntoThem) {
  for (int draw = 0; draw < 3000; ++draw) {
    std::mt19937_64 engine(static_cast<std::uint64_t>(draw));
    const auto within = [&](double low, double high) {
      return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
    };
    BasicWorld<TypeParam> world({.sleeping = false});
    add_walls(world, std::exp(within(std::log(0.02), std::log(2.0))));
    const double size = within(0.1, 0.8), speed = within(0, 15), down = within(0.2, 1.4);
    const int corners = 3 + draw % 3;
    std::vector<Vec2d> points;
    for (int i = 0; i < corners; ++i) {
      const double at = 2 * M_PI / corners * (i + within(-0.2, 0.2));
      points.push_back({size * std::cos(at), size * std::sin(at)});
    }
    const double side = draw % 2 == 0 ? 1 : -1;
    const BodyId body = world.create_body(
        {.position = {side * 2.1, within(0.9, 2.5)},
         .angle = within(0, 2 * M_PI),
         .velocity = {side * speed * std::cos(down), -speed * std::sin(down)},
         .angular_velocity = within(-8, 8)},
        {.geometry = Polygon{points},
         .material = {.friction = within(0, 1), .restitution = draw % 4 == 0 ? within(0, 0.6) : 0}});
    for (int i = 0; i < 240; ++i) world.step(1.0 / 60);
    EXPECT_LT(depth_of(world, body, points), 0.02 * size) << "draw " << draw;
  }
}

}  // namespace
}  // namespace plumb
