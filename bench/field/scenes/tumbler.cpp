// A hollow square, 20 m wide inside and 1 m thick, driven at 25 degrees a second by a motor. Inside are 45 x
// 45 squares of 0.25 m at a pitch of 0.4 m. 2027 bodies, 1 joint.
#include <numbers>

#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

Built build(Builder& world, bool quick) {
  const Vec2d centre{0, 10};
  const int ground = world.create_body({.type = BodyType::Static}, std::vector<ShapeDefinition>{});
  const double density = 50;
  const std::vector<ShapeDefinition> walls{{.geometry = box(0.5, 10, {10, 0}), .density = density},
                                           {.geometry = box(0.5, 10, {-10, 0}), .density = density},
                                           {.geometry = box(10, 0.5, {0, 10}), .density = density},
                                           {.geometry = box(10, 0.5, {0, -10}), .density = density}};
  const int drum = world.create_body({.position = centre}, walls);
  world.create_revolute(
      ground, drum,
      {.anchor_a = centre, .motor = Motor{.speed = 25 * std::numbers::pi / 180, .max_torque = 1e8}});

  const int n = quick ? 12 : 45;
  const double pitch = 0.4;
  const ShapeDefinition square{.geometry = box(0.125, 0.125)};
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
      world.create_body({.position = {pitch * (column - n / 2.0), centre.y + pitch * (row - n / 2.0)}},
                        square);
  // The drum's corners reach 14.85 m from its centre.
  return {.region = Region{{-15, -5}, {15, 25}}};
}

}  // namespace

Scene tumbler() {
  return {.name = "tumbler",
          .summary = "2025 small squares in a square drum that a motor turns",
          .steps = 750,
          .quick_steps = 60,
          .build = build};
}

}  // namespace plumb::field
