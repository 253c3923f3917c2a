// An empty world: the overhead of a step.
#include "bench/field/scenes/scenes.h"

namespace plumb::field {

Scene empty() {
  return {.name = "empty",
          .summary = "an empty world",
          .steps = 100000,
          .quick_steps = 1000,
          .warm_up = 1000,
          .build = [](Builder&, bool) { return Built{}; }};
}

}  // namespace plumb::field
