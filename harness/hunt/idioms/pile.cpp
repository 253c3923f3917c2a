#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a pyramid, an arch, a house of cards or a bridge on two posts, at rest.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, width = s, height = random.pick({0.5, 1.0}) * s;
  const int rows = random.whole(2, 6), kind = random.whole(0, 2);
  draft.restitution = 0;
  if (kind == 0) {
    for (int row = 0; row < rows; ++row)
      for (int i = 0; i < rows - row; ++i)
        draft.box({(i - 0.5 * (rows - row - 1)) * 1.1 * width, (row + 0.5) * height}, width, height);
  } else if (kind == 1) {
    draft.box({-s, 0.5 * s}, 0.4 * s, s);
    draft.box({s, 0.5 * s}, 0.4 * s, s);
    draft.box({0, 1.1 * s}, 2.6 * s, 0.2 * s);
    for (int i = 0; i < rows; ++i) draft.box({0, 1.2 * s + (i + 0.5) * 0.5 * s}, 0.5 * s, 0.5 * s);
  } else {
    const double ratio = random.ladder(1, 1e4), dense = draft.density;
    for (int i = 0; i < rows; ++i) {
      draft.density = i == rows - 1 ? dense * ratio : dense;
      draft.box({0, (i + 0.5) * s}, s, s);
    }
    draft.density = dense;
  }
}

const Register r{{.name = "pile",
                  .title = "a pyramid, a gate or a loaded tower",
                  .weight = 1,
                  .air = false,
                  .level = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
