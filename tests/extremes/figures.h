#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "tests/extremes/runners.h"
#include "tests/extremes/scenes.h"

namespace plumb::test {

inline void report(const std::string& what, double value) {
  testing::Test::RecordProperty(what, std::to_string(value));
  std::printf("  %s: %.3g\n", what.c_str(), value);
}

// The most that a rod pendulum's energy leaves its start, of the m g L / 2 that it turns over.
inline double energy_change(Engine engine, int steps) {
  const auto runner = make_runner(engine, rod_pendulum({0, 0}));
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    runner->step();
    const BodyState s = runner->state(0);
    const double energy = 0.5 * length_squared(s.velocity) + s.angular_velocity * s.angular_velocity / 24 +
                          kGravity * s.position.y;
    worst = std::max(worst, std::abs(energy) / (0.5 * kGravity));
  }
  return worst;
}

}  // namespace plumb::test
