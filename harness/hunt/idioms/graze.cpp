#include <algorithm>
#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a disc that is thrown up against a ceiling, or swings up against it on a spring. It meets the
// ceiling near the top of its path, between two positions at which it does not touch.
void build(Draft& draft) {
  Random& random = draft.random;
  Case& out = draft.out;
  const double s = draft.size, dt = out.dt;
  draft.site.kind = Site::Kind::Air;
  if (out.scene.gravity == Vec2d{0, 0}) out.scene.gravity = {0, -9.81};
  const double g = -out.scene.gravity.y, radius = s * random.within(0.1, 0.5);
  draft.friction = 0, draft.restitution = 0;
  const bool swings = random.chance(0.5);
  // The approach must be faster than the speed that a step of free fall adds, and is seldom much faster.
  const double meets = random.within(6, 40) * g * dt;
  const double fall = random.within(0.1, 2) * s, speed = std::sqrt(meets * meets + 2 * g * fall);
  const int made = draft.disc({0, 0}, radius);
  draft.body(made).velocity = {random.within(-3, 3) * s, speed};
  const double at = fall + radius;
  const double width = 20 * s + 6 * std::abs(draft.body(made).velocity.x) * speed / g;
  const int ceiling = draft.box({0, at + s / 2}, width, s, 0, BodyType::Static);
  if (swings) {
    // A sinusoidal force is not part of gravity, so the path is known only in the vertical direction.
    const double rate = random.within(2, 20);
    out.scene.forces.push_back(
        SinusoidalForce{.body = draft.name(made),
                        .amplitude = {draft.body(made).mass * random.within(1, 10) * s, 0},
                        .angular_frequency = rate});
  }
  const double until = (speed - meets) / g, top = speed / g;
  // Without the ceiling the body would be back at its start, after a longer fall, by the end of the run.
  const int steps = out.steps = std::max(4, static_cast<int>((until + 2 * (top - until) + 0.3 * top) / dt));
  const double end = steps * dt;
  Expectation& below = draft.expect("is_stopped_by_a_ceiling", made, Quantity::Y);
  below.upper = fall + 0.05 * radius + meets * dt;
  below.why = "a body that is thrown against a ceiling does not pass through it";
  below.needs = {draft.name(ceiling)};
  Expectation& falls = draft.expect("falls_from_a_ceiling", made, Quantity::VelocityY);
  const double right = -g * (end - until), slack = 0.1 * meets + 3 * g * dt;
  falls.lower = right - slack, falls.upper = right + slack;
  falls.from = falls.to = end;
  falls.why = "after an impact without restitution a body has no normal speed; then it falls";
  falls.needs = {draft.name(ceiling), std::string(kMasses)};
}

const Register r{{.name = "graze",
                  .title = "a disc that hits a ceiling near the top of its path",
                  .weight = 0.5,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
