#include <algorithm>
#include <cmath>

#include "engine/joints/joint_check.h"
#include "engine/scene/error.h"
#include "engine/world/joint_solver/joint_parts.h"

/// Queries of a set of joints.
namespace plumb {
namespace {

/// Returns the error of a rule with its coordinate at `q`.
template <class Real>
Real error_of(const SolverRule<Real>& rule, Real q) {
  const Real c = rule.sign * (q - rule.origin);
  if (rule.role == RowRole::Rigid) return std::fabs(c);
  return rule.role == RowRole::Limit ? std::max(Real{0}, -c) : 0;
}

template <class Real, bool kAngular>
Real error_of(const JointCoordinate<Real, kAngular>& coordinate, Real q) {
  Real largest = 0;
  for (int i = 0; i < coordinate.count; ++i) largest = std::max(largest, error_of(coordinate.rule[i], q));
  return largest;
}

template <class Real, template <class> class Kind>
JointError<Real> error_of(const JointConstraint<Real, Kind>& constraint, const SolverBodies<Real>& bodies) {
  using Constraint = JointConstraint<Real, Kind>;
  using Rows = typename Constraint::Rows;
  const auto [pose, rows] = constraint.current(bodies);
  JointError<Real> error;
  // A rope without a length, and a ratchet, get their rules in the first step.
  if constexpr (Constraint::kRatchet || Constraint::kPulley)
    if (constraint.memory.known == 0) return error;
  if constexpr (Rows::kAngular) error.angular = error_of(constraint.angular, pose.angle);
  for (int i = 0; i < Constraint::kAxial; ++i) {
    const Real e = error_of(constraint.axial[i], rows.axial[i].residual);
    // A gear's coordinate is an angle.
    Real& part = Constraint::kAngle == AngleUse::Geared ? error.angular : error.linear;
    part = std::max(part, e);
  }
  if constexpr (Constraint::kBlock > 0) {
    error.angular = std::fabs(rows.block[0].residual);
    Real across = 0;
    for (int i = 1; i < Constraint::kBlock; ++i) across += rows.block[i].residual * rows.block[i].residual;
    error.linear = std::max(error.linear, std::sqrt(across));
  }
  if constexpr (Rows::kPoint)
    if (constraint.point.rigid()) error.linear = std::sqrt(length_squared(rows.point.gap));
  return error;
}

[[noreturn]] void refuse(const JointKind& definition, const char* what) {
  throw Error(Error::Kind::Unsupported, name_of(definition), what, "", "is nothing that this joint has");
}

}  // namespace

template <class Real>
Real JointSet<Real>::force(int joint) const {
  const Vec2<Real> mean = parts_->at(joint, [](const auto& c) { return c.mean_force; });
  // In double, because the square of a large force overflows float.
  return static_cast<Real>(std::sqrt(length_squared(mean.template as<double>())));
}

template <class Real>
Real JointSet<Real>::torque(int joint) const {
  return parts_->at(joint, []<class Constraint>(const Constraint& c) -> Real {
    if constexpr (Constraint::kHasTorque) return std::fabs(c.mean_torque);
    return 0;
  });
}

template <class Real>
JointError<Real> JointSet<Real>::error(int joint, const SolverBodies<Real>& bodies) const {
  return parts_->at(joint, [&](const auto& constraint) { return error_of(constraint, bodies); });
}

template <class Real>
Real JointSet<Real>::angle(int joint, const SolverBodies<Real>& bodies) const {
  const JointSlot& s = parts_->slot(joint);
  return parts_->at(joint, [&]<class Constraint>(const Constraint& constraint) -> Real {
    if constexpr (Constraint::kPlainHinge) {
      const double angle = relative_angle(bodies.rotation[s.a], bodies.rotation[s.b]);
      return static_cast<Real>(
          unwrap_angle(angle - std::get<RevoluteDefinition>(s.definition).reference_angle, 0));
    } else if constexpr (Constraint::kAngle == AngleUse::Counted) {
      return constraint.current(bodies).first.angle;
    } else {
      refuse(s.definition, "angle");
    }
  });
}

template <class Real>
JointStiffness JointSet<Real>::stiffness(int joint, Vec2<Real> centre_a, Vec2<Real> centre_b,
                                         const PairMobility<Real>& bodies) const {
  const JointSlot& s = parts_->slot(joint);
  return joint_stiffness(s.definition,
                         s.springs(centre_a.template as<double>(), centre_b.template as<double>(), bodies));
}

template <class Real>
Real JointSet<Real>::translation(int joint, const SolverBodies<Real>& bodies) const {
  const JointSlot& s = parts_->slot(joint);
  if (s.form != kPrismatic && s.form != kWheel) refuse(s.definition, "translation");
  return parts_->at(
      joint, [&](const auto& constraint) { return constraint.current(bodies).second.axial[0].residual; });
}

template <class Real>
Real JointSet<Real>::length(int joint, const SolverBodies<Real>& bodies) const {
  const JointSlot& s = parts_->slot(joint);
  if (s.form != kDistance && s.form != kPulley) refuse(s.definition, "length");
  return parts_->at(
      joint, [&](const auto& constraint) { return constraint.current(bodies).second.axial[0].residual; });
}

template float JointSet<float>::force(int) const;
template float JointSet<float>::torque(int) const;
template JointError<float> JointSet<float>::error(int, const SolverBodies<float>&) const;
template float JointSet<float>::angle(int, const SolverBodies<float>&) const;
template JointStiffness JointSet<float>::stiffness(int, Vec2<float>, Vec2<float>,
                                                   const PairMobility<float>&) const;
template float JointSet<float>::translation(int, const SolverBodies<float>&) const;
template float JointSet<float>::length(int, const SolverBodies<float>&) const;
template double JointSet<double>::force(int) const;
template double JointSet<double>::torque(int) const;
template JointError<double> JointSet<double>::error(int, const SolverBodies<double>&) const;
template double JointSet<double>::angle(int, const SolverBodies<double>&) const;
template JointStiffness JointSet<double>::stiffness(int, Vec2<double>, Vec2<double>,
                                                    const PairMobility<double>&) const;
template double JointSet<double>::translation(int, const SolverBodies<double>&) const;
template double JointSet<double>::length(int, const SolverBodies<double>&) const;

}  // namespace plumb
