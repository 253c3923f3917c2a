#include "extremes/parts/swing.h"

#include <cmath>
#include <utility>

#include "extremes/parts/scenes.h"

namespace plumb::extremes {

using scenarios::truth::Trajectory;

Swing::Swing(double k, double start)
    : path_(std::make_shared<const Trajectory>(
          Trajectory::State{start, 0},
          [k](const Trajectory::State& y, Trajectory::State& rate) {
            rate = {y[1], -static_cast<long double>(k) * std::sin(y[0])};
          },
          0.1L / std::sqrt(static_cast<long double>(k)))) {}

double Swing::angle(double time) const { return static_cast<double>(path_->at(time)[0]); }
double Swing::rate(double time) const { return static_cast<double>(path_->at(time)[1]); }

Motion swinging(double length, double angle, Vec2d pivot) {
  return [=, swing = Swing(1.5 * kGravity / length, angle)](double time, std::span<BodyState> out) {
    const double now = swing.angle(time), rate = swing.rate(time);
    const Vec2d arm = length / 2 * Vec2d{std::sin(now), -std::cos(now)};
    out[0] = {.position = pivot + arm,
              .angle = now,
              .velocity = rate * perpendicular(arm),
              .angular_velocity = rate};
  };
}

double swing_energy(double length, double angle) {
  return length * length * kGravity * length / 2 * (1 - std::cos(angle));
}

Trial swinging_rod(std::string name, double length, Vec2d pivot, double dt) {
  constexpr double kAngle = std::numbers::pi / 3;
  Trial trial{.scene = pendulum(std::move(name), length, kAngle, pivot), .dt = dt};
  const double period = 2 * std::numbers::pi / std::sqrt(1.5 * kGravity / length);
  trial.stretches = evenly(steps_for(2.2 * period, dt), 200);
  trial.exact = swinging(length, kAngle, pivot);
  trial.judge = [length, exact = trial.exact](const Scene& scene) {
    const double energy = swing_energy(length, kAngle);
    return judge_by({sum_of_gaps(scene, length / 100, 10 * length), energy_gained(scene, energy, 0.05),
                     energy_lost(scene, energy, 0.05), off_the_path(scene, exact, length / 10, 10 * length)});
  };
  return trial;
}

}  // namespace plumb::extremes
