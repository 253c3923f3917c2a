// 100 squares of 1 m in the base, 5050 in all, on a static box. 5051 bodies; 14950 pairs of neighbours: 100
// on the ground, 2 below each of the other 4950, 4950 side by side.
#include "bench/field/scenes/pyramid.h"
#include "bench/field/scenes/scenes.h"

namespace plumb::field {

Scene large_pyramid() {
  return {.name = "large_pyramid",
          .summary = "one pyramid of 1 m squares, 100 in the base",
          .steps = 500,
          .quick_steps = 60,
          .build = [](Builder& world, bool quick) { return pyramid_on_ground(world, quick ? 20 : 100); }};
}

}  // namespace plumb::field
