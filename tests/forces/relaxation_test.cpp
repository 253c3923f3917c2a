#include "engine/forces/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plumb {
namespace {

// (1 - exp(-x)) / x, by the library's expm1.
TEST(MeanOfDecay, IsThatOfTheExponential) {
  for (const double x : {1e-300, 1e-9, 0.1, 0.25, 0.26, 1.0, 10.0, 40.0, 63.9, 64.1, 1e6, 1e300})
    EXPECT_NEAR(mean_of_decay(x) / (-std::expm1(-x) / x), 1, 1e-14) << x;
  EXPECT_EQ(mean_of_decay(0), 1);
}

// A body too light for its reciprocal has an infinite inverse mass.
TEST(MeanOfDecay, EndsForInfinity) { EXPECT_EQ(mean_of_decay(std::numeric_limits<double>::infinity()), 0); }

}  // namespace
}  // namespace plumb
