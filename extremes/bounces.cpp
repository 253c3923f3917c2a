#include <algorithm>
#include <cmath>

#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

constexpr double kCrossing = 10.3;  // steps from wall to wall: impacts fall on all fractions of a step
constexpr double kRadius = 0.1, kSpeed = 1 / (kCrossing * kDt);
constexpr int kWindow = 1000;  // steps sampled one by one, at the start and at the end

Body wall(std::string name, double side) {
  return {.name = std::move(name),
          .type = BodyType::Static,
          .position = {side * (1 + kRadius), 0},
          .shapes = {{.geometry = Box{1, 10}, .friction = 0, .restitution = 1}}};
}

// Counts bounces where samples are one step apart. Tolerates a difference of one, as the count starts between
// impacts.
Rule count_is_off() {
  struct Count {
    double before = kSpeed, last = 0;
    int turns = 0, steps = 0;
  };
  Rule rule{.measure = "relative error of the number of bounces", .bound = 0.05};
  rule.figure = [count = Count()](double time, std::span<const BodyState> states) mutable {
    const double now = states[0].velocity.x;
    if (time - count.last < 1.5 * kDt) {
      ++count.steps;
      count.turns += now * count.before < 0 ? 1 : 0;
    }
    if (now != 0) count.before = now;
    count.last = time;
    const double right = count.steps / kCrossing;
    return std::max(0.0, std::abs(count.turns - right) - 1) / std::max(1.0, right);
  };
  return rule;
}

Rule outside() {
  Rule rule{.measure = "penetration of the wall", .unit = "m", .bound = 0.05, .beyond = Verdict::Tunnels};
  rule.figure = [](double, std::span<const BodyState> states) {
    return std::max(0.0, std::abs(states[0].position.x) - 0.5);
  };
  return rule;
}

Trial build(double bounces) {
  Trial trial{.scene = {.name = "bounces", .gravity = {}}};
  trial.scene.bodies = {{.name = "ball",
                         .velocity = {kSpeed, 0},
                         .shapes = {{.geometry = Circle{kRadius}, .friction = 0, .restitution = 1}}},
                        wall("left", -1),
                        wall("right", 1)};
  const long steps = std::lround(bounces * kCrossing), middle = steps - 2 * kWindow;
  if (middle <= 0) trial.stretches = {{static_cast<int>(steps), 1}};
  if (middle > 0) trial.stretches = {{kWindow, 1}, {1, static_cast<int>(middle)}, {kWindow, 1}};
  trial.exact = [start = trial.scene.bodies](double t, std::span<BodyState> out) {
    const double path = std::fmod(kSpeed * t + 0.5, 2), x = path < 1 ? path - 0.5 : 1.5 - path;
    out[0] = {.position = {x, 0}, .velocity = {path < 1 ? kSpeed : -kSpeed, 0}};
    for (const std::size_t i : {1, 2}) out[i] = initial_state(start[i]);
  };
  trial.judge = [](const Scene& scene) {
    constexpr double kEnergy = kSpeed * kSpeed / 2;
    return judge_by(
        {energy_gained(scene, kEnergy, 0.05), energy_lost(scene, kEnergy, 0.05), count_is_off(), outside()});
  };
  return trial;
}

const Register r{
    {.name = "bounces",
     .title = "a ball flies back and forth between two walls with restitution 1, 10.3 steps per crossing",
     .axis = "bounces",
     .values = {100, 1e3, 1e4, 1e5, 1e6},
     .usual = 100,
     .rule = "energy within 5 % at the end, number of bounces within 5 % in the first and last 1000 steps, "
             "penetration of the walls at most 5 cm",
     .patience = 3,
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
