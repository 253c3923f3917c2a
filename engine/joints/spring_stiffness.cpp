#include "engine/joints/spring_stiffness.h"

#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include "engine/joints/distance_joint.h"
#include "engine/joints/friction_joint.h"
#include "engine/joints/gear_joint.h"
#include "engine/joints/joint_angle.h"
#include "engine/joints/joint_check.h"
#include "engine/joints/motor_joint.h"
#include "engine/joints/mouse_joint.h"
#include "engine/joints/prismatic_joint.h"
#include "engine/joints/pulley_joint.h"
#include "engine/joints/ratchet_joint.h"
#include "engine/joints/revolute_joint.h"
#include "engine/joints/weld_joint.h"
#include "engine/joints/wheel_joint.h"
#include "engine/scene/error.h"

namespace plumb {
namespace {

/// Type of the rows of a definition. Welds are those that may be soft, hinges those that may have a spring.
template <class Definition>
struct RowsOf;
#define PLUMB_ROWS(Name, Kind)       \
  template <>                        \
  struct RowsOf<Name##Definition> {  \
    using Type = Kind##Rows<double>; \
  };
PLUMB_ROWS(Distance, Distance)
PLUMB_ROWS(Revolute, Revolute)
PLUMB_ROWS(Prismatic, Prismatic)
PLUMB_ROWS(Weld, SoftWeld)
PLUMB_ROWS(Wheel, Wheel)
PLUMB_ROWS(Motor, Motor)
PLUMB_ROWS(Mouse, Mouse)
PLUMB_ROWS(Gear, Gear)
PLUMB_ROWS(Pulley, Pulley)
PLUMB_ROWS(Ratchet, Ratchet)
PLUMB_ROWS(Friction, Friction)
#undef PLUMB_ROWS

/// Returns J M^-1 J^T.
double row_mobility(const PairMobility<double>& p, const JointRow<double>& row) {
  return p.m_a * length_squared(row.linear_a) + p.i_a * row.angular_a * row.angular_a +
         p.m_b * length_squared(row.linear_b) + p.i_b * row.angular_b * row.angular_b;
}

/// Returns the mobility of a point's spring. K = m 1 + i_a p_a p_a^T + i_b p_b p_b^T has the trace and the
/// determinant of `response`; the effective mass averaged over all directions is half the trace of K^-1.
double mean_mobility(double trace, double determinant) {
  // K is singular if only rotation about one arm is free: the one direction that moves counts.
  const bool regular = determinant > std::numeric_limits<double>::epsilon() * trace * trace;
  return regular ? 2 * determinant / trace : trace;
}

double point_mobility(const PairMobility<double>& p, const AnchorPoint<double>& at, bool angle_holds) {
  const double m = p.m_a + p.m_b;
  if (angle_holds) {
    const double turn = common_rotation_mobility(p) * length_squared(at.arm_b - at.arm_a);
    return mean_mobility(2 * m + turn, m * (m + turn));
  }
  const double turn = p.i_a * length_squared(at.arm_a) + p.i_b * length_squared(at.arm_b);
  const double across = cross(at.arm_a, at.arm_b);
  return mean_mobility(2 * m + turn, m * (m + turn) + p.i_a * p.i_b * across * across);
}

template <class Rows>
SpringMobility mobility_of(const Rows& kind, const JointRules& rules, const JointPose<double>& at,
                           const PairMobility<double>& p) {
  SpringMobility out;
  JointRows<double> rows;
  kind.evaluate(at, rows);
  const bool point_holds = Rows::kPoint && rules.point.role == RowRole::Rigid &&
                           rules.point.max_force == std::numeric_limits<double>::infinity();
  if constexpr (Rows::kAngular)
    out.angular = point_holds ? angular_mobility(p, rows.point.arm_a, rows.point.arm_b) : p.i_a + p.i_b;
  if constexpr (Rows::kAxial > 1) {
    const JointRow<double>&first = rows.axial[0], &second = rows.axial[1];
    out.axial = line_mobility(p, first.angular_a, first.angular_b, second.angular_a, second.angular_b);
  } else if constexpr (Rows::kAxial > 0 && Rows::kBlock > 0) {
    out.axial = slider_mobility(p, at.offset, rows.axial[0].linear_b);
  } else if constexpr (Rows::kAxial > 0) {
    out.axial = row_mobility(p, rows.axial[0]);
  }
  if constexpr (Rows::kPoint) out.point = point_mobility(p, rows.point, rules.angular.has(RowRole::Rigid));
  return out;
}

}  // namespace

JointReference reference_of(const Pose<double>& a, Vec2d centre_a, const Pose<double>& b, Vec2d centre_b) {
  const Rotation<double>&q = a.rotation, &r = b.rotation;
  const Vec2d apart = (b.position - r * centre_b) - (a.position - q * centre_a);
  return {.offset = {q.c * apart.x + q.s * apart.y, q.c * apart.y - q.s * apart.x},
          .rotation = {q.c * r.c + q.s * r.s, q.c * r.s - q.s * r.c}};
}

SpringMobility spring_mobility(const JointKind& definition, const JointReference& reference, Vec2d centre_a,
                               Vec2d centre_b, const PairMobility<double>& bodies) {
  return std::visit(
      [&](const auto& kind) -> SpringMobility {
        using Rows = typename RowsOf<std::remove_cvref_t<decltype(kind)>>::Type;
        JointPose<double> at{.rotation_a = Rotation<double>{}, .rotation_b = reference.rotation};
        at.offset = reference.offset + reference.rotation * centre_b - centre_a;
        PairMobility<double> pair = bodies;
        if constexpr (Rows::kGrounded) pair.m_a = pair.i_a = 0;
        return mobility_of(Rows(kind, centre_a, centre_b), rules_of(kind), at, pair);
      },
      definition);
}

SpringConstants spring_constants(const Spring& spring, double mobility) {
  if (!(mobility > 0)) return {};
  const double omega = kTwoPi * spring.hertz;
  return {.stiffness = omega * omega / mobility, .damping = 2 * spring.damping_ratio * omega / mobility};
}

JointStiffness joint_stiffness(const JointKind& definition, const SpringMobility& mobility) {
  const JointRules rules = std::visit([](const auto& kind) { return rules_of(kind); }, definition);
  JointStiffness out;
  bool any = false;
  const auto take = [&](const RowRule& rule, double of_row, double& stiffness, double& damping) {
    if (rule.role != RowRole::Spring) return;
    const SpringConstants constants = spring_constants(rule.spring, of_row);
    stiffness = constants.stiffness, damping = constants.damping;
    any = true;
  };
  for (int i = 0; i < rules.angular.count; ++i)
    take(rules.angular.rule[i], mobility.angular, out.angular, out.angular_damping);
  for (int i = 0; i < rules.axial[0].count; ++i)
    take(rules.axial[0].rule[i], mobility.axial, out.linear, out.linear_damping);
  take(rules.point, mobility.point, out.linear, out.linear_damping);
  if (!any)
    throw Error(Error::Kind::Unsupported, name_of(definition), "stiffness", "",
                "is nothing that this joint has: it has no spring");
  return out;
}

}  // namespace plumb
