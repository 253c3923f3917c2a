#include <algorithm>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a grid or a tree of many bodies on hinges, too many for a direct solve: chain mail, a crowd of
// ragdolls.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, step = random.pick({0.3, 0.5, 1.0}) * s;
  const int columns = random.whole(5, 11), rows = random.whole(5, 11), first = draft.count();
  const double height = draft.site.kind == Site::Kind::Air ? 0 : random.within(0.5, 2) * s;
  const double across = random.pick({0.0, 0.3, 1.0}), heavy = random.ladder(1, 30), dense = draft.density;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      draft.density = dense * (random.chance(0.2) ? heavy : 1);
      const Vec2d at{(column - 0.5 * columns) * step, height + (row + 0.5) * step};
      random.chance(0.5) ? draft.disc(at, 0.3 * step) : draft.box(at, 0.6 * step, 0.4 * step);
    }
  draft.density = dense;
  const auto tie = [&](int a, int b) {
    const Vec2d at = draft.body(a).position, to = draft.body(b).position;
    draft.revolute(a, b, 0.5 * (at + to));
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int at = first + row * columns + column;
      if (column + 1 < columns && (row == 0 || random.chance(across))) tie(at, at + 1);
      if (row + 1 < rows) tie(at, at + columns);
    }
  draft.pass_each_other(first);
  if (draft.site.kind == Site::Kind::Air) {
    if (random.chance(0.5)) draft.whirl(first, draft.body(first).position, random.within(-3, 3));
    if (random.chance(0.3)) draft.revolute(-1, first, draft.body(first).position);
  }
  // Their motion is large and costs much: a second says enough.
  draft.out.steps = std::max(10, static_cast<int>(1 / draft.out.dt));
}

const Register r{
    {.name = "mesh", .title = "many bodies on hinges, in a grid or a tree", .weight = 0.4, .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
