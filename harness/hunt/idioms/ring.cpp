#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds links in a closed loop of hinges, welds or rods, at rest or turning: a necklace, a tyre, a track.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, radius = random.within(1, 2) * s;
  const int links = random.whole(3, 12), first = draft.count(), kind = random.whole(0, 3);
  const bool air = draft.site.kind == Site::Kind::Air;
  const Vec2d middle{0, air ? 0 : 1.3 * radius};
  const double step = 6.283185307179586 / links;
  const Vec2d side = direction(step) - direction(0);
  const double length = radius * std::sqrt(dot(side, side));
  for (int i = 0; i < links; ++i) {
    const Vec2d at = middle + 0.5 * radius * (direction(i * step) + direction((i + 1) * step));
    draft.box(at, length, random.pick({0.1, 0.2}) * length, (i + 0.5) * step + 1.5707963267948966);
  }
  for (int i = 0; i < links; ++i) {
    const int a = first + i, b = first + (i + 1) % links;
    const Vec2d at = middle + radius * direction((i + 1) * step);
    if (kind == 0) {
      draft.weld(a, b, at).reference_angle = i + 1 < links ? step : step - 6.283185307179586;
    } else if (kind == 1) {
      RevoluteJoint& hinge = draft.revolute(a, b, at);
      hinge.reference_angle = i + 1 < links ? step : step - 6.283185307179586;
      hinge.limits = Range{-0.3, 0.3};
    } else {
      draft.revolute(a, b, at);
    }
  }
  draft.pass_each_other(first);
  if (air) draft.whirl(first, middle, random.within(-6, 6));
}

const Register r{{.name = "ring", .title = "links in a closed loop", .weight = 1, .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
