// 20 x 20 pyramids of 1 m squares, 10 in the base, 1 m apart, on 20 static segments one above the other.
// 22001 bodies, 58000 pairs of neighbours. Without continuous collision, because that alone costs Box2D 2.4
// more time than the rest.
#include "bench/field/scenes/pyramid.h"
#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

constexpr int kBase = 10;
constexpr double kHalf = 0.5;                       // m
constexpr double kPitch = 2 * kHalf * (kBase + 1);  // m, between pyramids and between storeys

Built build(Builder& world, bool quick) {
  const int rows = quick ? 3 : 20, columns = quick ? 3 : 20;
  const double left = -kPitch * columns / 2;
  std::vector<ShapeDefinition> storeys;
  for (int row = 0; row < rows; ++row)
    storeys.push_back({.geometry = Segment{{left, row * kPitch}, {-left, row * kPitch}}});
  world.create_body({.type = BodyType::Static}, storeys);
  Built out;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      out.tops.push_back(add_pyramid(world, kBase, kHalf, left + column * kPitch + kHalf, row * kPitch));
  return out;
}

}  // namespace

Scene many_pyramids() {
  return {.name = "many_pyramids",
          .summary = "400 pyramids of 1 m squares, 10 in the base",
          .steps = 200,
          .quick_steps = 60,
          .continuous = false,
          .build = build};
}

}  // namespace plumb::field
