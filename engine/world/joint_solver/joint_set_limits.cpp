#include <algorithm>
#include <atomic>

#include "engine/math/small_rotation.h"
#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {
namespace {

/// Returns the angle, rad, by which to rotate the joint so that no limit is exceeded by more than `slack`, or
/// than at the start of the step. An angle that began beyond a limit is left to the solver: contacts may hold
/// it there, which this rotation ignores, and continuous collision would undo it, and all other motion of the
/// body, in each step.
template <class Real>
Real project_angular_limits(const JointConstraint<Real, RevoluteRows>& joint, const SolverBody<Real>* motion,
                            Real slack) {
  const Real start = static_cast<Real>(joint.angle.start);
  const Real angle = start + (motion[joint.b].delta_angle - motion[joint.a].delta_angle);
  for (int i = 0; i < joint.angular.count; ++i) {
    const SolverRule<Real>& rule = joint.angular.rule[i];
    if (rule.role != RowRole::Limit) continue;
    const auto opening = [&](Real at) { return rule.sign * (at - rule.origin) + slack; };
    const Real open = opening(angle), least = std::min(opening(start), Real(0));
    if (open < least) return rule.sign * (least - open);
  }
  return 0;
}

template <class Real>
void apply_displacement(SolverBody<Real>& motion, Rotation<Real>& rotation, Vec2<Real> by, Real angle) {
  if (!(motion.inverse_mass + motion.inverse_inertia > 0)) return;
  motion.delta_position += by;
  motion.delta_angle += angle;
  rotation = rotated_by(rotation, angle);
}

/// Rotates b relative to a about their common point and closes the point's gap: one Newton step of all three
/// rows, on displacements instead of velocities.
template <class Real>
void rotate_joint(JointConstraint<Real, RevoluteRows>& joint, const SolverBodies<Real>& bodies,
                  Rotation<Real>* rotation, Real angle) {
  SolverBody<Real>&a = bodies.motion[joint.a], &b = bodies.motion[joint.b];
  JointRows<Real> rows;
  joint.kind.evaluate(joint.pose(bodies), rows);
  JointBlock<Real, 3> block;
  block.row[0] = rows.point.plain_row({1, 0});
  block.row[1] = rows.point.plain_row({0, 1});
  block.row[2] = {{}, {}, -1, 1, -angle};
  JointVelocities<Real> displacement(a, b);
  displacement.v_a = displacement.v_b = {}, displacement.w_a = displacement.w_b = 0;
  block.factorise(displacement);
  block.solve_unlimited(displacement, {.bias_rate = 1}, kSolve, Real(1), Real(1));
  apply_displacement(a, rotation[joint.a], displacement.v_a, displacement.w_a);
  apply_displacement(b, rotation[joint.b], displacement.v_b, displacement.w_b);
}

}  // namespace

template <class Real>
bool JointSet<Real>::began_beyond_limits(int joint, Real slack) const {
  bool beyond = false;
  parts_->at(joint, [&](const auto& constraint) {
    using Constraint = std::decay_t<decltype(constraint)>;
    if constexpr (Constraint::Rows::kAngular && Constraint::kAngle != AngleUse::None)
      beyond = constraint.limit_opening(0, slack) < 0;
  });
  return beyond;
}

template <class Real>
bool JointSet<Real>::project_angular_limits(const SolverBodies<Real>& bodies, Rotation<Real>* rotation,
                                            Real slack, Real max_rotation, LoopScheduler* scheduler) {
  using Hinge = JointConstraint<Real, RevoluteRows>;
  std::atomic<bool> any = false;
  auto& lists = std::get<kRevolute>(parts_->store);
  const auto project = [&](Hinge& joint) {
    const Real angle = plumb::project_angular_limits(joint, bodies.motion, slack);
    if (angle == 0) return;
    rotate_joint(joint, bodies, rotation, std::clamp(angle, -max_rotation, max_rotation));
    any.store(true, std::memory_order_relaxed);
  };
  for (const JointRun& run : parts_->runs) {
    if (run.form != kRevolute) continue;
    if constexpr (kHasLanes<Hinge>) {
      if (run.sorted) {
        auto& blocks = std::get<JointBlocks<Hinge>>(parts_->lanes);
        share_blocks(run, scheduler, [&](JointCounts first, JointCounts last) {
          if (first.blocks < last.blocks)
            blocks.beyond_limits(first.blocks, last.blocks, bodies.motion, slack, project);
          for (int i = first.singles; i < last.singles; ++i) project(blocks.single(i));
        });
        continue;
      }
    }
    auto& list = lists[run.colour];
    share_run(run, static_cast<int>(list.size()), scheduler, [&](int first, int last) {
      for (int i = first; i < last; ++i) project(list[i]);
    });
  }
  return any.load(std::memory_order_relaxed);
}

template bool JointSet<float>::began_beyond_limits(int, float) const;
template bool JointSet<double>::began_beyond_limits(int, double) const;
template bool JointSet<float>::project_angular_limits(const SolverBodies<float>&, Rotation<float>*, float,
                                                      float, LoopScheduler*);
template bool JointSet<double>::project_angular_limits(const SolverBodies<double>&, Rotation<double>*, double,
                                                       double, LoopScheduler*);

}  // namespace plumb
