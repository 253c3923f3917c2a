#include "scenarios/truth/ladder.h"

#include <cmath>
#include <numbers>

#include "engine/scene/error.h"
#include "scenarios/truth/phases.h"
#include "scenarios/truth/set_up.h"

namespace plumb::scenarios::truth {
namespace {

using State = Trajectory::State;  // angle, its rate, x of the centre, its rate

constexpr Real kHalf = kLadder / Real(2), kInertia = kLadder * kLadder / Real(12);  // m, m^2 (1 kg)

Real angular_acceleration(const State& y, Real mu) {
  const Real c = std::cos(y[0]), s = std::sin(y[0]), w2 = y[1] * y[1], lean = s - 2 * mu * c;
  const Real torque = (kGravity - kHalf * c * w2) * lean + kHalf * c * s * w2;
  return kHalf * torque / (kInertia + kHalf * kHalf * (c * c + s * lean));
}

Real sideways_acceleration(const State& y, Real mu) {
  return kHalf * (std::cos(y[0]) * angular_acceleration(y, mu) - std::sin(y[0]) * y[1] * y[1]);
}

/// Returns the force of the wall over the mass.
Real push_of_wall(const State& y, Real mu) {
  const Real c = std::cos(y[0]), s = std::sin(y[0]);
  const Real normal = kGravity - kHalf * (s * angular_acceleration(y, mu) + c * y[1] * y[1]);
  return sideways_acceleration(y, mu) + mu * normal;
}

void on_floor_alone(const State& y, State& rate) {
  const Real c = std::cos(y[0]), s = std::sin(y[0]);
  const Real turn = kHalf * s * (kGravity - kHalf * c * y[1] * y[1]) / (kInertia + kHalf * kHalf * s * s);
  rate = {y[1], turn, y[3], 0};
}

}  // namespace

Scene ladder_scene(std::string_view name, std::string_view variant, double angle, double friction) {
  Scene scene = scene_of(name, variant);
  const double half = kLadder / 2;
  const Vec2d way = set_up::direction(angle);
  const Shape shape = solid(Polygon{{{-half, 0}, {0, -0.02}, {half, 0}, {0, 0.02}}}, friction);
  scene.bodies = {ground(friction),
                  fixed("wall", {-1, 2}, solid(Box{2, 6})),
                  {.name = "ladder",
                   .position = half * Vec2d{way.y, way.x},
                   .angle = angle + std::numbers::pi / 2,
                   .inertia = kLadder * kLadder / 12,
                   .shapes = {shape}}};
  return scene;
}

Truth ladder_truth(const Scene& scene, double angle, double friction, double duration) {
  const Real mu = friction;
  const Phase against_wall{[mu](const State& y, State& rate) {
                             rate = {y[1], angular_acceleration(y, mu), y[3], sideways_acceleration(y, mu)};
                           },
                           [mu](const State& y) { return push_of_wall(y, mu); }};
  const Phases path({angle, 0, kHalf * std::sin(Real(angle)), 0}, {against_wall, {on_floor_alone}}, duration);
  if (friction > 0 && !path.ends().empty())
    throw Error(Error::Kind::Run, "ladder", "friction", std::to_string(friction),
                "it leaves the wall, for which no truth is written");
  return integrated(follow_in_contact(
      scene, "Newton and Euler with Coulomb friction, long double Runge-Kutta-Fehlberg 7(8)",
      [path, angle](Real t, Moving moving) {
        const State y = path.at(t);
        const Real c = std::cos(y[0]), s = std::sin(y[0]);
        moving[0] = {{y[2], kHalf * c}, moving[0].angle + y[0] - angle, {y[3], -kHalf * s * y[1]}, y[1]};
      }));
}

}  // namespace plumb::scenarios::truth
