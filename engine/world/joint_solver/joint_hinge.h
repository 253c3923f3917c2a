#pragma once

#include <cstdint>
#include <utility>

#include "engine/joints/revolute_joint.h"
#include "engine/world/joint_solver/joint_point.h"
#include "engine/world/joint_solver/joint_share.h"

namespace plumb {

/// Arms and gap of a plain revolute joint.
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
template <class Number>
[[gnu::always_inline]] inline Vec2<Number> soft_impulse(const Symmetric2<Number>& mass, Vec2<Number> rate,
                                                        Vec2<Number> gap, Vec2<Number> impulse, Number share,
                                                        const Softness<Scalar<Number>>& soft) {
  return -(Number(soft.mass_scale) * (mass * (rate + (share * Number(soft.bias_rate)) * gap)) +
           Number(soft.impulse_scale) * impulse);
}

/// Plain revolute joint, without limits, motor or spring: by far the most frequent one, and compact.
template <class Real>
struct HingeConstraint {
  using Definition = RevoluteDefinition;
  static constexpr bool kOneBody = false;
  using Step = JointStep<Scalar<Real>>;

  Vec2<Real> anchor_a{}, anchor_b{};
  Vec2<Real> impulse{};
  Vec2<Real> gap{};  ///< m, anchor b minus anchor a
  Vec2<Real> arm_a{}, arm_b{};
  Symmetric2<Real> mass{};
  Real share = 1;            ///< under-relaxation factor of its impulses
  Vec2<Real> offset{};       ///< m, at the start of the step
  Scalar<Real> known_h = 0;  ///< unused: nothing here depends on it
  int joint = 0, a = 0, b = 0;
  bool held = false;   ///< solved elsewhere
  bool alone = false;  ///< see JointConstraint; unused

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

  void begin_step(const SolverBodies<Real>& bodies, const Step& step) {
    if (held) return;
    offset = (bodies.position[b] - bodies.position[a]).template as<Real>();
    impulse *= step.warm_start;
  }
  void end_step(const SolverBodies<Real>&) {}
  JointLoad<Real> load(const JointVelocities<Real>& v) const { return point_load(v, arm_a, arm_b); }

  // ---- What a substep computes; of Lanes for several joints side by side

  /// Computes in local variables and writes once: a pair stored by halves and loaded as one would stall.
  [[gnu::always_inline]] void evaluate(const JointMotion<Real>& now, const JointVelocities<Real>& v,
                                       const Step&, JointTime) {
    const HingeArms<Real> arms =
        hinge_arms(offset, now.moved_a, now.moved_b, rotated(now.rotation_a, anchor_a),
                   rotated(now.rotation_b, anchor_b));
    gap.x = arms.gap.x, gap.y = arms.gap.y;
    arm_a.x = arms.a.x, arm_a.y = arms.a.y;
    arm_b.x = arms.b.x, arm_b.y = arms.b.y;
    const Symmetric2<Real> response = point_mass(v, arms.a, arms.b, share);
    mass.xx = response.xx, mass.xy = response.xy, mass.yy = response.yy;
  }
  [[gnu::always_inline]] void warm_start(JointVelocities<Real>& v) const { v.apply(impulse, arm_a, arm_b); }
  [[gnu::always_inline]] void solve(JointVelocities<Real>& v, const Step& step) {
    const Vec2<Real> delta = soft_impulse(mass, v.at(arm_a, arm_b), gap, impulse, share, step.softness);
    impulse += delta;
    v.apply(delta, arm_a, arm_b);
  }
  [[gnu::always_inline]] void relax(const JointMotion<Real>& now, JointVelocities<Real>& v,
                                    const Step& step) {
    evaluate(now, v, step, JointTime::SubstepEnds);
    const Vec2<Real> delta = -(mass * v.at(arm_a, arm_b));
    impulse += delta;
    v.apply(delta, arm_a, arm_b);
  }

  // ---- Of a block of joints side by side (joint_lanes.h)

  std::uint64_t lane_kind() const { return 0; }
  bool fits_lanes() const { return true; }
  void take_kind(const HingeConstraint<Scalar<Real>>&) {}
  /// Visits the numbers that a step starts with, of a block and of one of its joints.
  template <class One, class Visit>
  [[gnu::always_inline]] void inputs(One& one, const Visit& visit) {
    visit(anchor_a.x, one.anchor_a.x), visit(anchor_a.y, one.anchor_a.y);
    visit(anchor_b.x, one.anchor_b.x), visit(anchor_b.y, one.anchor_b.y);
    visit(offset.x, one.offset.x), visit(offset.y, one.offset.y);
    visit(impulse.x, one.impulse.x), visit(impulse.y, one.impulse.y);
  }
  /// Visits likewise the numbers that are read after a step.
  template <class One, class Visit>
  [[gnu::always_inline]] void results(One& one, const Visit& visit) {
    visit(impulse.x, one.impulse.x), visit(impulse.y, one.impulse.y);
    visit(arm_a.x, one.arm_a.x), visit(arm_a.y, one.arm_a.y);
    visit(arm_b.x, one.arm_b.x), visit(arm_b.y, one.arm_b.y);
  }
};

/// True for plain hinges.
template <class Constraint>
constexpr bool kIsHinge = false;
template <class Real>
constexpr bool kIsHinge<HingeConstraint<Real>> = true;

}  // namespace plumb
