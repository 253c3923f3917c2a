#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "engine/joints/distance_joint.h"
#include "engine/joints/friction_joint.h"
#include "engine/joints/gear_joint.h"
#include "engine/joints/motor_joint.h"
#include "engine/joints/mouse_joint.h"
#include "engine/joints/prismatic_joint.h"
#include "engine/joints/pulley_joint.h"
#include "engine/joints/ratchet_joint.h"
#include "engine/joints/revolute_joint.h"
#include "engine/joints/weld_joint.h"
#include "engine/joints/wheel_joint.h"

namespace plumb {
namespace {

/// x, y, angle of a, then of b: where joints' coordinates are functions of.
using State = std::array<double, 6>;

Vec2d turned(double angle, Vec2d v) {
  return {std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y};
}
Rotation<double> rotation(double angle) { return {std::cos(angle), std::sin(angle)}; }

struct Checked {
  std::mt19937 random{7};

  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }
  Vec2d vector() { return {number(-2, 2), number(-2, 2)}; }
  State state() {
    return {number(-3, 3), number(-3, 3), number(-4, 4), number(-3, 3), number(-3, 3), number(-4, 4)};
  }
};

/// The pose that a kind sees. `ratio`: of a's angle.
JointPose<double> pose(const State& q, Vec2d from_a, Vec2d from_b, double reference, double ratio) {
  return {.offset = Vec2d{q[3], q[4]} - from_b,
          .offset_a = Vec2d{q[0], q[1]} - from_a,
          .rotation_a = rotation(q[2]),
          .rotation_b = rotation(q[5]),
          .angle = q[5] - ratio * q[2] - reference};
}

using Function = std::function<double(const State&)>;

/// The row's six entries are the central differences of `f`: of error e^2 / 6 f''' + rounding / e.
void expect_derivative(const JointRow<double>& row, const State& q, const Function& f) {
  const double entries[6] = {row.linear_a.x, row.linear_a.y, row.angular_a,
                             row.linear_b.x, row.linear_b.y, row.angular_b};
  for (int i = 0; i < 6; ++i) {
    constexpr double e = 1e-5;
    State up = q, down = q;
    up[i] += e;
    down[i] -= e;
    EXPECT_NEAR(entries[i], (f(up) - f(down)) / (2 * e), 5e-9) << "entry " << i;
  }
  EXPECT_NEAR(row.residual, f(q), 1e-12);
}

// Independent statements of the coordinates, from the definitions and the states alone.
Vec2d gap(const State& q, Vec2d anchor_a, Vec2d anchor_b) {
  return Vec2d{q[3], q[4]} + turned(q[5], anchor_b) - Vec2d{q[0], q[1]} - turned(q[2], anchor_a);
}
double size(Vec2d v) { return std::hypot(v.x, v.y); }

/// Rows of a kind whose offsets are between the bodies.
template <template <class> class Kind, class Definition>
JointRows<double> rows_of(const Definition& d, Vec2d centre_a, Vec2d centre_b, const State& q) {
  const Kind<double> kind(d, centre_a, centre_b);
  double reference = 0;
  if constexpr (requires { kind.reference; }) reference = kind.reference;
  JointRows<double> rows;
  kind.evaluate(pose(q, {}, {q[0], q[1]}, reference, 1), rows);
  return rows;
}

/// Both rows of a point in the frame that turns by `share_a` of a's angle and `share_b` of b's.
void expect_point(const AnchorPoint<double>& point, const State& q, Vec2d anchor_a, Vec2d anchor_b,
                  double share_a, double share_b) {
  for (const Vec2d n : {Vec2d{1, 0}, Vec2d{0, 1}, Vec2d{0.6, -0.8}}) {
    expect_derivative(point.plain_row(n), q, [&](const State& s) {
      return dot(turned(share_a * (s[2] - q[2]) + share_b * (s[5] - q[5]), n), gap(s, anchor_a, anchor_b));
    });
  }
}

TEST(JointKinds, DistanceIsTheLengthBetweenTheAnchors) {
  Checked c;
  for (int i = 0; i < 20; ++i) {
    const Vec2d a = c.vector(), b = c.vector(), centre_a = c.vector(), centre_b = c.vector();
    const State q = c.state();
    const auto rows =
        rows_of<DistanceRows>(DistanceDefinition{.anchor_a = a, .anchor_b = b}, centre_a, centre_b, q);
    expect_derivative(rows.axial[0], q,
                      [&](const State& s) { return size(gap(s, a - centre_a, b - centre_b)); });
  }
}

TEST(JointKinds, PointsOfRevoluteMotorFrictionAndSoftWeld) {
  Checked c;
  for (int i = 0; i < 20; ++i) {
    const Vec2d a = c.vector(), b = c.vector(), centre_a = c.vector(), centre_b = c.vector();
    const State q = c.state();
    const Vec2d arm_a = a - centre_a, arm_b = b - centre_b;
    const auto point = [&](const JointRows<double>& rows) { return rows.point; };
    expect_point(
        point(rows_of<RevoluteRows>(RevoluteDefinition{.anchor_a = a, .anchor_b = b}, centre_a, centre_b, q)),
        q, arm_a, arm_b, 0.5, 0.5);
    expect_point(
        point(rows_of<SoftWeldRows>(WeldDefinition{.anchor_a = a, .anchor_b = b}, centre_a, centre_b, q)), q,
        arm_a, arm_b, 0.5, 0.5);
    expect_point(
        point(rows_of<FrictionRows>(FrictionDefinition{.anchor_a = a, .anchor_b = b}, centre_a, centre_b, q)),
        q, arm_a, arm_b, 1, 0);
    // The motor joint moves b's origin.
    expect_point(point(rows_of<MotorRows>(MotorDefinition{.target_position = a}, centre_a, centre_b, q)), q,
                 arm_a, -centre_b, 1, 0);
  }
}

TEST(JointKinds, MouseIsThePointFromItsTarget) {
  Checked c;
  for (int i = 0; i < 20; ++i) {
    const Vec2d b = c.vector(), target = c.vector(), centre_b = c.vector();
    const State q = c.state();
    const MouseRows<double> kind(MouseDefinition{.anchor_b = b, .target = target}, {}, centre_b);
    JointRows<double> rows;
    kind.evaluate(pose(q, kind.ground_a, kind.ground_b, 0, 1), rows);
    for (const Vec2d n : {Vec2d{1, 0}, Vec2d{0, 1}}) {
      JointRow<double> row = rows.point.plain_row(n);
      row.linear_a = {};  // a has no part
      expect_derivative(row, q, [&](const State& s) {
        return dot(n, Vec2d{s[3], s[4]} + turned(s[5], b - centre_b) - target);
      });
    }
  }
}

TEST(JointKinds, WeldHoldsThePointAndTheAngle) {
  Checked c;
  for (int i = 0; i < 20; ++i) {
    const Vec2d a = c.vector(), b = c.vector(), centre_a = c.vector(), centre_b = c.vector();
    const State q = c.state();
    const WeldDefinition d{.anchor_a = a, .anchor_b = b, .reference_angle = 0.3};
    const auto rows = rows_of<WeldRows>(d, centre_a, centre_b, q);
    expect_derivative(rows.block[0], q, [](const State& s) { return s[5] - s[2] - 0.3; });
    for (int k = 1; k < 3; ++k) {
      const Vec2d n = k == 1 ? Vec2d{1, 0} : Vec2d{0, 1};
      expect_derivative(rows.block[k], q, [&](const State& s) {
        const double mean = 0.5 * (s[2] - q[2] + s[5] - q[5]);
        return dot(turned(mean, n), gap(s, a - centre_a, b - centre_b));
      });
    }
  }
}

TEST(JointKinds, PrismaticAndWheelSlideAlongAnAxisOfA) {
  Checked c;
  for (int i = 0; i < 20; ++i) {
    const Vec2d a = c.vector(), b = c.vector(), centre_a = c.vector(), centre_b = c.vector();
    const Vec2d axis = 3.0 * turned(c.number(-3, 3), {1, 0});
    const State q = c.state();
    const auto along = [&](const State& s) {
      return dot(turned(s[2], (1 / size(axis)) * axis), gap(s, a - centre_a, b - centre_b));
    };
    const auto across = [&](const State& s) {
      return dot(turned(s[2], (1 / size(axis)) * perpendicular(axis)), gap(s, a - centre_a, b - centre_b));
    };
    const auto slider = rows_of<PrismaticRows>(
        PrismaticDefinition{.anchor_a = a, .anchor_b = b, .axis = axis, .reference_angle = -0.2}, centre_a,
        centre_b, q);
    expect_derivative(slider.axial[0], q, along);
    expect_derivative(slider.block[0], q, [](const State& s) { return s[5] - s[2] + 0.2; });
    expect_derivative(slider.block[1], q, across);
    const auto wheel = rows_of<WheelRows>(WheelDefinition{.anchor_a = a, .anchor_b = b, .axis = axis},
                                          centre_a, centre_b, q);
    expect_derivative(wheel.axial[0], q, along);
    expect_derivative(wheel.axial[1], q, across);
  }
}

TEST(JointKinds, GearIsADifferenceOfAngles) {
  Checked c;
  for (int i = 0; i < 20; ++i) {
    const double ratio = c.number(-3, 3), phase = c.number(-3, 3);
    const State q = c.state();
    const GearRows<double> kind(GearDefinition{ratio, phase}, {}, {});
    JointRows<double> rows;
    kind.evaluate(pose(q, {}, {}, phase, ratio), rows);
    expect_derivative(rows.axial[0], q, [&](const State& s) { return s[5] - ratio * s[2] - phase; });
  }
}

TEST(JointKinds, PulleyIsTheRopeOverBothPulleys) {
  Checked c;
  for (int i = 0; i < 20; ++i) {
    const Vec2d a = c.vector(), b = c.vector(), centre_a = c.vector(), centre_b = c.vector();
    const Vec2d ground_a = 3 * c.vector(), ground_b = 3 * c.vector();
    const double ratio = c.number(0.3, 3);
    const State q = c.state();
    const PulleyRows<double> kind({ground_a, ground_b, a, b, ratio, {}}, centre_a, centre_b);
    JointRows<double> rows;
    kind.evaluate(pose(q, ground_a, ground_b, 0, 1), rows);
    expect_derivative(rows.axial[0], q, [&](const State& s) {
      return size(Vec2d{s[0], s[1]} + turned(s[2], a - centre_a) - ground_a) +
             ratio * size(Vec2d{s[3], s[4]} + turned(s[5], b - centre_b) - ground_b);
    });
  }
}

TEST(JointKinds, RatchetTeethStandAtMultiplesOfTheTooth) {
  const RatchetRows<double> forth(RatchetDefinition{.tooth = 0.5}, {}, {});
  EXPECT_EQ(forth.tooth_at(1.2), 2);
  EXPECT_EQ(forth.tooth_at(1.4999999), 3);  // at the tooth but for rounding
  EXPECT_EQ(forth.tooth_at(-0.2), -1);
  const RatchetRows<double> back(RatchetDefinition{.tooth = -0.5}, {}, {});
  EXPECT_EQ(back.tooth_at(-1.2), 2);  // counted the way that it is free to turn
}

TEST(JointKinds, CoincidentPointsGiveFiniteRows) {
  JointRows<double> rows;
  DistanceRows<double>(DistanceDefinition{}, {}, {}).evaluate({}, rows);
  EXPECT_EQ(rows.axial[0].residual, 0);
  EXPECT_EQ(length_squared(rows.axial[0].linear_b), 1);
  PulleyRows<double>(PulleyDefinition{}, {}, {}).evaluate({}, rows);
  EXPECT_EQ(rows.axial[0].residual, 0);
  EXPECT_EQ(length_squared(rows.axial[0].linear_b), 0);
}

}  // namespace
}  // namespace plumb
