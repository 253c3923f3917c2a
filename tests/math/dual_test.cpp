#include "engine/math/dual.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/vec2.h"

namespace plumb {
namespace {

TEST(Dual, DerivativesAreThoseOfTheFormulas) {
  const Dual x{0.7, 1};
  const Dual f = sqrt(x * x + 3) / (2 - x);
  const double root = std::sqrt(0.49 + 3);
  EXPECT_DOUBLE_EQ(f.value, root / 1.3);
  EXPECT_DOUBLE_EQ(f.change, 0.7 / root / 1.3 + root / (1.3 * 1.3));
  EXPECT_EQ((-x).change, -1);
  EXPECT_EQ(sqrt(Dual{0, 5}).change, 0);  // no direction at the tip of a root
}

TEST(Dual, VectorsOfThemTurn) {
  // d/dt of R(t) v is w z x R v.
  const Rotation<Dual> q{{0.6, -0.8 * 2}, {0.8, 0.6 * 2}};
  const Vec2<Dual> r = q * Vec2<Dual>{3, 1};
  EXPECT_DOUBLE_EQ(r.x.change, -2 * r.y.value);
  EXPECT_DOUBLE_EQ(r.y.change, 2 * r.x.value);
}

}  // namespace
}  // namespace plumb
