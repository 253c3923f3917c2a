#include <algorithm>
#include <vector>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds bricks at rest, in a bond or a stack. In a bond every second row is shorter by a brick, and the
// bricks at the ends of the others have their centres above the edges of those below: only the row above
// holds them. So a bond ends with a short row, and a brick is owed to stand while such pairs of rows are
// whole.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, width = s, height = random.pick({0.3, 0.5, 1.0}) * s;
  int rows = random.whole(2, 10);
  const int columns = random.whole(1, 6), first = draft.count();
  const bool bond = columns > 1 && random.chance(0.7);
  if (bond) rows += rows % 2;
  draft.restitution = 0;
  draft.friction = random.pick({0.3, 0.5, 0.6, 1.0});
  draft.density = 1;
  for (int i = 0; i < first; ++i)
    for (Shape& shape : draft.body(i).shapes) shape.friction = draft.friction, shape.restitution = 0;
  std::vector<int> above;  // of each brick: the first of the rows that it stands without
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns - (bond ? row % 2 : 0); ++column)
      draft.box(
          {(column + (bond && row % 2 == 1 ? 0.5 : 0) - 0.5 * (columns - 1)) * width, (row + 0.5) * height},
          width, height);
    if (bond && row % 2 == 0) continue;
    above.resize(static_cast<std::size_t>(draft.count() - first), draft.count());
  }
  draft.out.sleeping = draft.random.chance(0.2);
  draft.out.dt = std::min(draft.out.dt, 1.0 / 60), draft.out.substeps = std::max(draft.out.substeps, 4);
  draft.out.steps = static_cast<int>(8 / draft.out.dt);
  for (int i = first; i < draft.count(); ++i) {
    const int end = bond ? above[static_cast<std::size_t>(i - first)] : i;
    Expectation& stands = draft.expect("stands", i, Quantity::Drift);
    stands.upper = 0.1 * height;
    stands.why = "bricks that lie flat on each other stand";
    for (int k = 0; k < end; ++k) stands.needs.push_back(draft.name(k));
    Expectation& creeps = draft.expect("does_not_creep", i, Quantity::Drift);
    creeps.from = 3;
    creeps.upper = 5e-4 * s;
    creeps.why = "what has come to rest below its friction limit does not move";
    for (int k = 0; k < end; ++k) creeps.needs.push_back(draft.name(k));
  }
}

const Register r{
    {.name = "wall", .title = "bricks at rest", .weight = 1, .air = false, .level = true, .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
