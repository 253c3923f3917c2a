#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a triangle of balls that touch, or nearly, and one that breaks it, seen from above or falling.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, radius = random.within(0.1, 0.3) * s,
               gap = random.pick({0.0, 0.0, 0.01, 0.1}) * radius;
  const int rows = random.whole(2, 4), first = draft.count();
  const double along = 1.7320508 * (radius + gap / 2), across = 2 * radius + gap;
  const double middle = draft.site.kind == Site::Kind::Enclosure ? draft.site.height / 2 : 0;
  if (random.chance(0.6)) draft.out.scene.gravity = {0, 0};
  draft.restitution = random.pick({0.5, 0.9, 1.0});
  if (random.chance(0.5)) draft.friction = 0;
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i <= row; ++i) draft.disc({row * along, middle + (i - 0.5 * row) * across}, radius);
  const int cue = draft.disc({-random.within(3, 6) * radius, middle + random.within(-1, 1) * radius}, radius);
  draft.body(cue).velocity = {random.ladder(1, 50) * s, 0};
  draft.body(first).angular_velocity = random.pick({0.0, 5.0});
}

const Register r{{.name = "billiards",
                  .title = "a triangle of balls that another ball breaks",
                  .weight = 0.7,
                  .floor = false,
                  .enclosure = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
