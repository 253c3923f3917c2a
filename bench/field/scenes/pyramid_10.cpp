// 55 squares of 1 m on a static box: 56 bodies, 145 pairs of neighbours.
#include "bench/field/scenes/pyramid.h"
#include "bench/field/scenes/scenes.h"

namespace plumb::field {

Scene pyramid_10() {
  return {.name = "pyramid_10",
          .summary = "one pyramid of 1 m squares, 10 in the base",
          .steps = 2000,
          .quick_steps = 200,
          .warm_up = 100,
          .build = [](Builder& world, bool) { return pyramid_on_ground(world, 10); }};
}

}  // namespace plumb::field
