// The order of convergence that each method claims, observed: the error at h, h/2 and h/4. The oracle is the
// engine itself at other steps; what the error is measured against is the truth.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/run.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {
namespace {

constexpr double kMargin = 0.3;

double error_of(const std::string& instance, const std::string& engine,
                const reference::StepSettings& settings, bool angle) {
  const Case scene_case(scenarios::select(instance).front(), settings.dt);
  const Result result = run(scene_case, reference::find_backend(engine), settings);
  EXPECT_EQ(result.status, Status::Ok) << result.reason;
  return angle ? result.metrics.angle_error.value_or(NAN) : result.metrics.position_error.value_or(NAN);
}

struct Order {
  const char* instance;
  const char* integrator;
  double order;
  bool angle;  // of the angle, where the path itself is exact
};

void PrintTo(const Order& order, std::ostream* out) { *out << order.integrator; }

class ConvergenceOrder : public testing::TestWithParam<Order> {};

TEST_P(ConvergenceOrder, IsTheOneOfTheMethod) {
  const auto& [instance, integrator, order, angle] = GetParam();
  std::vector<double> errors;
  for (const int parts : {1, 2, 4}) {
    reference::StepSettings settings;
    settings.dt = 1.0 / 240 / parts;
    settings.substeps = 1;
    settings.options["integrator"] = integrator;
    errors.push_back(error_of(instance, "plumb", settings, angle));
  }
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), order, kMargin) << errors[i - 1] << " to " << errors[i];
}

std::string name_of_test(const testing::TestParamInfo<Order>& info) {
  std::string name = std::string(info.param.instance) + "__" + info.param.integrator;
  std::string out;
  for (const char c : name) {
    if (c == ']') continue;
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return out + (info.param.angle ? "__angle" : "__position");
}

INSTANTIATE_TEST_SUITE_P(plumb, ConvergenceOrder,
                         testing::Values(Order{"off_centre_torque/corner_force", "velocity_verlet", 2, true},
                                         Order{"off_centre_torque/corner_force", "semi_implicit_euler", 1,
                                               true},
                                         Order{"off_centre_torque/corner_force", "explicit_euler", 1, true},
                                         Order{"free_fall/drag", "velocity_verlet", 2, false},
                                         Order{"free_fall/drag", "semi_implicit_euler", 1, false},
                                         Order{"free_fall/drag", "explicit_euler", 1, false},
                                         Order{"pendulum_chain[5]", "velocity_verlet", 2, false},
                                         Order{"pendulum_chain[5]", "semi_implicit_euler", 1, false},
                                         Order{"pendulum_chain[5]", "explicit_euler", 1, false}),
                         name_of_test);

struct Rival {
  const char* engine;
  const char* instance;
  const char* integrator;
  double order;
};

void PrintTo(const Rival& rival, std::ostream* out) { *out << rival.engine; }

class RivalsOrder : public testing::TestWithParam<Rival> {};

// That an adapter drives an engine as its makers meant it: the engine keeps its method's order.
TEST_P(RivalsOrder, IsTheOneOfItsMethod) {
  const auto& [engine, instance, integrator, order] = GetParam();
  ASSERT_TRUE(reference::find_backend(engine).identity().available)
      << reference::find_backend(engine).identity().reason;
  std::vector<double> errors;
  for (const int parts : {1, 2, 4}) {
    reference::StepSettings settings;
    settings.dt = 1.0 / 120 / parts;
    settings.options["integrator"] = integrator;
    errors.push_back(error_of(instance, engine, settings, false));
  }
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), order, kMargin) << errors[i - 1] << " to " << errors[i];
}

INSTANTIATE_TEST_SUITE_P(mechanisms, RivalsOrder,
                         testing::Values(Rival{"mujoco", "pendulum_chain[5]", "rk4", 4},
                                         Rival{"mujoco", "pendulum_chain[5]", "euler", 1},
                                         Rival{"mujoco", "free_fall/drag", "rk4", 4},
                                         Rival{"bullet-multibody", "pendulum_chain[5]", "rk4", 4},
                                         Rival{"bullet-multibody", "pendulum_chain[5]", "euler", 1}),
                         [](const auto& which) { return "engine" + std::to_string(which.index); });

class PreciseConvergence : public testing::TestWithParam<std::string> {};

// A hundredth of the tolerance: less than a tenth of the error, until rounding is reached.
TEST_P(PreciseConvergence, ErrorFallsWithTheTolerance) {
  double last = 0;
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    reference::StepSettings settings;
    settings.dt = 0.25;  // long enough for the tolerance, not the longest step, to decide
    settings.tolerance = tolerance;
    const double error = error_of(GetParam(), "plumb-precise", settings, false);
    if (last > 0) {
      EXPECT_LT(error, std::max(last / 10, 1e-12)) << "at " << tolerance;
    }
    RecordProperty("error_at_" + std::to_string(-std::lround(std::log10(tolerance))),
                   std::to_string(std::log10(error)));
    last = error;
  }
}

INSTANTIATE_TEST_SUITE_P(plumb, PreciseConvergence,
                         testing::Values("pendulum_chain[5]", "pendulum_chain[20]"),
                         [](const auto& which) { return "chain" + std::to_string(which.index); });

}  // namespace
}  // namespace plumb::harness
