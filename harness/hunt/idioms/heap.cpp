#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds bodies of all kinds, including needles, that fall on the ground and come to rest there.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  const int count = random.pick({1, 1, 2, 3, 6, 12});
  if (random.chance(0.7)) draft.restitution = 0;
  draft.out.steps = static_cast<int>(random.within(3, 6) / draft.out.dt);
  for (int i = 0; i < count; ++i) {
    const double size = random.ladder(0.3, 1.6) * s, angle = random.within(-3, 3);
    const Vec2d at{random.within(-2, 2) * s, (1 + 1.2 * i) * s};
    if (random.chance(0.3)) {
      // Nearly collinear corners.
      Polygon needle;
      const double thin = random.ladder(1e-4, 1e-1) * size;
      const int corners = random.whole(3, 5);
      for (int k = 0; k < corners; ++k)
        needle.points.push_back(
            {size * (static_cast<double>(k) / (corners - 1) - 0.5), k % 2 == 0 ? -thin : thin});
      draft.add(needle, at, angle);
    } else {
      draft.any(at, size, angle);
    }
  }
}

const Register r{{.name = "heap",
                  .title = "bodies that fall and come to rest",
                  .weight = 1.5,
                  .air = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
