// 100 x 100 squares of 1 m at a pitch of 3 m fall from rest side by side and never touch.
#include "bench/field/scenes/scenes.h"

namespace plumb::field {

Scene free_10000() {
  return {.name = "free_10000",
          .summary = "10000 squares fall freely and do not touch",
          .steps = 100,
          .quick_steps = 30,
          .warm_up = 10,
          .build = [](Builder& world, bool quick) {
            const int n = quick ? 20 : 100;
            const ShapeDefinition square{.geometry = box(0.5, 0.5)};
            for (int column = 0; column < n; ++column)
              for (int row = 0; row < n; ++row)
                world.create_body({.position = {3.0 * column, 3.0 * row}}, square);
            return Built{};
          }};
}

}  // namespace plumb::field
