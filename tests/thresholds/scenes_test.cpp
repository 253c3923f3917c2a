#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "engine/scene/validate.h"
#include "harness/thresholds/parts.h"
#include "harness/thresholds/threshold.h"

// Each threshold is well formed, and its judge knows standing from falling.
namespace plumb::harness::thresholds {
namespace {

constexpr double kResolution = 1e-3;

std::vector<BodyState> start_of(const Scene& scene) {
  std::vector<BodyState> states;
  for (const Body& body : scene.bodies) states.push_back(initial_state(body));
  return states;
}

TEST(Thresholds, AreWellFormed) {
  std::set<std::string> names;
  for (const Threshold& threshold : all()) {
    SCOPED_TRACE(threshold.name);
    EXPECT_TRUE(names.insert(threshold.name).second);
    EXPECT_EQ(&find(threshold.name), &threshold);
    for (const std::string& text : {threshold.title, threshold.quantity, threshold.source, threshold.judged})
      EXPECT_GT(text.size(), 8u);
    EXPECT_LT(threshold.range.low, threshold.range.high);
    EXPECT_TRUE(!threshold.range.logarithmic || threshold.range.low > 0);
    for (const double value : {threshold.range.low, threshold.range.high}) {
      const Trial trial = threshold.build(value, kResolution);
      EXPECT_NO_THROW(validate(trial.scene));
      EXPECT_GT(trial.duration, 5 * kStep);
      EXPECT_LT(trial.duration, 100);
    }
  }
}

TEST(Thresholds, HaveTheirExactValueInsideTheirRange) {
  for (const Threshold& threshold : all()) {
    for (const auto scheme : {reference::Scheme::SemiImplicitEuler, reference::Scheme::VelocityVerlet,
                              reference::Scheme::RungeKutta4, reference::Scheme::SoftStep}) {
      const auto exact = threshold.exact({.scheme = scheme, .substep = kStep / 4});
      if (!exact) continue;
      EXPECT_GT(*exact, 1.2 * threshold.range.low) << threshold.name;
      EXPECT_LT(*exact, threshold.range.high / 1.2) << threshold.name;
    }
  }
}

// Bodies that stay in place hold.
TEST(Thresholds, TheirJudgesCallRestHolding) {
  for (const char* name : {"ramp_friction", "steep_ramp_friction", "toppling_angle", "toppling_push",
                           "overhang", "overhang_of_two", "arch_thickness", "heavy_on_light", "heavy_tip"}) {
    const Trial trial = find(name).build(find(name).range.low, kResolution);
    const std::vector<BodyState> states = start_of(trial.scene);
    for (double time = kStep; time < trial.duration; time += kStep)
      EXPECT_EQ(trial.broke(time, states), "") << name;
  }
}

// A box with half a unit of the third digit too little friction is at a/2 t^2 downhill: seen in time. With a
// twentieth of that it is not.
TEST(Thresholds, ASlowSlideIsSeenInTime) {
  constexpr double kAngle = 20 * std::numbers::pi / 180;
  for (const double share : {1.0, 0.05}) {
    const Trial trial = find("ramp_friction").build(std::tan(kAngle), kResolution);
    std::vector<BodyState> states = start_of(trial.scene);
    const Vec2d start = states[1].position, downhill{-std::cos(kAngle), -std::sin(kAngle)};
    const double acceleration = share * kGravity * std::sin(kAngle) * kResolution / 2;
    bool seen = false;
    for (double time = kStep; time <= trial.duration; time += kStep) {
      states[1].position = start + acceleration / 2 * time * time * downhill;
      seen = seen || !trial.broke(time, states).empty();
    }
    EXPECT_EQ(seen, share == 1.0);
  }
}

// phi = (offset / arm) (cosh(rate t) - 1) passes the tilt within the time.
TEST(Thresholds, ASlowTiltIsSeenInTime) {
  constexpr double kOffset = 1e-4, kArm = 0.3, kGyrationSquared = 0.2;
  const double rate = std::sqrt(kGravity * kArm / kGyrationSquared);
  const double time = time_to_tilt(kOffset, kArm, kGyrationSquared, kToppled);
  EXPECT_GT(kOffset / kArm * (std::cosh(rate * time) - 1), kToppled);
  EXPECT_LT(kOffset / kArm * (std::cosh(rate * time / 1.6) - 1), kToppled);
}

TEST(Thresholds, AnUnknownNameSuggestsTheNearest) {
  try {
    find("overhan");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("overhang"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace plumb::harness::thresholds
