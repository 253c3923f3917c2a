#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds two bodies, or one and the fixed frame, with a joint between them of any kind that constrains an
// angle.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  const double height = draft.site.kind == Site::Kind::Air ? 0 : 4 * s;
  const int first = draft.count();
  const int a = random.chance(0.5) ? -1 : draft.box({0, height}, s, s);
  const double length = random.within(1, 3) * s, thickness = random.within(0.1, 0.5) * s;
  const double angle = random.chance(0.5) ? 0 : random.within(-3, 3);
  const int b = draft.box({1.5 * s, height}, length, thickness, angle);
  const Spring spring{random.ladder(0.1, 100), random.pick({0.0, 0.5, 0.7, 1.0})};
  const Vec2d at{random.chance(0.5) ? 0.5 * s : 1.5 * s, height};
  switch (random.whole(0, 7)) {
    case 0:
      draft.revolute(a, b, at).limits = Range{-random.within(0, 1), random.within(0, 1)};
      break;
    case 1:
      draft.revolute(a, b, at).spring = spring;
      break;
    case 2:
      draft.weld(a, b, at);
      break;
    case 3:
      draft.weld(a, b, at).angular_spring = spring;
      break;
    case 4:
      draft.prismatic(a, b, at, direction(random.within(-3, 3))).limits = Range{-s, s};
      break;
    case 5: {
      PrismaticJoint& slide = draft.prismatic(a, b, at, direction(random.within(-3, 3)));
      slide.spring = spring;
      break;
    }
    case 6: {
      RevoluteJoint& hinge = draft.revolute(a, b, at);
      hinge.limits = Range{-0.5, 0.5};
      hinge.motor = Motor{random.within(-3, 3), draft.density * s * s * s * random.ladder(0.1, 100)};
      break;
    }
    default: {
      WheelJoint& wheel = draft.wheel(a, b, at, {0, 1});
      wheel.spring = spring;
      wheel.limits = Range{-0.5 * s, 0.5 * s};
    }
  }
  draft.pass_each_other(first);
}

const Register r{
    {.name = "door", .title = "two bodies and a joint that holds an angle", .weight = 1.2, .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
