// Ten links of 1 x 0.2 m hang from a static body and swing. At the start they form a horizontal line. Links
// do not collide. 11 bodies, 10 joints.
#include "bench/field/scenes/scenes.h"

namespace plumb::field {

Scene chain_10() {
  return {.name = "chain_10",
          .summary = "a chain of 10 links swings down from level",
          .steps = 2000,
          .quick_steps = 200,
          .warm_up = 10,
          .build = [](Builder& world, bool) {
            int last = world.create_body({.type = BodyType::Static}, std::vector<ShapeDefinition>{});
            const ShapeDefinition link{.geometry = box(0.5, 0.1), .group = 1};
            for (int i = 0; i < 10; ++i) {
              const int body = world.create_body({.position = {i + 0.5, 0}}, link);
              world.create_revolute(last, body, {.anchor_a = {i == 0 ? 0 : 0.5, 0}, .anchor_b = {-0.5, 0}});
              last = body;
            }
            return Built{};
          }};
}

}  // namespace plumb::field
