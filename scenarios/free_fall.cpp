#include <algorithm>
#include <cmath>

#include "scenarios/scenario.h"
#include "scenarios/truth/motion.h"
#include "scenarios/truth/stepping.h"

// Free fall and throws, in a vacuum and through air: the basic task of an engine, and the first affected by
// the step size. Source of the closed forms: any mechanics text, e.g. Taylor, Classical Mechanics, ch. 2.
namespace plumb::scenarios {
namespace {
using namespace truth;

constexpr double kDuration = 10;

Body body(std::string name, double mass, Vec2d position, Vec2d velocity, double spin,
          const Geometry& geometry) {
  return {.name = std::move(name),
          .position = position,
          .velocity = velocity,
          .angular_velocity = spin,
          .mass = mass,
          .shapes = {untouchable(geometry)}};
}

/// Galileo: every mass falls alike, even if thrown or spinning. Conserved: energy and horizontal momentum.
Problem vacuum() {
  Problem problem{.scene = {.name = "free_fall/vacuum"}, .duration = kDuration};
  Scene& scene = problem.scene;
  scene.bodies = {body("feather", 0.001, {0, 0}, {0, 0}, 0, Circle{0.1}),
                  body("ball", 1, {2, 1}, {12, 30}, 0, Circle{0.25}),
                  body("wheel", 5, {-2, 3}, {-4.5, 8}, 7, Circle{0.5}),
                  body("plank", 20, {-6, 0.5}, {0, 0}, -2.5, Box{2, 0.25}),
                  body("anvil", 1000, {5, 0}, {1.5, -3}, 0, Box{0.8, 0.5})};
  const std::vector<Motion> start = motions_of(scene);
  const Acceleration fall{.linear = scene.gravity.as<Real>()};
  problem.truth = {.source = "x0 + v0 t + g t^2/2 (Galileo)",
                   .exact =
                       [=](double time, std::span<BodyState> out) {
                         std::ranges::transform(start, out.begin(), [&](const Motion& m) {
                           return rounded(coast(m, time, fall));
                         });
                       },
                   .discrete = discrete_constant(start, std::vector(start.size(), fall))};
  problem.conserved = {.energy = true, .momentum_x = true};

  // Relative 1e-13 of the fall g T^2/2, of the speed g T and of the rotation.
  const double speed = 9.81 * kDuration;
  problem.precise = {.position = 1e-13 * speed * kDuration / 2,
                     .angle = 1e-13 * 7 * kDuration,
                     .velocity = 1e-13 * speed,
                     .angular_velocity = 1e-13 * 7,
                     .energy = 1e-13,
                     .momentum = 1e-13};
  // Velocity Verlet is exact for a constant acceleration: x + h v + h^2 a/2 is the motion itself.
  problem.second_order = {
      .position = 0, .angle = 0, .velocity = 0, .angular_velocity = 0, .energy = 0, .momentum = 0};
  return problem;
}

/// F = -c v: v relaxes to the terminal velocity u = m g/c with the time constant m/c,
/// v = u + (v0 - u) e^(-t c/m), and x = x0 + u t + (v0 - u) (m/c) (1 - e^(-t c/m)).
Motion through_linear_drag(const Motion& from, Real mass, Real coefficient, Vec2<Real> gravity, Real time) {
  const Real tau = mass / coefficient;
  const Real gone = -std::expm1(-time / tau);  // 1 - e^(-t/tau)
  const Vec2<Real> terminal = tau * gravity, excess = from.velocity - terminal;
  return {from.position + time * terminal + tau * gone * excess, from.angle + time * from.angular_velocity,
          from.velocity - gone * excess, from.angular_velocity};
}

/// F = -k |v| v, dropped from rest: v = u tanh(g t/u), fallen (u^2/g) ln cosh(g t/u), u^2 = m g/k.
Motion through_quadratic_drag(const Motion& from, Real mass, Real coefficient, Real gravity, Real time) {
  const Real terminal = std::sqrt(mass * gravity / coefficient);
  const Real half_sinh = std::sinh(gravity * time / terminal / 2);
  const Real fallen = terminal * terminal / gravity * std::log1p(2 * half_sinh * half_sinh);
  const Real speed = terminal * std::tanh(gravity * time / terminal);
  return {from.position - Vec2<Real>{0, fallen},
          from.angle + time * from.angular_velocity,
          {0, -speed},
          from.angular_velocity};
}

/// Air: linear drag (Stokes) on one dropped and one thrown body, quadratic drag (Newton) on a dropped one.
Problem drag() {
  Problem problem{.scene = {.name = "free_fall/drag"}, .duration = kDuration};
  Scene& scene = problem.scene;
  scene.bodies = {body("linear", 2, {0, 0}, {0, 0}, 0, Circle{0.25}),
                  body("thrown", 0.5, {3, 1}, {20, 25}, 2, Box{0.5, 0.25}),
                  body("quadratic", 1, {-3, 0}, {0, 0}, 0, Circle{0.5})};
  const double linear[] = {0.5, 0.25}, quadratic = 0.02;
  scene.forces = {LinearDrag{"linear", linear[0]}, LinearDrag{"thrown", linear[1]},
                  QuadraticDrag{"quadratic", quadratic}};

  const std::vector<Motion> start = motions_of(scene);
  const std::vector<Real> mass = {2, 0.5L, 1};
  const Vec2<Real> gravity = scene.gravity.as<Real>();
  const auto exact = [=](double time, std::span<BodyState> out) {
    for (const std::size_t i : {0, 1})
      out[i] = rounded(through_linear_drag(start[i], mass[i], linear[i], gravity, time));
    out[2] = rounded(through_quadratic_drag(start[2], mass[2], quadratic, -gravity.y, time));
  };
  // v' = v + h (g + F(v)/m): the force uses the velocity at the start of the step.
  const auto law = [=](std::size_t i, double, const Motion& m) -> Acceleration {
    const Real rate = i < 2 ? linear[i] : quadratic * std::sqrt(length_squared(m.velocity));
    return {.linear = gravity - rate / mass[i] * m.velocity};
  };
  problem.truth = {.source = "linear drag: exponential; quadratic: (u^2/g) ln cosh(g t/u)",
                   .exact = exact,
                   .discrete = discrete_euler(start, law)};

  // Relative 1e-13 of the longest fall and of the largest speed here. At steps of 1/60 s a method of order 8
  // has only rounding errors for such smooth motion.
  problem.precise = {
      .position = 1e-13 * 250, .angle = 1e-12, .velocity = 1e-13 * 36, .angular_velocity = 1e-12};
  return problem;
}

Problem build(std::string_view variant, int) { return variant == "drag" ? drag() : vacuum(); }

const Register r{{.name = "free_fall",
                  .summary = "bodies dropped and thrown, in a vacuum and through air",
                  .variants = {"vacuum", "drag"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios
