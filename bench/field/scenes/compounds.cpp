// 20 columns of 150 bodies, each of two overlapping triangles, fall into a silo of 281 static boxes, 80 m
// wide and 100 m high. A segment below catches escaping bodies. 3001 bodies.
#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

std::vector<ShapeDefinition> silo() {
  std::vector<ShapeDefinition> out;
  for (int i = -40; i <= 40; ++i) out.push_back({.geometry = box(0.55, 0.5, {static_cast<double>(i), 0})});
  for (const double x : {-40.0, 40.0})
    for (int i = 1; i <= 100; ++i) out.push_back({.geometry = box(0.5, 0.55, {x, static_cast<double>(i)})});
  out.push_back({.geometry = Segment{{-800, -80}, {800, -80}}});
  return out;
}

Built build(Builder& world, bool quick) {
  world.create_body({.type = BodyType::Static}, silo());
  const std::vector<ShapeDefinition> pair{
      {.geometry = Polygon{{{-1, 0}, {0.5, 1}, {0, 2}}, 0}, .friction = 0.5},
      {.geometry = Polygon{{{1, 0}, {0, 2}, {-0.5, 1}}, 0}, .friction = 0.5}};
  const int columns = 20, rows = quick ? 8 : 150;
  double side = 0.25;
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      world.create_body({.position = {2.0 * column - 19 + side, 5.575 + 2.25 * row}}, pair);
      side = -side;
    }
  }
  return {.region = Region{{-41, -1}, {41, 400}}};
}

}  // namespace

Scene compounds() {
  return {.name = "compounds",
          .summary = "3000 bodies of two triangles each fall into a silo",
          .steps = 500,
          .quick_steps = 90,
          .build = build};
}

}  // namespace plumb::field
