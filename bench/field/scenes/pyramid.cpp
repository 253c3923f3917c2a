#include "bench/field/scenes/pyramid.h"

namespace plumb::field {

Top add_pyramid(Builder& world, int base, double half, double left, double ground) {
  const ShapeDefinition square{.geometry = box(half, half)};
  int last = 0;
  for (int row = 0; row < base; ++row) {
    for (int column = 0; column < base - row; ++column) {
      const Vec2d position{left + (row + 1 + 2 * column) * half, ground + (2 * row + 1) * half};
      last = world.create_body({.position = position}, square);
    }
  }
  return {last, ground};
}

Built pyramid_on_ground(Builder& world, int base) {
  const ShapeDefinition ground{.geometry = box(100, 1)};
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, ground);
  const double half = 0.5;
  return {.tops = {add_pyramid(world, base, half, -half * base, 0)}};
}

}  // namespace plumb::field
