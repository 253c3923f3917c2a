#include "scenarios/truth/cylinder.h"

#include <cmath>

#include "scenarios/truth/phases.h"

namespace plumb::scenarios::truth {
namespace {

using State = Trajectory::State;  // angle, its rate, the disc's angle, its rate; flying: x and y besides

constexpr Real kRadius = 0.25L, kReach = 1 + kRadius;  // m

Real normal(const State& y) { return kGravity * std::cos(y[0]) - kReach * y[1] * y[1]; }

Vec2<Real> outwards(Real angle) { return {std::sin(angle), std::cos(angle)}; }

State fly(const State& y) {
  const Vec2<Real> place = kReach * outwards(y[0]), velocity = y[1] * -perpendicular(place);
  return {place.x, velocity.x, y[2], y[3], place.y, velocity.y};
}

}  // namespace

Scene cylinder_scene(Scene scene, double angle, double friction) {
  const Vec2<Real> place = kReach * outwards(angle);
  scene.bodies = {fixed("cylinder", {}, solid(Circle{1}, friction)),
                  piece("disc", place.as<double>(), solid(Circle{0.25}, friction))};
  return scene;
}

Truth cylinder_truth(const Scene& scene, double angle, double friction, double duration) {
  const Real mu = friction;
  const Phase roll{[](const State& y, State& rate) {
                     const Real turn = kGravity * std::sin(y[0]) * 2 / 3 / kReach;
                     rate = {y[1], turn, y[3], -turn * kReach / kRadius};
                   },
                   [mu](const State& y) { return mu * normal(y) - kGravity * std::sin(y[0]) / 3; }};
  const Phase slip{[mu](const State& y, State& rate) {
                     const Real rub = mu * normal(y);
                     rate = {y[1], (kGravity * std::sin(y[0]) - rub) / kReach, y[3], -2 * rub / kRadius};
                   },
                   normal, fly};
  const Phase flight{[](const State& y, State& rate) { rate = {y[1], 0, y[3], 0, y[5], -kGravity}; }};
  const auto phases = mu > 0 ? std::vector{roll, slip, flight} : std::vector{slip, flight};
  const Phases path({angle, 0, 0, 0}, phases, duration);
  return integrated(follow_in_contact(
      scene, "Newton and Euler with Coulomb friction, long double Runge-Kutta-Fehlberg 7(8)",
      [path](Real t, Moving moving) {
        State y = path.at(t);
        if (y.size() == 4) y = fly(y);
        moving[0] = {{y[0], y[4]}, y[2], {y[1], y[5]}, y[3]};
      }));
}

}  // namespace plumb::scenarios::truth
