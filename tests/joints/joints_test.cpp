#include "engine/joints/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

/// Two bodies on smooth arcs, and the exact poses and twists at any time.
struct Motion {
  BodyState start;
  Vec2d acceleration;
  double angular_acceleration = 0;

  Pose<double> pose(double t) const {
    const double angle = start.angle + t * start.angular_velocity + 0.5 * t * t * angular_acceleration;
    return {start.position + t * start.velocity + (0.5 * t * t) * acceleration, rotation_of(angle)};
  }
  Twist<double> twist(double t) const {
    return {start.velocity + t * acceleration, start.angular_velocity + t * angular_acceleration};
  }
};

const Motion kFirst{{{0.3, -0.2}, 0.4, {1.1, 0.7}, -1.3}, {0.5, -2}, 0.9};
const Motion kSecond{{{1.7, 0.9}, -1.1, {-0.4, 1.9}, 2.1}, {-1.5, 0.3}, -1.7};
const Motion kStill{};

/// J v and J a + bias must be the first and second derivative of the residual along the motion. Central
/// differences at step h err by h^2/6 C''' and h^2/12 C'''' plus rounding.
template <class J>
void check_derivatives(const J& joint, const Motion& a, const Motion& b) {
  const auto rows_at = [&](double t, Row<double>* out) {
    joint.rows(a.pose(t), b.pose(t), a.twist(t), b.twist(t), out);
  };
  Row<double> rows[2], before[2], after[2];
  rows_at(0, rows);
  for (int i = 0; i < J::kRows; ++i) {
    const Row<double>& row = rows[i];
    EXPECT_EQ(row.a, joint.a);
    EXPECT_EQ(row.b, joint.b);
    const auto along = [&](Vec2d linear_a, double angular_a, Vec2d linear_b, double angular_b) {
      return dot(row.linear_a, linear_a) + row.angular_a * angular_a + dot(row.linear_b, linear_b) +
             row.angular_b * angular_b;
    };
    const double rate = along(a.twist(0).velocity, a.twist(0).angular_velocity, b.twist(0).velocity,
                              b.twist(0).angular_velocity);
    const double second =
        along(a.acceleration, a.angular_acceleration, b.acceleration, b.angular_acceleration) +
        row.bias_acceleration;
    double h = 1e-5;
    rows_at(-h, before);
    rows_at(h, after);
    EXPECT_NEAR((after[i].residual - before[i].residual) / (2 * h), rate, 1e-8);
    h = 1e-3;
    rows_at(-h, before);
    rows_at(h, after);
    EXPECT_NEAR((after[i].residual - 2 * row.residual + before[i].residual) / (h * h), second, 2e-4);
  }
}

TEST(Revolute, RowsAreDerivativesOfTheGap) {
  check_derivatives(Revolute{0, 1, {0.5, -0.3}, {-0.7, 0.2}}, kFirst, kSecond);
}

TEST(Revolute, RowsToTheFixedFrame) {
  check_derivatives(Revolute{kFixedFrame, 1, {0.5, -0.3}, {-0.7, 0.2}}, kStill, kSecond);
  check_derivatives(Revolute{0, kFixedFrame, {0.5, -0.3}, {-0.7, 0.2}}, kFirst, kStill);
}

TEST(Distance, RowsAreDerivativesOfTheLength) {
  check_derivatives(Distance{0, 1, {0.5, -0.3}, {-0.7, 0.2}, 1.2}, kFirst, kSecond);
}

TEST(Distance, RowsToTheFixedFrame) {
  check_derivatives(Distance{kFixedFrame, 1, {0.5, -0.3}, {-0.7, 0.2}, 1.2}, kStill, kSecond);
  check_derivatives(Distance{0, kFixedFrame, {0.5, -0.3}, {-0.7, 0.2}, 1.2}, kFirst, kStill);
}

TEST(Distance, ResidualIsLengthMinusSetLength) {
  Row<double> row;
  Distance{kFixedFrame, 0, {1, 1}, {0, 0}, 4}.rows({}, {{4, 5}, {}}, {}, {}, &row);
  EXPECT_DOUBLE_EQ(row.residual, 1);  // the 3-4-5 triangle
  EXPECT_DOUBLE_EQ(row.linear_b.x, 0.6);
  EXPECT_DOUBLE_EQ(row.linear_b.y, 0.8);
}

TEST(Distance, CoincidentAnchorsGiveFiniteRows) {
  Row<double> row;
  Distance{kFixedFrame, 0, {}, {}, 1}.rows({}, {}, {}, {{3, 4}, 5}, &row);
  EXPECT_EQ(row.residual, -1);
  EXPECT_EQ(row.bias_acceleration, 0);
  EXPECT_EQ(length_squared(row.linear_b), 1);
}

TEST(Revolute, CentripetalAccelerationOfASpinningAnchor) {
  Row<double> rows[2];
  Revolute{kFixedFrame, 0, {2, 0}, {2, 0}}.rows({}, {}, {}, {{}, 3}, rows);
  EXPECT_DOUBLE_EQ(rows[0].bias_acceleration, -18);  // -w^2 r
  EXPECT_DOUBLE_EQ(rows[1].bias_acceleration, 0);
}

Scene mixed_scene() {
  Scene scene;
  scene.bodies = {{.name = "p"}, {.name = "q"}, {.name = "r"}};
  scene.joints = {DistanceJoint{"d", "q", "r", {1, 2}, {3, 4}, 5, false},
                  RevoluteJoint{"j", "world", "p", {6, 7}, {8, 9}, false},
                  RevoluteJoint{"k", "r", "q", {}, {1, 0}, false}};
  return scene;
}

TEST(CompileJoints, ResolvesNamesAndSortsByKind) {
  const Joints joints = compile_joints(mixed_scene());
  ASSERT_EQ(joints.revolute.size(), 2u);
  ASSERT_EQ(joints.distance.size(), 1u);
  EXPECT_EQ(joints.row_count(), 5u);
  EXPECT_EQ(joints.revolute[0].a, kFixedFrame);
  EXPECT_EQ(joints.revolute[0].b, 0);
  EXPECT_EQ(joints.revolute[0].anchor_a, (Vec2d{6, 7}));
  EXPECT_EQ(joints.revolute[0].anchor_b, (Vec2d{8, 9}));
  EXPECT_EQ(joints.revolute[1].a, 2);
  EXPECT_EQ(joints.revolute[1].b, 1);
  EXPECT_EQ(joints.distance[0].a, 1);
  EXPECT_EQ(joints.distance[0].b, 2);
  EXPECT_EQ(joints.distance[0].length, 5);
}

TEST(Joints, RowsFollowTheNumbering) {
  const Joints joints = compile_joints(mixed_scene());
  std::vector<Pose<double>> poses(3);
  poses[0].position = {-2, -2};
  poses[1].position = {1, 0};
  const std::vector<Twist<double>> twists(3);
  std::vector<Row<double>> rows(joints.row_count());
  joints.rows(poses, twists, rows);
  EXPECT_EQ(rows[0].residual, 0);  // p: (-2, -2) + (8, 9) - (6, 7)
  EXPECT_EQ(rows[1].residual, 0);
  EXPECT_EQ(rows[2].residual, 2);  // q's anchor (2, 0) from r's (0, 0)
  EXPECT_EQ(rows[3].residual, 0);
  EXPECT_DOUBLE_EQ(rows[4].residual, std::sqrt(5.0) - 5);  // r (3, 4) from q (2, 2)
}

}  // namespace
}  // namespace plumb
