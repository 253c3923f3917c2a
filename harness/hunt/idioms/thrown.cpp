#include <algorithm>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds sticks, needles and other shapes that fly about in a closed box.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, inside = draft.site.width;
  const int count = random.whole(1, 6), first = draft.count();
  const double speed = random.ladder(1, 200) * s, spin = random.chance(0.5) ? 0 : random.ladder(1, 100);
  const bool sticks = random.chance(0.5);
  for (int i = 0; i < count; ++i) {
    const double size = random.within(0.2, 1) * s, angle = random.within(-3, 3);
    const Vec2d at{random.within(-0.4, 0.4) * (inside - 2 * size),
                   inside / 2 + random.within(-0.4, 0.4) * (inside - 2 * size)};
    const int made =
        sticks ? draft.box(at, size, size * random.ladder(0.02, 0.2), angle) : draft.any(at, size, angle);
    draft.body(made).velocity = speed * direction(random.within(-3, 3));
    draft.body(made).angular_velocity = random.within(-spin, spin);
  }
  if (random.chance(0.6) || count > 1) draft.pass_each_other(first);
  // Shapes may overlap by 2 g dt^2 (`penetration`), so the centres of thin ones may lie inside a wall, up to
  // its middle. Uses at least the g and dt to which cases are shrunk.
  const double g = std::max(10.0, length(draft.out.scene.gravity)), dt = std::max(1.0 / 60, draft.out.dt);
  const double into = std::min(draft.site.wall / 2, 2 * g * dt * dt);
  for (int i = first; i < draft.count(); ++i) {
    for (const Quantity quantity : {Quantity::X, Quantity::Y}) {
      Expectation& stays = draft.expect("stays_inside", i, quantity);
      stays.lower = (quantity == Quantity::X ? -inside / 2 : 0) - into;
      stays.upper = stays.lower + inside + 2 * into;
      stays.why = "nothing leaves a closed box";
      for (int wall = 0; wall < first; ++wall) stays.needs.push_back(draft.name(wall));
      stays.needs.push_back(draft.name(i));
    }
  }
}

const Register r{{.name = "thrown",
                  .title = "sticks and other bodies thrown in a closed box",
                  .weight = 1.5,
                  .air = false,
                  .floor = false,
                  .enclosure = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
