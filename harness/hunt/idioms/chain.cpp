#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds links in a row that hang from a point, lie between two, or fly.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, length = random.pick({0.3, 0.5, 1.0}) * s, ratio = random.ladder(0.01, 100);
  const int links = random.whole(2, 12), first = draft.count();
  const bool air = draft.site.kind == Site::Kind::Air, held = air && random.chance(0.7),
             both = held && random.chance(0.3);
  const double height = air ? 0 : random.within(1, 3) * s, dense = draft.density;
  const bool rods = random.chance(0.25), discs = random.chance(0.4);
  int before = -1;
  for (int i = 0; i < links; ++i) {
    draft.density = i == links - 1 ? dense * ratio : dense;
    const Vec2d at{(i + 0.5) * length, height};
    const int made =
        discs ? draft.disc(at, random.within(0.1, 0.4) * length) : draft.box(at, length, 0.2 * length);
    if (i > 0 || held) {
      const Vec2d pin{i * length, height};
      if (rods && i > 0) {
        draft.rod(before, made, at - Vec2d{length, 0}, at);
      } else {
        draft.revolute(before, made, pin);
      }
    }
    before = made;
  }
  draft.density = dense;
  if (both) draft.revolute(before, -1, {links * length, height});
  if (random.chance(0.7)) draft.pass_each_other(first);
  if (!held) {
    const Vec2d speed{random.within(-8, 8) * s, air ? random.within(-8, 8) * s : -random.within(0, 10) * s};
    for (int i = first; i < draft.count(); ++i) draft.body(i).velocity = speed;
  }
}

const Register r{{.name = "chain",
                  .title = "a chain of links, hanging or thrown",
                  .weight = 1.2,
                  .enclosure = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
