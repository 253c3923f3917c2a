#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

void take(Draft& draft, double width) {
  draft.site = {.kind = Site::Kind::Floor, .width = width, .friction = draft.friction, .level = false};
}

void slope(Draft& draft) {
  const double s = draft.size, angle = draft.random.within(-0.6, 0.6);
  const Vec2d down = direction(angle - 1.5707963267948966);
  draft.box({s * down.x, s * down.y - 3 * s}, 200 * s, 2 * s, angle, BodyType::Static);
  take(draft, 20 * s);
}

void stairs(Draft& draft) {
  const double s = draft.size;
  for (int i = 0; i < 8; ++i)
    draft.box({(2.0 * i - 8) * s, -(0.5 * i + 1) * s}, 2 * s, 2 * s, 0, BodyType::Static);
  take(draft, 16 * s);
}

void funnel(Draft& draft) {
  const double s = draft.size, angle = draft.random.within(0.5, 1.1), gap = draft.random.within(0, 1) * s;
  for (const double side : {-1.0, 1.0}) {
    const Vec2d along = direction(side * angle);
    draft.box({side * gap / 2 + 4 * s * side * along.x, -6 * s + 4 * s * std::abs(along.y)}, 8 * s, 0.5 * s,
              side * angle, BodyType::Static);
  }
  take(draft, 6 * s);
}

const Register a{{.name = "slope",
                  .title = "an inclined plane",
                  .role = Idiom::Role::Support,
                  .weight = 1,
                  .build = slope}};
const Register b{{.name = "stairs",
                  .title = "stairs of boxes",
                  .role = Idiom::Role::Support,
                  .weight = 0.5,
                  .build = stairs}};
const Register c{{.name = "funnel",
                  .title = "two slopes that form a funnel with a gap",
                  .role = Idiom::Role::Support,
                  .weight = 0.5,
                  .build = funnel}};

}  // namespace
}  // namespace plumb::harness::hunt
