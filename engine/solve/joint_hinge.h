#pragma once

#include <utility>

#include "engine/joints/revolute_joint.h"
#include "engine/solve/joint_point.h"
#include "engine/solve/joint_share.h"

namespace plumb {

/// The plain revolute joint, without limits, motor or spring: by far the most frequent one, and compact.
template <class Real>
struct HingeConstraint {
  int joint = 0, a = 0, b = 0;
  bool held = false;  ///< another solves it
  Real share = 1;     ///< of its impulses that it applies at a time
  Real known_h = 0;   ///< nothing here depends on it
  Vec2<Real> anchor_a{}, anchor_b{};
  Vec2<Real> offset{};  ///< m, at the step's start
  Vec2<Real> impulse{};
  Vec2<Real> arm_a{}, arm_b{};
  Vec2<Real> gap{};  ///< m, anchor b less anchor a
  Symmetric2<Real> mass{};

  using Definition = RevoluteDefinition;

  void load(const RevoluteDefinition& definition, Vec2d centre_a, Vec2d centre_b) {
    const RevoluteRows<Real> rows(definition, centre_a, centre_b);
    anchor_a = rows.anchor_a;
    anchor_b = rows.anchor_b;
  }

  void set_substep(const RevoluteDefinition&, Real h) { known_h = h; }
  void forget() { impulse = {}; }
  std::pair<Vec2<Real>, Real> reaction() const { return {impulse, 0}; }

  void prepare(const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
    if (held) return;
    offset = (bodies.position[b] - bodies.position[a]).template as<Real>();
    impulse *= step.warm_start;
    evaluate(bodies, step);
  }

  void warm_start(const SolverBodies<Real>& bodies) const {
    if (held) return;
    BodyMotion<Real>&motion_a = bodies.motion[a], &motion_b = bodies.motion[b];
    JointVelocities<Real> v(motion_a, motion_b);
    v.apply(impulse, arm_a, arm_b);
    v.store(motion_a, motion_b);
  }

  void solve(const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
    if (held) return;
    BodyMotion<Real>&motion_a = bodies.motion[a], &motion_b = bodies.motion[b];
    JointVelocities<Real> v(motion_a, motion_b);
    const Vec2<Real> delta =
        -(step.softness.mass_scale * (mass * (v.at(arm_a, arm_b) + (share * step.softness.bias_rate) * gap)) +
          step.softness.impulse_scale * impulse);
    impulse += delta;
    v.apply(delta, arm_a, arm_b);
    v.store(motion_a, motion_b);
  }

  void relax(const SolverBodies<Real>& bodies, const JointStep<Real>&) {
    if (held) return;
    BodyMotion<Real>&motion_a = bodies.motion[a], &motion_b = bodies.motion[b];
    JointVelocities<Real> v(motion_a, motion_b);
    evaluate(bodies, motion_a, motion_b, v);
    const Vec2<Real> delta = -(mass * v.at(arm_a, arm_b));
    impulse += delta;
    v.apply(delta, arm_a, arm_b);
    v.store(motion_a, motion_b);
  }

  JointMobility<Real> mobility(const SolverBodies<Real>& bodies) const {
    const BodyMotion<Real>&motion_a = bodies.motion[a], &motion_b = bodies.motion[b];
    return point_mobility(JointVelocities<Real>(motion_a, motion_b), arm_a, arm_b);
  }
  void evaluate(const SolverBodies<Real>& bodies, const JointStep<Real>&) {
    const BodyMotion<Real>&motion_a = bodies.motion[a], &motion_b = bodies.motion[b];
    evaluate(bodies, motion_a, motion_b, JointVelocities<Real>(motion_a, motion_b));
  }

 private:
  // In numbers of its own, written once: a pair that is stored by halves and loaded as one stalls.
  [[gnu::always_inline]] void evaluate(const SolverBodies<Real>& bodies, const BodyMotion<Real>& motion_a,
                                       const BodyMotion<Real>& motion_b, const JointVelocities<Real>& v) {
    const Vec2<Real> to_a = bodies.rotation[a] * anchor_a, to_b = bodies.rotation[b] * anchor_b;
    const Real gap_x = offset.x + (motion_b.moved.x - motion_a.moved.x) + (to_b.x - to_a.x);
    const Real gap_y = offset.y + (motion_b.moved.y - motion_a.moved.y) + (to_b.y - to_a.y);
    // Both arms lead to the middle of the gap, as AnchorPoint::middle says.
    const Real half_x = Real(0.5) * gap_x, half_y = Real(0.5) * gap_y;
    const Vec2<Real> new_a{to_a.x + half_x, to_a.y + half_y}, new_b{to_b.x - half_x, to_b.y - half_y};
    gap.x = gap_x, gap.y = gap_y;
    arm_a.x = new_a.x, arm_a.y = new_a.y;
    arm_b.x = new_b.x, arm_b.y = new_b.y;
    const Symmetric2<Real> now = point_mass(v, new_a, new_b, share);
    mass.xx = now.xx, mass.xy = now.xy, mass.yy = now.yy;
  }
};

}  // namespace plumb
