#include <algorithm>
#include <cmath>

#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a flat box that slides over a level floor until friction has stopped it.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, dt = draft.out.dt, g = -draft.out.scene.gravity.y;
  draft.friction = random.pick({0.1, 0.3, 0.6, 1.0}), draft.restitution = 0;
  // The coefficients of both surfaces need not be equal: their geometric mean counts.
  const double ratio = random.pick({1.0, 1.0, 2.0, 0.25});
  for (int i = 0; i < draft.count(); ++i)
    for (Shape& shape : draft.body(i).shapes) shape.friction = ratio * draft.friction, shape.restitution = 0;
  // Flat enough not to tip: friction acts at half its height.
  const double width = random.within(1, 2) * s, height = random.within(0.1, 0.4) * width;
  const double braking = draft.friction * g;  // m/s^2
  const double room = 0.8 * draft.site.width - 2 * width, from = -0.4 * draft.site.width + width;
  const double way = std::min(random.within(0.5, 6) * s, std::max(0.1 * s, room));
  const double speed = std::sqrt(2 * braking * way), stops = speed / braking;
  const int made = draft.box({from, height / 2}, width, height);
  for (Shape& shape : draft.body(made).shapes) shape.friction = draft.friction / ratio;
  draft.body(made).velocity = {speed, 0};
  const double time = stops * random.pick({0.3, 0.6, 1.0, 1.5});
  const int steps = draft.out.steps = std::max(2, static_cast<int>(time / dt));
  const double t = std::min(steps * dt, stops);
  const double right = from + speed * t - 0.5 * braking * t * t;
  // Tolerance: one step late or early, and the energy lost in a landing from slightly above the floor.
  const double slack = 0.02 * way + speed * dt + 0.002 * s;
  Expectation& brakes = draft.expect("brakes", made, Quantity::X);
  brakes.lower = right - slack, brakes.upper = right + slack;
  brakes.from = brakes.to = steps * dt;
  brakes.why = "a body that slides on a level floor decelerates by friction times gravity";
  for (int i = 0; i < made; ++i) {
    const std::vector<Shape>& shapes = draft.body(i).shapes;
    const double reach = shapes.size() > 1 ? draft.site.width : reach_of(shapes.front().geometry);
    const double low = draft.body(i).position.x - reach, high = draft.body(i).position.x + reach;
    if (high > from - width && low < right + width) brakes.needs.push_back(draft.name(i));
  }
  brakes.needs.emplace_back(kMasses);
}

const Register r{{.name = "brake",
                  .title = "a flat box that friction stops",
                  .weight = 0.5,
                  .air = false,
                  .level = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
