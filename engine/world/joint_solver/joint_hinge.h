#pragma once

#include <utility>

#include "engine/joints/revolute_joint.h"
#include "engine/world/joint_solver/joint_point.h"
#include "engine/world/joint_solver/joint_share.h"

namespace plumb {

/// Arms and gap of a plain revolute joint, for scalars or for groups of four.
template <class Number>
struct HingeArms {
  Vec2<Number> a{}, b{};  ///< m, from the centres of mass to the middle of the gap: see AnchorPoint::middle
  Vec2<Number> gap{};     ///< m, anchor b minus anchor a
};

/// Computes them from the centres' offset at the start of the step, displacements, and the rotated anchors.
template <class Number>
[[gnu::always_inline]] inline HingeArms<Number> hinge_arms(Vec2<Number> offset, Vec2<Number> moved_a,
                                                           Vec2<Number> moved_b, Vec2<Number> to_a,
                                                           Vec2<Number> to_b) {
  const Vec2<Number> gap = offset + (moved_b - moved_a) + (to_b - to_a), half = Number(0.5f) * gap;
  return {to_a + half, to_b - half, gap};
}

/// Returns the impulse that removes the relative velocity of the anchors and part of the gap.
template <class Number, class Real>
[[gnu::always_inline]] inline Vec2<Number> soft_impulse(const Symmetric2<Number>& mass, Vec2<Number> rate,
                                                        Vec2<Number> gap, Vec2<Number> impulse, Number share,
                                                        const Softness<Real>& soft) {
  return -(Number(soft.mass_scale) * (mass * (rate + (share * Number(soft.bias_rate)) * gap)) +
           Number(soft.impulse_scale) * impulse);
}

/// Plain revolute joint, without limits, motor or spring: by far the most frequent one, and compact. Fields
/// are grouped in fours, so that four joints at a time load and store whole groups.
template <class Real>
struct alignas(16) HingeConstraint {
  Vec2<Real> anchor_a{}, anchor_b{};
  Vec2<Real> impulse{};
  Vec2<Real> gap{};  ///< m, anchor b minus anchor a
  Vec2<Real> arm_a{}, arm_b{};
  Symmetric2<Real> mass{};
  Real share = 1;       ///< under-relaxation factor of its impulses
  Vec2<Real> offset{};  ///< m, at the start of the step
  Real known_h = 0;     ///< unused: nothing here depends on it
  int joint = 0, a = 0, b = 0;
  bool held = false;   ///< solved elsewhere
  bool alone = false;  ///< not in groups of four: it is held, or one of its bodies is not dynamic

  using Definition = RevoluteDefinition;

  void load(const RevoluteDefinition& definition, Vec2d centre_a, Vec2d centre_b) {
    const RevoluteRows<Real> rows(definition, centre_a, centre_b);
    anchor_a = rows.anchor_a;
    anchor_b = rows.anchor_b;
  }

  void set_substep(const RevoluteDefinition&, Real h) { known_h = h; }
  void forget() { impulse = {}; }
  void put_elsewhere() { impulse = {}; }
  void meet(double, double) {}
  std::pair<Vec2<Real>, Real> reaction() const { return {impulse, 0}; }

  void prepare(const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
    alone = held || !is_dynamic(bodies.motion[a]) || !is_dynamic(bodies.motion[b]);
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
    const Vec2<Real> delta = soft_impulse(mass, v.at(arm_a, arm_b), gap, impulse, share, step.softness);
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

  JointLoad<Real> load(const SolverBodies<Real>& bodies) const {
    const BodyMotion<Real>&motion_a = bodies.motion[a], &motion_b = bodies.motion[b];
    return point_load(JointVelocities<Real>(motion_a, motion_b), arm_a, arm_b);
  }
  void evaluate(const SolverBodies<Real>& bodies, const JointStep<Real>&) {
    const BodyMotion<Real>&motion_a = bodies.motion[a], &motion_b = bodies.motion[b];
    evaluate(bodies, motion_a, motion_b, JointVelocities<Real>(motion_a, motion_b));
  }

 private:
  // Computes in local variables and writes once: a pair stored by halves and loaded as one would stall.
  [[gnu::always_inline]] void evaluate(const SolverBodies<Real>& bodies, const BodyMotion<Real>& motion_a,
                                       const BodyMotion<Real>& motion_b, const JointVelocities<Real>& v) {
    const HingeArms<Real> arms = hinge_arms(offset, motion_a.moved, motion_b.moved,
                                            bodies.rotation[a] * anchor_a, bodies.rotation[b] * anchor_b);
    gap.x = arms.gap.x, gap.y = arms.gap.y;
    arm_a.x = arms.a.x, arm_a.y = arms.a.y;
    arm_b.x = arms.b.x, arm_b.y = arms.b.y;
    const Symmetric2<Real> now = point_mass(v, arms.a, arms.b, share);
    mass.xx = now.xx, mass.xy = now.xy, mass.yy = now.yy;
  }
};

}  // namespace plumb
