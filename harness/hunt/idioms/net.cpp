#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds discs in a grid, each joined to its neighbours: cloth, jelly.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, step = random.pick({0.4, 0.6}) * s;
  const int columns = random.whole(2, 4), rows = random.whole(2, 4), first = draft.count(),
            kind = random.whole(0, 3);
  const double height = draft.site.kind == Site::Kind::Air ? 0 : random.within(0.5, 2) * s;
  const Spring spring{random.ladder(1, 60), random.pick({0.0, 0.5, 1.0})};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      draft.disc({column * step, height + (row + 0.5) * step}, 0.3 * step);
  const auto tie = [&](int a, int b) {
    const Vec2d at = draft.body(a).position, to = draft.body(b).position;
    if (kind == 0) {
      draft.rod(a, b, at, to);
    } else if (kind == 1) {
      draft.rod(a, b, at, to).spring = spring;
    } else if (kind == 2) {
      draft.weld(a, b, 0.5 * (at + to));
    } else {
      WeldJoint& joint = draft.weld(a, b, 0.5 * (at + to));
      joint.angular_spring = spring, joint.linear_spring = spring;
    }
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int at = first + row * columns + column;
      if (column + 1 < columns) tie(at, at + 1);
      if (row + 1 < rows) tie(at, at + columns);
    }
  draft.pass_each_other(first);
}

const Register r{{.name = "net",
                  .title = "discs in a grid, joined to each other",
                  .weight = 1,
                  .enclosure = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
