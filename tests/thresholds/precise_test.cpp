#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "harness/thresholds/find.h"
#include "harness/thresholds/trial_run.h"

// plumb-precise has the exact values, to the digits that were asked for.
namespace plumb::harness::thresholds {
namespace {

class Exact : public testing::TestWithParam<std::string> {};

// The bracket is at most a unit of the third digit wide and contains where the judge's bound is passed: half
// a unit beyond the exact value is seen in half the time, so that is at most half a unit beyond it.
TEST_P(Exact, IsFoundByPrecise) {
  const Request request{&find(GetParam()), &reference::find_backend("plumb-precise")};
  const Finding finding = find_one(request, {.digits = 3, .seconds_a_run = 60});
  ASSERT_EQ(finding.outcome, Finding::Outcome::Found) << finding.reason;
  EXPECT_NEAR(*finding.relative_difference(), 0, 1e-3)
      << *finding.found << " for " << *finding.exact << " after " << finding.runs << " runs";
}

INSTANTIATE_TEST_SUITE_P(Thresholds, Exact,
                         testing::Values("ramp_friction", "steep_ramp_friction", "toppling_angle",
                                         "toppling_push", "overhang", "overhang_of_two"),
                         [](const auto& each) { return each.param; });

// The arch takes a second a run: the two sides of its exact value will do.
TEST(Thresholds, TheArchStandsAndFallsByPrecise) {
  const Threshold& arch = find("arch_thickness");
  const reference::Backend& precise = reference::find_backend("plumb-precise");
  const double exact = *arch.exact({});
  EXPECT_TRUE(run_isolated(arch, exact * (1 + 0.5e-3), 1e-3, precise, {.dt = kStep}, 120).holds);
  const Answer thin = run_isolated(arch, exact * (1 - 0.5e-3), 1e-3, precise, {.dt = kStep}, 120);
  EXPECT_FALSE(thin.holds);
  EXPECT_NE(thin.why.find("moved by"), std::string::npos) << thin.why;
}

// Symplectic Euler's own limit, omega h = 2 with h the substep, in plumb's fixed steps.
TEST(Thresholds, SymplecticEulerLosesTheSpringWhereItMust) {
  const Request request{.threshold = &find("spring_force"),
                        .backend = &reference::find_backend("plumb"),
                        .settings = {.dt = kStep, .options = {{"integrator", "semi_implicit_euler"}}}};
  const Finding finding = find_one(request, {});
  ASSERT_EQ(finding.outcome, Finding::Outcome::Found) << finding.reason;
  ASSERT_TRUE(finding.exact);
  EXPECT_EQ(*finding.exact, 8);
  EXPECT_NEAR(*finding.found, 8, 8 * 1e-3);
}

// Verlet has the same; where it moves plumb's bodies it has as many substeps as the spring needs.
TEST(Thresholds, NoSpringIsTooStiffWhereSubstepsFollowIt) {
  const Finding finding = find_one({&find("spring_force"), &reference::find_backend("plumb")}, {});
  EXPECT_EQ(finding.outcome, Finding::Outcome::Always) << finding.reason;
  EXPECT_FALSE(finding.exact);
}

}  // namespace
}  // namespace plumb::harness::thresholds
