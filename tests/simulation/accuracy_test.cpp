#include "engine/driver/accuracy.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/scene/error.h"
#include "tests/simulation/scenes.h"

namespace plumb {
namespace {

void expect_refused(const Accuracy& accuracy, const char* field) {
  try {
    validate(accuracy);
    FAIL() << field;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    EXPECT_EQ(error.field(), field);
  }
}

TEST(Accuracy, EverySettingHasItsRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  for (const double dt : {0.0, -1.0, nan, infinity}) {
    expect_refused(Realtime{.dt = dt}, "dt");
    expect_refused(Precise{.max_dt = dt}, "max_dt");
    expect_refused(Precise{.tolerance = dt}, "tolerance");
  }
  expect_refused(Realtime{.substeps = 0}, "substeps");
  expect_refused(Realtime{.threads = 0}, "threads");
  expect_refused(Realtime{.threads = 10000}, "threads");
  expect_refused(Realtime{.iterations = -1}, "iterations");
  expect_refused(Realtime{.precision = static_cast<Precision>(7)}, "precision");
  expect_refused(Realtime{.integrator = static_cast<Integrator>(3)}, "integrator");
  expect_refused(Realtime{.solver = static_cast<Solver>(9)}, "solver");
  expect_refused(Realtime{.on_violation = static_cast<OnViolation>(3)}, "on_violation");
  EXPECT_NO_THROW(validate(Realtime{}));
  EXPECT_NO_THROW(validate(Precise{}));
  EXPECT_THROW(compile(testing::empty_scene(), Realtime{.dt = -1}), Error);
}

TEST(Accuracy, Names) {
  EXPECT_EQ(name_of(Precision::Float), "float");
  EXPECT_EQ(name_of(Precision::Double), "double");
  EXPECT_EQ(name_of(Integrator::VelocityVerlet), "velocity_verlet");
  EXPECT_EQ(name_of(Integrator::SemiImplicitEuler), "semi_implicit_euler");
  EXPECT_EQ(name_of(Integrator::ExplicitEuler), "explicit_euler");
  EXPECT_EQ(name_of(OnViolation::Ignore), "ignore");
  EXPECT_EQ(name_of(OnViolation::Stop), "stop");
}

TEST(Accuracy, NumbersBeyondAWorldsRangeAreRefusedByName) {
  Scene scene = testing::with(testing::empty_scene(), {testing::disc("far", {1e60, 0})});
  for (const Precision precision : {Precision::Float, Precision::Double})
    EXPECT_NE(unsupported(scene, Realtime{.precision = precision}).find("far"), std::string::npos);
  scene.bodies[0].position.x = 1e12;
  EXPECT_EQ(unsupported(scene, Realtime{}), "");
}

}  // namespace
}  // namespace plumb
