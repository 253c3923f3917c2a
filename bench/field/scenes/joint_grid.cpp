// A curtain of 100 x 100 discs of radius 0.4 m at a pitch of 1 m, each joined to its neighbours by revolute
// joints half-way; 7 in the middle of the top row are static. Nothing collides. 10000 bodies, 19800 joints.
#include <vector>

#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

Built build(Builder& world, bool quick) {
  const int n = quick ? 20 : 100;
  const ShapeDefinition disc{.geometry = Circle{{}, 0.4}, .category = 2, .mask = 0xFFFD};
  std::vector<int> bodies;
  for (int column = 0; column < n; ++column) {
    for (int row = 0; row < n; ++row) {
      const bool held = row == 0 && column >= n / 2 - 3 && column <= n / 2 + 3;
      const int body =
          world.create_body({.type = held ? BodyType::Static : BodyType::Dynamic,
                             .position = {static_cast<double>(column), -static_cast<double>(row)}},
                            disc);
      if (row > 0) world.create_revolute(bodies.back(), body, {.anchor_a = {0, -0.5}, .anchor_b = {0, 0.5}});
      if (column > 0)
        world.create_revolute(bodies[bodies.size() - n], body, {.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}});
      bodies.push_back(body);
    }
  }
  return {};
}

}  // namespace

Scene joint_grid() {
  return {.name = "joint_grid",
          .summary = "a curtain of 100 x 100 discs, joined to their neighbours",
          .steps = 500,
          .quick_steps = 60,
          .build = build};
}

}  // namespace plumb::field
