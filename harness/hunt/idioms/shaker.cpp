#include <algorithm>
#include <cmath>

#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a box on the floor under a sinusoidal force: upwards until it leaves the floor, or sideways until it
// slips.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, dt = draft.out.dt, g = -draft.out.scene.gravity.y;
  draft.restitution = 0, draft.friction = random.pick({0.3, 0.6});
  for (int i = 0; i < draft.count(); ++i)
    for (Shape& shape : draft.body(i).shapes) shape.friction = draft.friction, shape.restitution = 0;
  const bool up = random.chance(0.5);
  const double width = random.within(1, 3) * s, height = random.within(0.2, 0.5) * s;
  const int made = draft.box({0, height / 2}, width, height);
  const double mass = draft.body(made).mass, holds = up ? g : draft.friction * g;  // m/s^2
  // Phase at which the force reaches the weight or the friction limit.
  const double start = random.within(0.3, 1.2), peak = holds / direction(start).y;
  const double rate = std::sqrt(g / s) * random.ladder(0.3, 2);
  SinusoidalForce force{.body = draft.name(made), .angular_frequency = rate};
  force.amplitude = up ? Vec2d{0, mass * peak} : Vec2d{mass * peak, 0};
  if (!up) force.point = {0, -height / 2};  // so that it does not tip
  draft.out.scene.forces.push_back(force);
  // The run ends when the force has fallen to the same value again.
  const int steps = draft.out.steps = std::max(2, static_cast<int>((3.141592653589793 - start) / rate / dt));
  const double t = steps * dt, span = std::max(0.0, t - start / rate);
  const Vec2d first = direction(start), last = direction(std::max(rate * t, start));
  const double right = peak / rate * (span * first.x - (last.y - first.y) / rate) - 0.5 * holds * span * span;
  // A step late or early.
  const double slack = 0.05 * std::abs(right) + (peak - holds) * span * dt + 0.002 * s;
  Expectation& moves = draft.expect(up ? "lifts_off" : "slips", made, up ? Quantity::Y : Quantity::X);
  const double from = up ? height / 2 : 0;
  moves.lower = from + right - slack, moves.upper = from + right + slack;
  moves.from = moves.to = t;
  moves.why = "a body that is pushed harder than friction holds it accelerates by the difference";
  // The expectation requires the parts of the floor along the path.
  for (int i = 0; i < made; ++i) {
    const std::vector<Shape>& shapes = draft.body(i).shapes;
    const double reach = shapes.size() > 1 ? draft.site.width : reach_of(shapes.front().geometry);
    const double low = draft.body(i).position.x - reach, high = draft.body(i).position.x + reach;
    if (high > -width && low < width + (up ? 0 : right + slack)) moves.needs.push_back(draft.name(i));
  }
  moves.needs.emplace_back(kMasses);
}

const Register r{{.name = "shaker",
                  .title = "a box on the floor under an oscillating force",
                  .weight = 0.5,
                  .air = false,
                  .level = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
