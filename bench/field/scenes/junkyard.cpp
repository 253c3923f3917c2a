// 8000 pentagons of radius 0.25 m fall into a yard of 261 static boxes, 160 m wide and 50 m high. A kinematic
// pusher of 4 x 8 m moves to and fro: x = 60 sin(0.2 t) m. 8002 bodies.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

constexpr double kDt = 1.0 / 60;  // s

std::vector<ShapeDefinition> yard() {
  std::vector<ShapeDefinition> out;
  for (int i = -80; i <= 80; ++i) out.push_back({.geometry = box(0.55, 0.5, {static_cast<double>(i), 0})});
  for (const double x : {-80.0, 80.0})
    for (int i = 1; i <= 50; ++i) out.push_back({.geometry = box(0.5, 0.55, {x, static_cast<double>(i)})});
  return out;
}

/// Returns five points of a circle, a golden angle apart.
Polygon pentagon(double radius) {
  std::vector<double> angles;
  for (int i = 0; i < 5; ++i)
    angles.push_back(std::fmod(i * std::numbers::pi * (std::sqrt(5.0) - 1), 2 * std::numbers::pi));
  std::ranges::sort(angles);
  Polygon out;
  for (const double angle : angles) out.points.push_back(radius * Vec2d{std::cos(angle), std::sin(angle)});
  return out;
}

double pusher_at(int step) { return 60 * std::sin(0.2 * kDt * step); }

Built build(Builder& world, bool quick) {
  world.create_body({.type = BodyType::Static}, yard());
  const double radius = 0.25;
  const ShapeDefinition junk{.geometry = pentagon(radius)};
  const int columns = 200, rows = quick ? 2 : 40;
  double side = -0.1;
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const Vec2d position{1.5 * (2 * column - columns) * radius + side, 15 + 4 * row * radius};
      world.create_body({.position = position}, junk);
      side = -side;
    }
  }
  const ShapeDefinition blade{.geometry = box(2, 4, {0, 4})};
  const int pusher = world.create_body({.type = BodyType::Kinematic}, blade);
  return {.before_step =
              [pusher](Builder& in, int step) {
                const double from = step == 0 ? 0 : pusher_at(step - 1);
                in.set_velocity(pusher, {(pusher_at(step) - from) / kDt, 0}, 0);
              },
          .tops = {},
          .region = Region{{-81, -1}, {81, 100}}};
}

}  // namespace

Scene junkyard() {
  return {.name = "junkyard",
          .summary = "8000 pentagons in a yard, pushed to and fro",
          .steps = 800,
          .quick_steps = 90,
          .build = build};
}

}  // namespace plumb::field
