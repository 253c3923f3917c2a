#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds bricks at rest, in a bond or a stack. In a bond every second row has half a brick at each end.
// Without the half bricks, the end bricks of the rows above would have their centres exactly above an edge,
// and might fall.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, width = s, height = random.pick({0.3, 0.5, 1.0}) * s;
  const int rows = random.whole(2, 10), columns = random.whole(1, 6), first = draft.count();
  const bool bond = columns > 1 && random.chance(0.7);
  draft.restitution = 0;
  draft.friction = random.pick({0.3, 0.5, 0.6, 1.0});
  draft.density = 1;
  for (int i = 0; i < first; ++i)
    for (Shape& shape : draft.body(i).shapes) shape.friction = draft.friction, shape.restitution = 0;
  int top = first;  // first brick of the top row
  for (int row = 0; row < rows; ++row) {
    top = draft.count();
    const bool shifted = bond && row % 2 == 1;
    const double y = (row + 0.5) * height, end = 0.5 * columns * width - 0.25 * width;
    if (shifted) draft.box({-end, y}, width / 2, height);
    for (int column = 0; column < columns - (shifted ? 1 : 0); ++column)
      draft.box({(column + (shifted ? 0.5 : 0) - 0.5 * (columns - 1)) * width, y}, width, height);
    if (shifted) draft.box({end, y}, width / 2, height);
  }
  draft.out.sleeping = draft.random.chance(0.2);
  draft.out.dt = std::min(draft.out.dt, 1.0 / 60), draft.out.substeps = std::max(draft.out.substeps, 4);
  draft.out.steps = static_cast<int>(8 / draft.out.dt);
  for (int i = first; i < draft.count(); ++i) {
    // The expectations require the bricks below, without which the brick falls, and those below any other
    // one, which would fall on it or beside it.
    std::vector<std::string> needs;
    for (int k = 0; k < std::max(i, top); ++k)
      if (k != i) needs.push_back(draft.name(k));
    Expectation& stands = draft.expect("stands", i, Quantity::Drift);
    stands.upper = 0.1 * height;
    stands.why = "bricks stacked flat on each other stay in place";
    stands.needs = needs;
    Expectation& creeps = draft.expect("does_not_creep", i, Quantity::Drift);
    // The bricks sag when they are let go, by 0.3 % of their width in ten rows, and rise again by a factor of
    // e in 1.5 s: after 5 s by 0.012 %.
    creeps.from = 5;
    creeps.upper = 3e-4 * s;
    creeps.why = "a body at rest below its friction limit does not creep";
    creeps.needs = std::move(needs);
  }
}

const Register r{
    {.name = "wall", .title = "bricks at rest", .weight = 1, .air = false, .level = true, .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
