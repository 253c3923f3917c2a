#include <algorithm>
#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Returns a triangle's inertia about its centroid, for a mass of 1: the sum of the squared sides over 36
// (Routh).
double inertia_of_triangle(const std::vector<Vec2d>& p) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += dot(p[(i + 1) % 3] - p[i], p[(i + 1) % 3] - p[i]);
  return sum / 36;
}

// Builds a body on a hinge that swings under its weight, with the period of a physical pendulum. Its inertia
// is computed here, independently of the engine.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, away = random.within(0.05, 0.3);
  if (draft.out.scene.gravity == Vec2d{0, 0}) draft.out.scene.gravity = {0, -9.81};
  const double g = -draft.out.scene.gravity.y;
  double inertia = 0;  // for a mass of 1
  int made = 0;
  switch (random.whole(0, 2)) {
    case 0: {
      const double width = s * random.within(0.1, 1), height = s * random.within(0.5, 2);
      made = draft.box({0, 0}, width, height);
      inertia = (width * width + height * height) / 12;
      break;
    }
    case 1: {
      const double radius = s * random.within(0.2, 1);
      made = draft.disc({0, 0}, radius);
      inertia = radius * radius / 2;
      break;
    }
    default: {
      const std::vector<Vec2d> corners{
          {-s, 0}, {s * random.within(0.2, 1), 0}, {0, s * random.within(0.5, 2)}};
      made = draft.add(Polygon{corners}, {0, 0});
      inertia = inertia_of_triangle(corners);
    }
  }
  const double arm = s * random.within(0.15, 0.6);
  Body& body = draft.body(made);
  body.position = {0, 0}, body.angle = away;
  const Vec2d along = direction(away - 1.5707963267948966);
  draft.revolute(-1, made, Vec2d{0, 0} - arm * along).reference_angle = 0;
  const double rate = std::sqrt(arm * g / (inertia + arm * arm));
  const double period = 6.283185307179586 / rate * (1 + away * away / 16);
  const double time = period * random.pick({0.25, 0.5, 0.75, 1.0});
  const int step = std::max(1, static_cast<int>(time / draft.out.dt + 0.5));
  draft.out.steps = step;
  Expectation& swings = draft.expect("swings_with_its_period", made, Quantity::Angle);
  const double right = away * direction(6.283185307179586 * step * draft.out.dt / period).x;
  // A first-order method keeps the phase to a step, and the amplitude to half the rotation of a step.
  const double slack = away * (0.03 + rate * draft.out.dt);
  swings.lower = right - slack, swings.upper = right + slack;
  swings.from = step * draft.out.dt, swings.to = swings.from;
  swings.why = "a body on a hinge swings with the period 2 pi sqrt(I / (m g d))";
  swings.needs = {std::visit([](const auto& j) { return j.name; }, draft.out.scene.joints.back()),
                  std::string(kMasses)};
}

const Register r{{.name = "pendulum",
                  .title = "a body on a hinge that swings under its weight",
                  .weight = 0.5,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
