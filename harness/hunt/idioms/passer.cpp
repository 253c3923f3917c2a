#include <algorithm>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a body that flies past the corner, or end, of a static one without touching it.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, side = random.within(0.2, 1) * s, gap = random.ladder(0.05, 0.3) * s;
  const double speed = random.ladder(1, 50) * s;
  const double post = random.within(0.5, 2) * s;
  if (random.chance(0.5)) {
    draft.box({0, -post / 2}, post, post, 0, BodyType::Static);
  } else {
    draft.disc({0, -post / 2}, post / 2, BodyType::Static);
  }
  const double reach = 0.75 * side;
  const int made = draft.any({-random.within(2, 4) * s, reach + gap}, side, 0);
  draft.body(made).velocity = {speed, 0};
  draft.body(made).gravity_scale = 0;
  draft.out.steps = std::max(5, static_cast<int>(6 * s / speed / draft.out.dt));
  Expectation& passes = draft.expect("passes_by", made, Quantity::VelocityY);
  passes.lower = -0.001 * speed, passes.upper = 0.001 * speed;
  passes.why = "a body that touches nothing keeps its velocity";
}

const Register r{{.name = "passer",
                  .title = "a body that flies past another",
                  .weight = 0.7,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
