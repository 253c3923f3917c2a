#include "engine/world/character/plane_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/world/query_truth.h"

namespace plumb {
namespace {

using query_truth::Random;

double depth(const std::vector<HalfPlane>& planes, Vec2d point) {
  double worst = 0;
  for (const HalfPlane& plane : planes) worst = std::max(worst, plane.offset - dot(plane.normal, point));
  return worst;
}

std::vector<HalfPlane> random_planes(Random& random, int count, double facing) {
  std::vector<HalfPlane> planes;
  for (int i = 0; i < count; ++i) {
    const double angle = random.uniform(-facing, facing);
    planes.push_back({{std::cos(angle), std::sin(angle)}, random.uniform(-1, 1)});
  }
  return planes;
}

TEST(PlaneSolver, NoPointOfAllPlanesIsNearer) {
  Random random(3);
  int moved = 0;
  for (int round = 0; round < 300; ++round) {
    // Normals within a half circle: far out along the middle one, all are satisfied.
    const std::vector<HalfPlane> planes = random_planes(random, 1 + random.below(6), 1.5);
    const Vec2d wanted = random.within(3);
    const PlaneSolution found = solve_planes(planes, wanted);
    ASSERT_TRUE(found.feasible);
    EXPECT_LT(depth(planes, found.point), 1e-9);
    const double distance = std::sqrt(length_squared(found.point - wanted));
    moved += distance > 0;
    for (int i = 0; i < 1000; ++i) {
      const Vec2d other = wanted + random.within(distance);
      if (depth(planes, other) > 0) continue;
      EXPECT_GE(std::sqrt(length_squared(other - wanted)), distance - 1e-9);
    }
  }
  EXPECT_GT(moved, 150);
}

TEST(PlaneSolver, StaysInACornerExactly) {
  const std::vector<HalfPlane> corner = {{{0, 1}, 0}, {{-0.8, 0.6}, 0}};
  EXPECT_EQ(solve_planes(corner, {5, -10}).point, (Vec2d{0, 0}));
  EXPECT_EQ(solve_planes(corner, {-5, -3}).point, (Vec2d{-5, 0}));
}

TEST(PlaneSolver, SaysWhenThereIsNoWay) {
  const std::vector<HalfPlane> jaws = {{{1, 0}, 1}, {{-1, 0}, 1}};
  const PlaneSolution found = solve_planes(jaws, {0, 0});
  EXPECT_FALSE(found.feasible);
  EXPECT_NEAR(depth(jaws, found.point), 1, 1e-12);  // half-way between the jaws
}

}  // namespace
}  // namespace plumb
