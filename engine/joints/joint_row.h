#pragma once

#include <array>
#include <limits>

#include "engine/joints/definitions.h"
#include "engine/math/vec2.h"

/// What every kind of joint is described by: scalar rows with a residual and a Jacobian, and rules that say
/// what a row does with its residual. Kinds know nothing of who solves them.
namespace plumb {

/// How the joined bodies stand, as residuals see it.
template <class Real>
struct JointPose {
  Vec2<Real> offset{};  ///< m, of b's centre of mass from a's, in the world's axes
  Rotation<Real> rotation_a{}, rotation_b{};
  Real angle = 0;  ///< rad, of b relative to a, less the joint's reference angle
};

/// One scalar coordinate of a joint, linearised: dC/dt = J v.
template <class Real>
struct JointRow {
  Vec2<Real> linear_a{}, linear_b{};  ///< dC/d(centre of mass), per body
  Real angular_a = 0, angular_b = 0;  ///< dC/d(angle), per body
  Real residual = 0;                  ///< C, m or rad
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
  void add(const std::optional<Spring>& spring, double target) {
    if (spring) add({.role = RowRole::Spring, .origin = target, .spring = *spring});
  }
  void add(const std::optional<Motor>& motor) {
    if (motor) add({.role = RowRole::Motor, .speed = motor->speed, .max_force = motor->max_force});
  }
  void add(const std::optional<Range>& limits);
};

inline void RowRules::add(const std::optional<Range>& limits) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!limits) return;
  if (limits->lower > -kInfinity) add({.role = RowRole::Limit, .origin = limits->lower});
  if (limits->upper < kInfinity) add({.role = RowRole::Limit, .origin = limits->upper, .sign = -1});
}

}  // namespace plumb
