// 1000 x 1000 squares of 1 m at a pitch of 3 m fall from rest side by side and never touch: a hundred times
// free_10000.
#include "bench/field/scenes/scenes.h"

namespace plumb::field {

Scene free_1000000() {
  return {.name = "free_1000000",
          .summary = "1000000 squares fall freely and do not touch",
          .steps = 20,
          .quick_steps = 10,
          .warm_up = 10,
          .on_request = true,
          .build = [](Builder& world, bool quick) {
            const int n = quick ? 30 : 1000;
            const ShapeDefinition square{.geometry = box(0.5, 0.5)};
            for (int column = 0; column < n; ++column)
              for (int row = 0; row < n; ++row)
                world.create_body({.position = {3.0 * column, 3.0 * row}}, square);
            return Built{};
          }};
}

}  // namespace plumb::field
