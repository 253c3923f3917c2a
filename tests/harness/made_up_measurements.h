#pragma once

#include <random>
#include <vector>

#include "engine/simulation/simulation.h"
#include "harness/reality/reality.h"

/// Measurements that obey a known law, for tests of what is found in measured ones.
namespace plumb::harness::reality {

/// Impacts that obey a law with these values, with noise of a hundredth on what is measured.
inline std::vector<MeasuredImpact> made_up(const EllipseLaw& law, const std::vector<double>& values) {
  std::mt19937 random(2);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<MeasuredImpact> out;
  for (int i = 0; i < 400; ++i) {
    MeasuredImpact one{.velocity = {draw(0, 1), draw(-3, -2)},
                       .angular_velocity = draw(-5, 5),
                       .lever_normal = draw(-0.01, 0.01),
                       .lever_tangent = draw(0.025, 0.035),
                       .place = draw(0.3, 0.45),
                       .doubted = i % 10 == 0};
    const double n = one.lever_normal, t = one.lever_tangent, k = values[0];
    const precise::ImpactPoint point{one.velocity.y + n * one.angular_velocity,
                                     one.velocity.x + t * one.angular_velocity, 1 + n * n / k, n * t / k,
                                     1 + t * t / k};
    const precise::ContactImpulse impulse = law.impulse(point, one, values);
    one.velocity_after = one.velocity + Vec2d{impulse.tangential, impulse.normal};
    one.angular_velocity_after = one.angular_velocity + (n * impulse.normal + t * impulse.tangential) / k;
    one.velocity_after += Vec2d{draw(-0.01, 0.01), draw(-0.01, 0.01)};
    if (one.doubted) one.velocity_after = {100, 100};
    out.push_back(one);
  }
  return out;
}

/// Drops that Precise moves under a law, 250 frames a second.
inline std::vector<MeasuredDrop> made_up_drops(const DropLaw& law, const std::vector<double>& values) {
  std::vector<MeasuredDrop> out;
  std::mt19937 random(3);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 40; ++i) {
    DropStart start{i, {{0, 0.12}, draw(0, 1.5), {draw(-1, 0), draw(-2, -1)}, draw(-3, 3)}, {}};
    const Scene scene = scene_of(start, law, values);
    Simulation simulation = compile(scene, plumb::Precise{.tolerance = 1e-7, .max_dt = 1 / kFramesPerSecond});
    MeasuredDrop drop{i, {}};
    for (int frame = 0; frame < 120; ++frame) {
      const BodyState state = simulation.state(1);
      drop.frames.push_back({state.position, state.angle - values[2]});
      simulation.step();
    }
    out.push_back(drop);
  }
  return out;
}

}  // namespace plumb::harness::reality
