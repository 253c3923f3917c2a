#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/joints/definitions.h"
#include "engine/math/lanes.h"
#include "engine/math/vec2.h"

/// Description of every kind of joint: coordinates with their Jacobians, and the rules on them. Kinds do not
/// depend on their solvers. Functions that a step calls are always inlined: `Real` may be Lanes, and
/// functions compiled for different register widths pass Lanes differently.
namespace plumb {

/// Rotates from the body's frame to the world's.
template <class Real>
[[gnu::always_inline]] inline Vec2<Real> rotated(const Rotation<Real>& q, Vec2<Real> v) {
  return {q.c * v.x - q.s * v.y, q.s * v.x + q.c * v.y};
}

/// Normalises `axis`, which is not zero.
inline Vec2d unit(Vec2d axis) {
  // Scaled first: the square of a component must neither overflow nor underflow.
  const double largest = std::fmax(std::fabs(axis.x), std::fabs(axis.y));
  const Vec2d scaled{axis.x / largest, axis.y / largest};
  const double length = std::sqrt(length_squared(scaled));
  return {scaled.x / length, scaled.y / length};
}

/// Relative pose of the joined bodies, from which residuals are computed.
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

/// Lever arms of the anchors and the gap between them.
template <class Real>
struct AnchorPoint {
  Vec2<Real> arm_a{}, arm_b{};  ///< m, from the centres of mass
  Vec2<Real> gap{};             ///< m, anchor b less anchor a

  /// Returns the row of C = n . gap, where n rotates with a: dC/dt = n . (v_b + w_b x r_b - v_a - w_a x (r_a
  /// + gap)).
  [[gnu::always_inline]] JointRow<Real> row(Vec2<Real> n, Real residual) const {
    return {-n, n, -cross(arm_a + gap, n), cross(arm_b, n), residual};
  }
  [[gnu::always_inline]] JointRow<Real> row(Vec2<Real> n) const { return row(n, dot(n, gap)); }

  /// Moves both arms to anchor b, which conserves angular momentum. The Jacobian is that of the gap in a's
  /// frame: right for wide gaps, where b is placed in that frame.
  [[gnu::always_inline]] AnchorPoint at_b() const { return {arm_a + gap, arm_b, gap}; }
  /// Moves both arms to the middle of the gap, which conserves angular momentum too. The Jacobian is that of
  /// the gap in a frame that turns at the mean of the bodies' rates.
  [[gnu::always_inline]] AnchorPoint middle() const {
    return {arm_a + Real(0.5f) * gap, arm_b - Real(0.5f) * gap, gap};
  }
  /// Returns the row of n . gap with the arms unchanged.
  [[gnu::always_inline]] JointRow<Real> plain_row(Vec2<Real> n) const {
    return {-n, n, -cross(arm_a, n), cross(arm_b, n), dot(n, gap)};
  }
};

template <class Real>
[[gnu::always_inline]] inline AnchorPoint<Real> anchor_point(const JointPose<Real>& pose, Vec2<Real> anchor_a,
                                                             Vec2<Real> anchor_b) {
  const Vec2<Real> arm_a = rotated(pose.rotation_a, anchor_a), arm_b = rotated(pose.rotation_b, anchor_b);
  return {arm_a, arm_b, pose.offset + (arm_b - arm_a)};
}

/// All rows that a kind may compute for a pose; it fills those that its constants announce.
template <class Real>
struct JointRows {
  AnchorPoint<Real> point{};  ///< kPoint: gap = 0, both components at once
  JointRow<Real> block[3]{};  ///< kBlock rows that are rigid, together
  JointRow<Real> axial[2]{};  ///< kAxial coordinates; the residual is the coordinate itself
  Vec2<Real> arm_b{};         ///< m, to the point of reference of reported torques
};

/// Meaning of a pose's angle for a kind.
enum class AngleUse {
  None,
  Counted,  ///< of b relative to a: whole turns count from the angle at creation (`angle_at_creation`)
  Geared,   ///< whole turns of each body count
};

enum class RowRole {
  Rigid,   ///< C = 0
  Spring,  ///< a damped spring pulls C to 0
  Limit,   ///< C >= 0, and the impulse is >= 0
  Motor,   ///< drives dC/dt to a speed
};

/// A rule on a coordinate q: C = sign (q - origin), enforced by `role` with a force of at most `max_force`.
struct RowRule {
  RowRole role = RowRole::Rigid;
  double origin = 0;  ///< m or rad
  double sign = 1;
  Spring spring{};
  double speed = 0;                                            ///< m/s or rad/s
  double max_force = std::numeric_limits<double>::infinity();  ///< N or N m
};

/// Up to four rules on one coordinate, in the order in which they are solved: the last one is satisfied best.
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

/// Returns the range allowed by the limits among the rules.
inline Range limits_of(const RowRules& rules) {
  Range range;
  for (int i = 0; i < rules.count; ++i)
    if (rules.rule[i].role == RowRole::Limit)
      (rules.rule[i].sign > 0 ? range.lower : range.upper) = rules.rule[i].origin;
  return range;
}

/// The rules of one joint. A block has none: its rows are rigid.
struct JointRules {
  RowRule point{};     ///< of both components; max_force bounds the vector
  RowRules angular{};  ///< of the angle
  RowRules axial[2]{};
};

/// Defaults of the constants of kinds.
template <int kBlockRows, int kAxialRows>
struct JointTraits {
  static constexpr int kBlock = kBlockRows;  ///< rigid rows that are solved together
  static constexpr int kAxial = kAxialRows;  ///< coordinates with rules of their own
  static constexpr bool kLength = false;     ///< axial coordinates are lengths of a rod or rope
  static constexpr bool kPoint = false;      ///< anchors that coincide
  static constexpr bool kSoft = false;       ///< ... by a rule that may yield
  static constexpr bool kAngular = false;    ///< rules for the angle
  static constexpr bool kGrounded = false;   ///< offsets are from points of the world
  static constexpr AngleUse kAngle = AngleUse::None;
};

}  // namespace plumb
