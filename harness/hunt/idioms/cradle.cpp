#include <algorithm>
#include <cmath>
#include <vector>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a row of balls, each as large as the one before or smaller, of which the first strikes the second.
// They strike one after the other, even balls that touch: a ball of mass m gives (1 + e) m / (m + m') of its
// speed to a ball of mass m', and follows it more slowly.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, speed = random.ladder(0.5, 20) * s;
  const int balls = random.whole(2, 7), first = draft.count();
  const bool touching = random.chance(0.5);
  const double shrinks = random.pick({1.0, 1.0, 0.8});
  draft.friction = 0;
  draft.out.scene.gravity = {0, 0};  // with gravity, impacts below 4 g dt would not bounce
  draft.restitution = touching ? 1 : random.pick({0.5, 0.8, 1.0});
  double x = 0, radius = random.within(0.1, 0.5) * s, now = speed, struck = 0;
  for (int i = 0; i < balls; ++i) {
    draft.disc({x, 0}, radius);
    const double next = radius * shrinks;
    const double gap = (i == 0 ? random.within(0.5, 3) : touching ? 0 : random.within(0.05, 1)) * radius;
    if (i + 1 == balls) break;
    struck += gap / now;
    now *= (1 + draft.restitution) / (1 + shrinks * shrinks);
    x += radius + gap + next;
    radius = next;
  }
  draft.body(first).velocity = {speed, 0};
  const double from = struck + 4 * draft.out.dt, flight = std::max(10 * draft.out.dt, 2 * s / speed);
  draft.out.steps = static_cast<int>((from + flight) / draft.out.dt);
  Expectation& leaves = draft.expect("is_handed_on", draft.count() - 1, Quantity::VelocityX);
  leaves.lower = 0.95 * now, leaves.upper = 1.02 * now;
  leaves.from = from;
  leaves.why = "a row of balls passes an impact on from one to the next";
  for (int i = first; i < draft.count(); ++i) leaves.needs.push_back(draft.name(i));
  leaves.needs.emplace_back(kMasses);
}

const Register r{{.name = "cradle",
                  .title = "a row of balls, one of which is struck",
                  .weight = 0.7,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
