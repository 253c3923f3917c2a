#include <type_traits>

#include "engine/solve/joint_parts.h"

namespace plumb {
namespace {

template <class Real>
struct RowList {
  std::vector<JointSolverRow<Real>>& rows;
  const JointVelocities<Real>& v;

  void add(JointRow<Real> row, SolverRule<Real>& rule) const {
    JointSolverRow<Real> out{.row = row, .role = rule.role, .speed = rule.speed, .most = rule.most};
    out.row.residual = rule.sign * (row.residual - rule.origin);
    if (rule.sign < 0) {
      out.row.linear_a = -row.linear_a, out.row.linear_b = -row.linear_b;
      out.row.angular_a = -row.angular_a, out.row.angular_b = -row.angular_b;
    }
    out.impulse = &rule.impulse;
    if (rule.role == RowRole::Spring) soften(out, rule.spring, v.inverse_mass(row, row));
    rows.push_back(out);
  }

  // lambda' = -mass (mass_scale (J v + rate C)) - impulse_scale lambda rests where J v + rate C + mobility
  // impulse_scale / mass_scale lambda = 0.
  static void soften(JointSolverRow<Real>& row, const Softness<Real>& spring, Real mobility) {
    row.rate = spring.bias_rate;
    row.compliance = spring.mass_scale > 0 ? mobility * spring.impulse_scale / spring.mass_scale : 0;
  }

  template <bool kAngular>
  void add(const JointRow<Real>& row, JointCoordinate<Real, kAngular>& coordinate) const {
    for (int i = 0; i < coordinate.count; ++i) add(row, coordinate.rule[i]);
  }

  void add_rigid(const JointRow<Real>& row, Real* impulse) const {
    rows.push_back({.row = row, .role = RowRole::Rigid, .impulse = impulse});
  }

  void add(const AnchorPoint<Real>& at, JointPoint<Real>& point) const {
    const PointResponse<Real> response = point_response(v, at.arm_a, at.arm_b);
    for (const Vec2<Real> n : {Vec2<Real>{1, 0}, Vec2<Real>{0, 1}}) {
      JointSolverRow<Real> out{.row = at.plain_row(n), .role = point.rule.role, .most = point.rule.most};
      out.pair = n.y != 0;
      out.impulse = out.pair ? &point.impulse.y : &point.impulse.x;
      if (point.rule.role == RowRole::Spring) {
        soften(out, point.rule.spring, out.pair ? response.yy : response.xx);
        if (out.pair && point.rule.spring.mass_scale > 0)
          out.coupled_compliance =
              response.xy * point.rule.spring.impulse_scale / point.rule.spring.mass_scale;
      }
      rows.push_back(out);
    }
  }
};

template <class Real>
void add_rows(HingeConstraint<Real>& hinge, const SolverBodies<Real>& bodies,
              std::vector<JointSolverRow<Real>>& rows) {
  const BodyMotion<Real>&a = bodies.motion[hinge.a], &b = bodies.motion[hinge.b];
  const HingeArms<Real> arms =
      hinge_arms(hinge.offset, a.moved, b.moved, bodies.rotation[hinge.a] * hinge.anchor_a,
                 bodies.rotation[hinge.b] * hinge.anchor_b);
  const AnchorPoint<Real> at{arms.a, arms.b, arms.gap};
  const JointVelocities<Real> v(a, b);
  const RowList<Real> list{rows, v};
  list.add_rigid(at.plain_row({1, 0}), &hinge.impulse.x);
  list.add_rigid(at.plain_row({0, 1}), &hinge.impulse.y);
}

template <class Real, template <class> class Kind>
void add_rows(JointConstraint<Real, Kind>& joint, const SolverBodies<Real>& bodies,
              std::vector<JointSolverRow<Real>>& rows) {
  using Constraint = JointConstraint<Real, Kind>;
  JointVelocities<Real> v(bodies.motion[joint.a], bodies.motion[joint.b]);
  if constexpr (Constraint::kOneBody) v.v_a = {}, v.w_a = 0, v.m_a = 0, v.i_a = 0;
  const std::size_t first = rows.size();
  const RowList<Real> list{rows, v};
  const JointPose<Real> at = joint.pose(bodies);
  JointRows<Real> now;
  joint.kind.evaluate(at, now);
  if constexpr (Kind<Real>::kTurn) list.add({{}, {}, -1, 1, at.angle}, joint.turn);
  for (int i = 0; i < Constraint::kAxial; ++i) list.add(now.axial[i], joint.axial[i]);
  if constexpr (Constraint::kBlock > 0)
    for (int i = 0; i < Constraint::kBlock; ++i) list.add_rigid(now.block[i], &joint.block.impulse[i]);
  if constexpr (Kind<Real>::kPoint) list.add(now.point, joint.point);
  if constexpr (Constraint::kOneBody)
    for (std::size_t i = first; i < rows.size(); ++i) rows[i].row.linear_a = {}, rows[i].row.angular_a = 0;
}

template <class Real>
bool is_open(const AnchorPoint<Real>& at, Real share) {
  const Real most = share * share * (length_squared(at.arm_a) + length_squared(at.arm_b));
  return length_squared(at.gap) > most;
}

}  // namespace

template <class Real>
bool JointSet<Real>::is_loose(int joint, Real share) const {
  return parts_->at(joint, [&]<class Constraint>(const Constraint& constraint) {
    if (constraint.share < 1) return true;
    if constexpr (requires { constraint.arm_a; }) {
      return is_open(AnchorPoint<Real>{constraint.arm_a, constraint.arm_b, constraint.gap}, share);
    } else if constexpr (std::is_same_v<Constraint, JointConstraint<Real, RevoluteRows>>) {
      return is_open(constraint.point.point, share);
    } else {
      return true;
    }
  });
}

template bool JointSet<float>::is_loose(int, float) const;
template bool JointSet<double>::is_loose(int, double) const;

template <class Real>
void JointSet<Real>::solver_rows(int joint, const SolverBodies<Real>& bodies,
                                 std::vector<JointSolverRow<Real>>& rows) {
  parts_->at(joint, [&](auto& constraint) { add_rows(constraint, bodies, rows); });
}

template void JointSet<float>::solver_rows(int, const SolverBodies<float>&,
                                           std::vector<JointSolverRow<float>>&);
template void JointSet<double>::solver_rows(int, const SolverBodies<double>&,
                                            std::vector<JointSolverRow<double>>&);

}  // namespace plumb
