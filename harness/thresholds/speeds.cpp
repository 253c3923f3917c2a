#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/thresholds/catalogue.h"
#include "harness/thresholds/parts.h"

// Speed limits: the highest speed at which a thin wall stops a bullet, and at which a free body moves
// undisturbed.
namespace plumb::harness::thresholds {
namespace {

constexpr double kWall = 0.01, kRadius = 0.05;  // m
constexpr int kBullets = 8;
constexpr int kSteps = 60;
constexpr double kSlowed = 1e-3;  // as a fraction of the speed, or of the displacement

// Fires eight bullets, because a step may happen to end inside the wall. Their starts are spread evenly over
// the displacement of a step, at most 10 m.
Trial bullets(double speed, double) {
  Trial trial{.scene = {.name = "stopped_bullet", .gravity = {0, 0}}};
  trial.scene.bodies = {held(block("wall", kWall, 40, {kWall / 2, 0}, 0))};
  const double spread = std::min(speed * kStep, 10.0);
  for (int i = 0; i < kBullets; ++i) {
    trial.scene.bodies.push_back({.name = fmt::format("bullet {}", i + 1),
                                  .position = {-(kRadius + 0.2 + spread * i / kBullets), i - kBullets / 2.0},
                                  .velocity = {speed, 0},
                                  .shapes = {{.geometry = Circle{kRadius}, .friction = 0}}});
  }
  trial.duration = (0.2 + spread) / speed + 20 * kStep;
  trial.broke = [](double time, std::span<const BodyState> states) {
    for (std::size_t i = 1; i < states.size(); ++i)
      if (states[i].position.x > kWall) return fmt::format("passes through the wall within {:.2g} s", time);
    return std::string();
  };
  return trial;
}

Trial flight(double speed, double) {
  Trial trial{.scene = {.name = "free_speed", .gravity = {0, 0}}, .duration = kSteps * kStep};
  trial.scene.bodies = {{.name = "ball", .velocity = {speed, 0}, .shapes = {{.geometry = Circle{kRadius}}}}};
  trial.broke = [speed](double time, std::span<const BodyState> states) {
    const double way = states[0].position.x / (speed * time), share = states[0].velocity.x / speed;
    if (std::abs(share - 1) > kSlowed) return fmt::format("is slowed to {:.3g} m/s", share * speed);
    if (std::abs(way - 1) > kSlowed) return fmt::format("covers {:.3g} of its path", way);
    return std::string();
  };
  return trial;
}

Trial turning(double spin, double) {
  Trial trial{.scene = {.name = "free_spin", .gravity = {0, 0}}, .duration = kSteps * kStep};
  trial.scene.bodies = {{.name = "rod", .angular_velocity = spin, .shapes = {{.geometry = Box{1, 0.1}}}}};
  trial.broke = [spin](double time, std::span<const BodyState> states) {
    const double way = states[0].angle / (spin * time), share = states[0].angular_velocity / spin;
    if (std::abs(share - 1) > kSlowed) return fmt::format("is slowed to {:.3g} rad/s", share * spin);
    if (std::abs(way - 1) > kSlowed) return fmt::format("rotates by {:.3g} of the expected angle", way);
    return std::string();
  };
  return trial;
}

}  // namespace

Threshold stopped_bullet() {
  return {.name = "stopped_bullet",
          .title = "fastest bullet that a thin wall stops",
          .quantity = "largest speed at which discs of 10 cm are stopped by a wall of 1 cm",
          .unit = "m/s",
          .source = "no limit: a rigid wall stops any bullet",
          .judged =
              "the centre of one of eight discs passes the wall; their starts divide the displacement of a "
              "step evenly",
          .range = {.low = 1, .high = 1e8, .logarithmic = true},
          .exact = no_exact_value,
          .build = bullets};
}

Threshold free_speed() {
  return {.name = "free_speed",
          .title = "largest speed of free flight",
          .quantity = "largest speed that a body keeps in free flight",
          .unit = "m/s",
          .source = "no limit: free bodies keep their speed",
          .judged = "relative error of the speed or the displacement above 1e-3 within 60 steps",
          .range = {.low = 1, .high = 1e8, .logarithmic = true},
          .exact = no_exact_value,
          .build = flight};
}

Threshold free_spin() {
  return {.name = "free_spin",
          .title = "largest angular velocity of free rotation",
          .quantity = "largest angular velocity that a body keeps",
          .unit = "rad/s",
          .source = "no limit: free bodies keep their speed",
          .judged = "relative error of the angular velocity or the angle above 1e-3 within 60 steps",
          .range = {.low = 1, .high = 1e6, .logarithmic = true},
          .exact = no_exact_value,
          .build = turning};
}

}  // namespace plumb::harness::thresholds
