// Without gravity an 8 m square of density 8 kg/m^2 flies at 40 m/s into 120 x 80 squares of 0.4 m that stand
// edge to edge. All are awake from the start. 9601 bodies.
#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

Built build(Builder& world, bool quick) {
  const ShapeDefinition heavy{.geometry = box(4, 4), .density = 8};
  world.create_body({.position = {-20, 0}, .velocity = {40, 0}}, heavy);
  const int columns = quick ? 20 : 120, rows = quick ? 10 : 80;
  const double side = 0.4;
  const ShapeDefinition square{.geometry = box(side / 2, side / 2)};
  for (int column = 0; column < columns; ++column)
    for (int row = 0; row < rows; ++row)
      world.create_body({.position = {30 + side * column, side * (row - rows / 2.0)}}, square);
  return {};
}

}  // namespace

Scene smash() {
  return {.name = "smash",
          .summary = "a heavy square flies into a block of 9600 squares",
          .steps = 300,
          .quick_steps = 90,
          .gravity = {0, 0},
          .build = build};
}

}  // namespace plumb::field
