#include <algorithm>

#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a body that slides over a floor without friction.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size * random.pick({0.2, 0.5, 1.0}), speed = random.ladder(0.5, 20) * draft.size;
  const double from = -0.4 * draft.site.width;
  draft.friction = 0;
  for (int i = 0; i < draft.count(); ++i)
    for (Shape& shape : draft.body(i).shapes) shape.friction = 0, shape.restitution = 0;
  draft.restitution = 0;
  int made = 0;
  switch (random.whole(0, 3)) {
    case 0:
      made = draft.disc({from, s / 2}, s / 2);
      break;
    case 1:
      made = draft.add(Capsule{{-s, 0}, {s, 0}, s / 2}, {from, s / 2});
      break;
    case 2:
      made = draft.add(Polygon{{{-s, -s / 2}, {s, -s / 2}, {s / 2, s / 2}, {-s / 2, s / 2}}}, {from, s / 2});
      break;
    default:
      made = draft.box({from, s / 2}, s, s);
  }
  draft.body(made).velocity = {speed, 0};
  const double way = std::min(0.7 * draft.site.width, random.pick({3.0, 3.0, 20.0}) * draft.size);
  draft.out.steps = std::min(draft.out.steps, std::max(5, static_cast<int>(way / speed / draft.out.dt)));
  Expectation& keeps = draft.expect("keeps_speed", made, Quantity::VelocityX);
  keeps.lower = 0.98 * speed, keeps.upper = 1.02 * speed;
  keeps.why = "a body that slides on a level, frictionless floor keeps its speed";
  // The expectation requires the parts of the floor along the path.
  for (int i = 0; i < made; ++i) {
    const double reach =
        draft.body(i).shapes.size() > 1 ? draft.site.width : reach_of(draft.body(i).shapes.front().geometry);
    const double first = draft.body(i).position.x - reach - 2 * s, last = first + 2 * (reach + 2 * s);
    if (last > from && first < from) keeps.needs.push_back(draft.name(i));
    if (first >= from && first < from + way) keeps.until[draft.name(i)] = (first - from) / speed;
  }
  keeps.needs.push_back(draft.name(made));
}

const Register r{{.name = "slider",
                  .title = "a body that slides without friction",
                  .weight = 1.5,
                  .air = false,
                  .level = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
