#include "scenarios/truth/flight.h"

#include <algorithm>
#include <cmath>

#include "scenarios/truth/stepping.h"

namespace plumb::scenarios::truth {
namespace {

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

/// Drag on a body.
struct Drag {
  Real mass = 1, linear = 0, quadratic = 0;  // kg, N s/m, N s^2/m^2
};

std::vector<Drag> drags_of(const Scene& scene) {
  std::vector<Drag> drags;
  for (const Body& body : scene.bodies) drags.push_back({body.mass});
  for (const ForceLaw& law : scene.forces) {
    if (const auto* linear = std::get_if<LinearDrag>(&law))
      drags[*find_body(scene, linear->body)].linear = linear->coefficient;
    if (const auto* quadratic = std::get_if<QuadraticDrag>(&law))
      drags[*find_body(scene, quadratic->body)].quadratic = quadratic->coefficient;
  }
  return drags;
}

Motion flown(const Motion& from, const Drag& drag, Vec2<Real> gravity, Real time) {
  if (drag.linear > 0) return through_linear_drag(from, drag.mass, drag.linear, gravity, time);
  if (drag.quadratic > 0) return through_quadratic_drag(from, drag.mass, drag.quadratic, -gravity.y, time);
  return coast(from, time, {gravity});
}

}  // namespace

Truth flight_truth(const Scene& scene) {
  const std::vector<Motion> start = motions_of(scene);
  const std::vector<Drag> drags = drags_of(scene);
  const Vec2<Real> gravity = scene.gravity.as<Real>();
  const auto exact = [=](double time, std::span<BodyState> out) {
    for (std::size_t i = 0; i < start.size(); ++i) out[i] = rounded(flown(start[i], drags[i], gravity, time));
  };
  // v' = v + h (g + F(v)/m): the force uses the velocity at the start of the step.
  const auto law = [=](std::size_t i, double, const Motion& m) -> Acceleration {
    const Real rate = drags[i].linear + drags[i].quadratic * std::sqrt(length_squared(m.velocity));
    return {.linear = gravity - rate / drags[i].mass * m.velocity};
  };
  if (scene.forces.empty())
    return {.source = "x0 + v0 t + g t^2/2 (Galileo)",
            .exact = exact,
            .discrete = discrete_constant(start, std::vector(start.size(), Acceleration{gravity}))};
  return {.source = "linear drag: exponential; quadratic: (u^2/g) ln cosh(g t/u)",
          .exact = exact,
          .discrete = discrete_euler(start, law)};
}

}  // namespace plumb::scenarios::truth
