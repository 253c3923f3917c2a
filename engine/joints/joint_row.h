#pragma once

#include <array>
#include <limits>
#include <optional>

#include "engine/joints/definitions.h"
#include "engine/math/vec2.h"

/// What every kind of joint is described by: coordinates with their Jacobians, and rules that say what is
/// asked of them. Kinds know nothing of who solves them.
namespace plumb {

/// How the joined bodies stand, as residuals see it.
template <class Real>
struct JointPose {
  Vec2<Real>
      offset{};  ///< m, of b's centre of mass from a's (of grounded kinds: from b's point of the world)
  Vec2<Real> offset_a{};  ///< m, of a's centre of mass from a's point of the world: grounded kinds only
  Rotation<Real> rotation_a{}, rotation_b{};
  Real angle = 0;  ///< rad, the joint's own: of b relative to a, less its reference
};

/// One scalar coordinate of a joint, linearised: dC/dt = J v.
template <class Real>
struct JointRow {
  Vec2<Real> linear_a{}, linear_b{};  ///< dC/d(centre of mass), per body
  Real angular_a = 0, angular_b = 0;  ///< dC/d(angle), per body
  Real residual = 0;                  ///< C, m or rad
};

/// Where the anchors are.
template <class Real>
struct AnchorPoint {
  Vec2<Real> arm_a{}, arm_b{};  ///< m, from the centres of mass
  Vec2<Real> gap{};             ///< m, anchor b less anchor a

  /// The row of C = n . gap, where n turns with a:
  /// dC/dt = n . (v_b + w_b x r_b - v_a - w_a x (r_a + gap)).
  JointRow<Real> row(Vec2<Real> n, Real residual) const {
    return {-n, n, -cross(arm_a + gap, n), cross(arm_b, n), residual};
  }
  JointRow<Real> row(Vec2<Real> n) const { return row(n, dot(n, gap)); }

  /// Both arms lead to anchor b, which conserves angular momentum. The Jacobian is that of the gap as seen
  /// from a: right for gaps that may be wide, where a's frame is what b is placed in.
  AnchorPoint at_b() const { return {arm_a + gap, arm_b, gap}; }
  /// Both arms lead to the middle of the gap, so that an impulse on b and its opposite on a conserve angular
  /// momentum too. Their Jacobian is that of the gap as seen from a frame that
  /// turns at the mean of the bodies' rates.
  AnchorPoint middle() const { return {arm_a + Real(0.5) * gap, arm_b - Real(0.5) * gap, gap}; }
  /// The row of n . gap with the arms as they are.
  JointRow<Real> plain_row(Vec2<Real> n) const {
    return {-n, n, -cross(arm_a, n), cross(arm_b, n), dot(n, gap)};
  }
};

template <class Real>
AnchorPoint<Real> anchor_point(const JointPose<Real>& pose, Vec2<Real> anchor_a, Vec2<Real> anchor_b) {
  const Vec2<Real> arm_a = pose.rotation_a * anchor_a, arm_b = pose.rotation_b * anchor_b;
  return {arm_a, arm_b, pose.offset + (arm_b - arm_a)};
}

/// All that a kind may tell of a pose; it fills what its constants announce.
template <class Real>
struct JointRows {
  AnchorPoint<Real> point{};  ///< kPoint: gap = 0, both components at once
  JointRow<Real> block[3]{};  ///< kBlock rows that are rigid, together
  JointRow<Real> axial[2]{};  ///< kAxial coordinates; the residual is the coordinate itself
  Vec2<Real> arm_b{};         ///< m, to the point that torques are told about
};

/// What the angle of a pose is to a kind.
enum class AngleUse {
  None,
  Counted,  ///< of b relative to a: whole turns count from the one at birth (`angle_at_birth`)
  Geared,   ///< whole turns count of each body
};

enum class RowRole {
  Rigid,   ///< C = 0
  Spring,  ///< C is pulled to 0 by a damped spring
  Limit,   ///< C >= 0, and the impulse is >= 0
  Motor,   ///< dC/dt is driven to a speed
};

/// What is asked of a coordinate q: C = sign (q - origin), held by `role` with a force of at most
/// `max_force`.
struct RowRule {
  RowRole role = RowRole::Rigid;
  double origin = 0;  ///< m or rad
  double sign = 1;
  Spring spring{};
  double speed = 0;                                            ///< m/s or rad/s
  double max_force = std::numeric_limits<double>::infinity();  ///< N or N m
};

/// Up to four rules on one coordinate, in the order in which they are solved: what must hold best comes last.
struct RowRules {
  static constexpr int kMost = 4;
  std::array<RowRule, kMost> rule{};
  int count = 0;

  void add(const RowRule& r) { rule[count++] = r; }
  bool has(RowRole role) const {
    for (int i = 0; i < count; ++i)
      if (rule[i].role == role) return true;
    return false;
  }
  void add_spring(const std::optional<Spring>& spring, double target) {
    if (spring) add({.role = RowRole::Spring, .origin = target, .spring = *spring});
  }
  void add_motor(const std::optional<Motor>& motor) {
    if (motor) add({.role = RowRole::Motor, .speed = motor->speed, .max_force = motor->max_force});
  }
  void add_limits(const std::optional<Range>& limits) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (!limits) return;
    if (limits->lower > -kInfinity) add({.role = RowRole::Limit, .origin = limits->lower});
    if (limits->upper < kInfinity) add({.role = RowRole::Limit, .origin = limits->upper, .sign = -1});
  }
};

/// The range that the limits among the rules allow.
inline Range limits_of(const RowRules& rules) {
  Range range;
  for (int i = 0; i < rules.count; ++i)
    if (rules.rule[i].role == RowRole::Limit)
      (rules.rule[i].sign > 0 ? range.lower : range.upper) = rules.rule[i].origin;
  return range;
}

/// The rules of one joint. A block needs none: its rows are rigid.
struct JointRules {
  RowRule point{};  ///< of both components; max_force bounds the vector
  RowRules turn{};  ///< of the angle
  RowRules axial[2]{};
};

/// Kinds that say nothing else.
template <int kBlockRows, int kAxialRows>
struct JointTraits {
  static constexpr int kBlock = kBlockRows;  ///< rigid rows that are solved together
  static constexpr int kAxial = kAxialRows;  ///< coordinates with rules of their own
  static constexpr bool kPoint = false;      ///< anchors that meet
  static constexpr bool kTurn = false;       ///< rules for the angle
  static constexpr bool kGrounded = false;   ///< offsets are from points of the world
  static constexpr AngleUse kAngle = AngleUse::None;
};

}  // namespace plumb
