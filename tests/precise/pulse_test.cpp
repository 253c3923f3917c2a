#include <gtest/gtest.h>

#include <cmath>

#include "engine/precise/precise.h"
#include "tests/precise/support.h"

// Forces that let a contact go and press it again many times within a step, by themselves: nothing moves
// before.
namespace plumb {
namespace {

/// A box of 1 kg on the floor, pulled up by `share` of its weight at most, `hertz` times a second.
Scene pulled(double share, double hertz, double phase) {
  Scene scene{.name = "pulled"};
  Body floor{.name = "floor", .type = BodyType::Static, .position = {0, -0.5}};
  floor.shapes = {{.geometry = Box{10, 1}}};
  Body box{.name = "box", .position = {0, 0.5}, .mass = 1, .inertia = 1.0 / 6};
  box.shapes = {{.geometry = Box{1, 1}}};
  scene.bodies = {floor, box};
  scene.forces = {SinusoidalForce{
      .body = "box", .amplitude = {0, share * 9.81}, .angular_frequency = 2 * kPi * hertz, .phase = phase}};
  return scene;
}

// It leaves the floor once in each period, when the pull passes its weight, and has landed long before the
// next one.
TEST(PrecisePulses, LiftOncePerPeriod) {
  for (const double hertz : {3.0, 47.0, 300.0, 2500.0}) {
    for (const double share : {1.001, 1.1}) {
      for (const double phase : {0.0, 2.0}) {
        const Precise precise{.tolerance = 1e-6, .max_dt = 0.02};
        const auto driver = make_precise_driver(pulled(share, hertz, phase), precise, {});
        advance(*driver, 2, 50);  // 1 s
        const Statistics statistics = driver->statistics();
        EXPECT_EQ(statistics.of(ContactEvent::Separation).count, static_cast<std::int64_t>(hertz))
            << hertz << " Hz, " << share << ", " << phase;
        // sin(w t + phase) = 1 / share, the last time before 1 s.
        const double turns = hertz + phase / (2 * kPi), up = std::asin(1 / share) / (2 * kPi);
        const double last = (std::floor(turns - up) + up - phase / (2 * kPi)) / hertz;
        EXPECT_NEAR(statistics.of(ContactEvent::Separation).last, last, 1e-9) << hertz << " " << share;
      }
    }
  }
}

TEST(PrecisePulses, BelowItsWeightNothingLifts) {
  for (const double hertz : {47.0, 2500.0}) {
    const auto driver = make_precise_driver(pulled(0.999, hertz, 0.3), {.max_dt = 0.02}, {});
    const auto states = advance(*driver, 2, 50);
    EXPECT_EQ(driver->statistics().of(ContactEvent::Separation).count, 0);
    EXPECT_NEAR(states[1].position.x, 0, 1e-15);
    EXPECT_NEAR(states[1].position.y, 0.5, 1e-15);
  }
}

}  // namespace
}  // namespace plumb
