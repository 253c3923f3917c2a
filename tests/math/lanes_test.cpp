#include "engine/math/four.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace plumb {
namespace {

template <class Real>
class FourLanes : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(FourLanes, Reals);

template <class Real>
bool same(Real a, Real b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <class Real>
void expect_lanes(const Four<Real>& found, const Real (&expected)[4]) {
  Real lanes[4];
  found.store(lanes);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(lanes[i], expected[i]) << i;
}

TYPED_TEST(FourLanes, EachLaneIsTheSumOfSingleNumbers) {
  using Real = TypeParam;
  const Real x[4] = {Real(0.1), -3, Real(1e10), Real(1e-20)}, y[4] = {7, Real(-0.3), Real(1.7), 2};
  const Four<Real> a = Four<Real>::load(x), b = Four<Real>::load(y);
  expect_lanes(a + b, {x[0] + y[0], x[1] + y[1], x[2] + y[2], x[3] + y[3]});
  expect_lanes(a - b, {x[0] - y[0], x[1] - y[1], x[2] - y[2], x[3] - y[3]});
  expect_lanes(a * b, {x[0] * y[0], x[1] * y[1], x[2] * y[2], x[3] * y[3]});
  expect_lanes(a / b, {x[0] / y[0], x[1] / y[1], x[2] / y[2], x[3] / y[3]});
  expect_lanes(-a, {-x[0], -x[1], -x[2], -x[3]});
  EXPECT_FALSE(all(a > b));
  for (int lane = 0; lane < 4; ++lane) {
    Real less[4] = {Real(0.05), -4, Real(1e9), Real(1e-21)};
    EXPECT_TRUE(all(a > Four<Real>::load(less)));
    less[lane] = x[lane];
    EXPECT_FALSE(all(a > Four<Real>::load(less))) << lane;
  }
  expect_lanes(sqrt(b * b), {Real(7), std::sqrt(y[1] * y[1]), std::sqrt(y[2] * y[2]), Real(2)});
  expect_lanes(Four<Real>::of([&](int i) { return x[i]; }), {x[0], x[1], x[2], x[3]});
  expect_lanes(Four<Real>(Real(0.7)), {Real(0.7), Real(0.7), Real(0.7), Real(0.7)});
}

// The order of operands matters for zeros of both signs and for what is not a number.
TYPED_TEST(FourLanes, MinimaAndMaximaAreThoseOfTheStandardLibrary) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  const Real all[] = {Real(0), -Real(0), 1, -1, nan, std::numeric_limits<Real>::infinity()};
  for (const Real x : all) {
    for (const Real y : all) {
      const Four<Real> a(x), b(y);
      Real least[4], greatest[4], chosen[4];
      min(a, b).store(least), max(a, b).store(greatest), select(a < b, a, b).store(chosen);
      for (int i = 0; i < 4; ++i) {
        EXPECT_TRUE(same(least[i], std::min(x, y))) << x << " " << y;
        EXPECT_TRUE(same(greatest[i], std::max(x, y))) << x << " " << y;
        EXPECT_TRUE(same(chosen[i], x < y ? x : y)) << x << " " << y;
      }
      EXPECT_EQ(any(a < b), x < y);
      EXPECT_EQ(any(a > b), x > y);
    }
  }
  for (int lane = 0; lane < 4; ++lane) {
    Real numbers[4] = {1, 1, 1, 1};
    numbers[lane] = -1;
    EXPECT_TRUE(any(Four<Real>::load(numbers) < Four<Real>(0))) << lane;
  }
}

TYPED_TEST(FourLanes, RowsBecomeColumns) {
  using Real = TypeParam;
  alignas(16) const Real rows[4][4] = {{0, 1, 2, 3}, {10, 11, 12, 13}, {20, 21, 22, 23}, {30, 31, 32, 33}};
  const Four<Real> in[4] = {Four<Real>::load(rows[0]), Four<Real>::load(rows[1]), Four<Real>::load(rows[2]),
                            Four<Real>::load(rows[3])};
  Four<Real> out[4];
  transpose(in, out);
  for (int k = 0; k < 4; ++k) expect_lanes(out[k], {rows[0][k], rows[1][k], rows[2][k], rows[3][k]});
  Four<Real> loaded[4];
  load_records<true>([&](int i) { return rows[i]; }, loaded);
  for (int k = 0; k < 4; ++k) expect_lanes(loaded[k], {rows[0][k], rows[1][k], rows[2][k], rows[3][k]});
}

}  // namespace
}  // namespace plumb
