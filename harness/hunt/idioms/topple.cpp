#include <algorithm>
#include <cmath>

#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a tall box that leans on one edge and falls over it, with more friction than it needs: an inverted
// pendulum, integrated here, as long as it leans so little that it presses on its edge and does not slip.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, wide = random.within(0.2, 0.5) * s, g = -draft.out.scene.gravity.y;
  draft.friction = random.pick({1.0, 2.0}), draft.restitution = 0;
  for (int i = 0; i < draft.count(); ++i)
    for (Shape& shape : draft.body(i).shapes) shape.friction = draft.friction, shape.restitution = 0;
  // Leans beyond the angle at which its centre is above the edge.
  const double diagonal = std::sqrt(s * s + wide * wide) / 2, upright = std::atan2(wide, s);
  const double beyond = random.within(0.05, 0.2), lean = upright + beyond;
  const Vec2d to = direction(-lean);
  // The edge is the lower right corner, at x = 0.
  const Vec2d corner{wide / 2, -s / 2},
      arm{to.x * corner.x - to.y * corner.y, to.y * corner.x + to.x * corner.y};
  const int made = draft.box({-arm.x, -arm.y}, wide, s, -lean);
  const double about = inertia_of(draft.body(made)) / draft.body(made).mass + diagonal * diagonal;
  // phi'' = g d sin(phi) / k^2, phi the angle of the centre from above the edge; up to half a radian.
  double phi = beyond, rate = 0, time = 0;
  const double h = 1e-4;
  const auto sine = [](double angle) { return direction(angle).y; };
  while (phi < 0.5 && time < 3) {
    const double middle = phi + 0.5 * h * rate + 0.125 * h * h * g * diagonal * sine(phi) / about;
    const double a = g * diagonal * sine(middle) / about;
    phi += h * rate + 0.5 * h * h * a, rate += h * a, time += h;
  }
  const int steps = draft.out.steps = std::max(4, static_cast<int>(time / draft.out.dt));
  phi = beyond, rate = 0;
  for (int i = 0; i < static_cast<int>(steps * draft.out.dt / h + 0.5); ++i) {
    const double middle = phi + 0.5 * h * rate + 0.125 * h * h * g * diagonal * sine(phi) / about;
    const double a = g * diagonal * sine(middle) / about;
    phi += h * rate + 0.5 * h * h * a, rate += h * a;
  }
  const std::vector<std::string> needs = [&] {
    std::vector<std::string> out{std::string(kMasses)};
    for (int i = 0; i < made; ++i)
      if (draft.body(i).shapes.size() > 1 ||
          std::abs(draft.body(i).position.x) < reach_of(draft.body(i).shapes.front().geometry) + s)
        out.push_back(draft.name(i));
    return out;
  }();
  // A step late or early.
  const double slack = rate * draft.out.dt + 0.02 * (phi - beyond) + 1e-3;
  Expectation& falls = draft.expect("falls_over_its_edge", made, Quantity::Angle);
  falls.lower = -(upright + phi) - slack, falls.upper = -(upright + phi) + slack;
  falls.from = falls.to = steps * draft.out.dt;
  falls.why = "a toppling body rotates about its edge like an inverted pendulum";
  falls.needs = needs;
  Expectation& stays = draft.expect("keeps_its_edge", made, Quantity::X);
  const double right = diagonal * sine(phi);
  stays.lower = right - slack * diagonal, stays.upper = right + slack * diagonal;
  stays.from = stays.to = steps * draft.out.dt;
  stays.why = "the edge does not slip if friction is sufficient";
  stays.needs = needs;
}

const Register r{{.name = "topple",
                  .title = "a tall box that falls over its edge",
                  .weight = 0.4,
                  .air = false,
                  .level = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
