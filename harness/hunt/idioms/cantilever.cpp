#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds boards in a row, each held by the one before: a diving board, a shelf, a rope of welds or hinges.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, length = random.pick({0.5, 1.0, 2.0}) * s;
  const int count = random.whole(1, 8), first = draft.count();
  const int kind = random.whole(0, 4);
  const double height = draft.site.kind == Site::Kind::Floor ? count * length * 1.2 : 0;
  const Spring spring{random.ladder(0.1, 500), random.pick({0.0, 0.3, 0.7, 1.0, 2.0})};
  int before = -1;
  for (int i = 0; i < count; ++i) {
    const int made = draft.box({(i + 0.5) * length, height}, length, random.pick({0.05, 0.2, 0.5}) * length);
    const Vec2d root{i * length, height};
    if (kind == 0) {
      draft.weld(before, made, root);
    } else if (kind <= 2) {
      WeldJoint& joint = draft.weld(before, made, root);
      joint.angular_spring = spring;
      if (kind == 2) joint.linear_spring = spring;
    } else if (kind == 3) {
      RevoluteJoint& joint = draft.revolute(before, made, root);
      joint.spring = spring;
      if (random.chance(0.3)) joint.limits = Range{-1, 1};
    } else {
      draft.revolute(before, made, root);
    }
    before = made;
  }
  draft.pass_each_other(first);
}

const Register r{
    {.name = "cantilever", .title = "boards in a row, joined to each other", .weight = 1.5, .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
