// A 1 m square falls from rest, for 50 s.
#include "bench/field/scenes/scenes.h"

namespace plumb::field {

Scene one_free_body() {
  return {.name = "one_free_body",
          .summary = "a square falls freely",
          .steps = 3000,
          .quick_steps = 600,
          .warm_up = 10,
          .build = [](Builder& world, bool) {
            world.create_body({}, ShapeDefinition{.geometry = box(0.5, 0.5)});
            return Built{};
          }};
}

}  // namespace plumb::field
