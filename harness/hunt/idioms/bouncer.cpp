#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds bodies that fall rotated and spinning, and bounce.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  const int count = random.pick({1, 1, 1, 2, 4});
  draft.restitution = random.pick({0.5, 0.8, 1.0, 1.0});
  if (random.chance(0.5)) draft.friction = 0;
  for (int i = 0; i < count; ++i) {
    const double height = random.within(1, 3) * s, about = random.pick({0.5, 1.0, 1.5}) * s;
    const double angle = random.within(-3, 3);
    const int made = draft.any({(3.0 * i - 1.5 * (count - 1)) * s, height}, about, angle);
    draft.body(made).velocity = {random.within(-3, 3) * s, -random.ladder(0.1, 20) * s};
    draft.body(made).angular_velocity = random.within(-8, 8);
  }
}

const Register r{{.name = "bouncer",
                  .title = "rotated bodies that fall and bounce",
                  .weight = 1.5,
                  .air = false,
                  .enclosure = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
