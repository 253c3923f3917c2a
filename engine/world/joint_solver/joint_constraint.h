#pragma once

#include <algorithm>
#include <array>
#include <type_traits>

#include "engine/joints/joint_angle.h"
#include "engine/joints/pulley_joint.h"
#include "engine/joints/ratchet_joint.h"
#include "engine/joints/spring_mobility.h"
#include "engine/world/joint_solver/joint_block.h"
#include "engine/world/joint_solver/joint_coordinate.h"
#include "engine/world/joint_solver/joint_point.h"
#include "engine/world/joint_solver/joint_share.h"

namespace plumb {

/// Placeholder for a part that a kind lacks.
template <int>
struct NoPart {};

/// A joint of kind `Kind`, prepared for solving. Only the parts that the kind has take memory. They are
/// solved in the order turn, axial, block, point, so that rigid rows hold best.
template <class Real, template <class> class Kind>
struct JointConstraint {
  using Rows = Kind<Real>;
  using Definition = typename Rows::Definition;
  static constexpr AngleUse kAngle = Rows::kAngle;
  static constexpr bool kRatchet = std::is_same_v<Rows, RatchetRows<Real>>;
  static constexpr bool kPulley = std::is_same_v<Rows, PulleyRows<Real>>;
  /// Mouse joint only: body a takes no part.
  static constexpr bool kOneBody = Rows::kGrounded && !kPulley;
  static constexpr int kAxial = Rows::kAxial, kBlock = Rows::kBlock;
  template <bool kHas, class Part, int kTag>
  using If = std::conditional_t<kHas, Part, NoPart<kTag>>;

  int joint = 0, a = 0, b = 0;
  Real share = 1;                   ///< under-relaxation factor of its impulses
  bool alone = false;               ///< no other joint moves its bodies
  Real known_h = 0;                 ///< s, substep length that the rules are set for
  Vec2<Real> offset{}, offset_a{};  ///< m, at the start of the step
  Vec2<Real> arm_b{};
  Rows kind{};
  [[no_unique_address]] If<kAngle != AngleUse::None, JointAngle, 0> angle{};
  [[no_unique_address]] If<kRatchet || kPulley, JointMemory, 1> memory{};
  [[no_unique_address]] If<Rows::kTurn, JointCoordinate<Real, true>, 2> turn{};
  std::array<JointCoordinate<Real, false>, kAxial> axial{};
  [[no_unique_address]] If<(kBlock > 0), JointBlock<Real, kBlock>, 3> block{};
  [[no_unique_address]] If<Rows::kPoint, JointPoint<Real>, 4> point{};

  /// Loads the definition's parameters; keeps impulses and memory that are still valid.
  void load(const Definition& definition, Vec2d centre_a, Vec2d centre_b) {
    const Rows last = kind;
    const Range last_limits = limits();
    kind = Rows(definition, centre_a, centre_b);
    const JointRules rules = rules_of(definition);
    if constexpr (Rows::kTurn) turn.load(rules.turn);
    if constexpr (kAngle != AngleUse::None) {
      if (kind.reference != last.reference) {
        angle.count = TurnCount::Born;
      } else if (angle.count == TurnCount::Counted && !(limits() == last_limits)) {
        angle.count = TurnCount::Limited;
      }
    }
    for (int i = 0; i < kAxial; ++i) axial[i].load(rules.axial[i]);
    if constexpr (Rows::kPoint) point.load(rules.point);
    if constexpr (kRatchet) {
      if (kind.reference != last.reference || kind.tooth != last.tooth) memory = {};
    }
    if constexpr (kPulley) {
      // A given length may differ from the placed one.
      if (definition.length) memory = {*definition.length, 1};
    }
    known_h = 0;
  }

  /// Sets springs and bounds for substeps of h, s.
  void set_substep(const Definition& definition, Real h) {
    const JointRules rules = rules_of(definition);
    if constexpr (Rows::kTurn) turn.set_substep(rules.turn, h);
    for (int i = 0; i < kAxial; ++i) axial[i].set_substep(rules.axial[i], h);
    if constexpr (Rows::kPoint) point.set_substep(rules.point, h);
    known_h = h;
  }

  void prepare(const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
    offset = find_offset(bodies, b);
    if constexpr (kPulley) offset_a = find_offset_a(bodies);
    if constexpr (kAngle != AngleUse::None) count_turns(bodies, step.h);
    if constexpr (kRatchet) {
      const double tooth = kind.tooth_at(angle.start);
      if (memory.known == 0) memory = {tooth, 1};
    }
    if constexpr (kPulley) recall_length(bodies);
    if (step.warm_start != 1) scale(step.warm_start);
    evaluate(bodies, step, When::StepStarts);
  }

  /// Time of an evaluation. Motors add up their drift from the start of the step over each substep.
  enum class When { StepStarts, SubstepEnds, Between };
  /// Evaluates all rows at the present poses.
  void evaluate(const SolverBodies<Real>& bodies, const JointStep<Real>& step, When when = When::Between) {
    const JointVelocities<Real> v = velocities(bodies);
    JointRows<Real> rows;
    const JointPose<Real> at = pose(bodies);
    if constexpr (kRatchet) click(at.angle);
    kind.evaluate(at, rows);
    arm_b = rows.arm_b;
    if (when != When::Between) follow(bodies, rows, when, step.h);
    evaluate_coordinates(at, rows, v, step, {share, alone});
    if constexpr (kBlock > 0) {
      for (int i = 0; i < kBlock; ++i) block.row[i] = rows.block[i];
      block.factorise(v);
    }
  }

  void follow(const SolverBodies<Real>& bodies, const JointRows<Real>& rows, When when, Real h) {
    const bool starts = when == When::StepStarts;
    const auto see = [starts, h](auto& coordinate, Real q) {
      starts ? coordinate.start_at(q) : coordinate.follow(q, h);
    };
    // Rotation since the step began (0 at that time), because the angle may have many turns.
    if constexpr (Rows::kTurn) see(turn, bodies.motion[b].turned - bodies.motion[a].turned);
    for (int i = 0; i < kAxial; ++i) see(axial[i], rows.axial[i].residual);
    if constexpr (Rows::kPoint)
      if (!starts) point.follow(rows.point.gap);
  }

  /// Evaluates turn, axial and point rows at a pose; `at.angle` and the residuals are the coordinates.
  void evaluate_coordinates(const JointPose<Real>& at, const JointRows<Real>& rows,
                            const JointVelocities<Real>& v, const JointStep<Real>& step,
                            JointShare<Real> part) {
    if constexpr (Rows::kTurn) {
      if (turn_beside_rigid()) {
        turn.evaluate_beside_rigid(at.angle, v, turn_spring_mobility(v, rows), step, part);
      } else {
        turn.evaluate(at.angle, v, step, part);
      }
    }
    for (int i = 0; i < kAxial; ++i) axial[i].row = rows.axial[i];
    for (int i = 0; i < kAxial; ++i) {
      if (i == 0 && axial_beside_rigid()) {
        axial[i].evaluate_beside_rigid(rows.axial[i].residual, v, axial_spring_mobility(v, at, rows), step,
                                       part);
      } else {
        axial[i].evaluate(rows.axial[i].residual, v, step, part);
      }
    }
    if constexpr (Rows::kPoint) {
      if (point_beside_rigid()) {
        point.evaluate_beside_rigid(rows.point, v, point_spring_mobility(v, rows), step, part);
      } else {
        point.evaluate(rows.point, v, step, part);
      }
    }
  }

  // Springs beside rigid rows of the joint refer to their effective mass given these: see
  // engine/joints/spring_mobility.h.
  /// Returns true if the angle has a spring beside a rigid point.
  bool turn_beside_rigid() const {
    if constexpr (Rows::kTurn && Rows::kPoint) return point.rigid() && turn.has(RowRole::Spring);
    return false;
  }
  /// Returns true if the first axial coordinate has a spring beside a rigid block or second coordinate.
  bool axial_beside_rigid() const {
    if constexpr (kAxial > 0 && (kBlock > 0 || kAxial > 1)) return axial[0].has(RowRole::Spring);
    return false;
  }
  /// Returns true if the point has a spring beside a rigid angle.
  bool point_beside_rigid() const {
    if constexpr (Rows::kTurn && Rows::kPoint)
      return point.rule.role == RowRole::Spring && turn.has(RowRole::Rigid);
    return false;
  }
  Real turn_spring_mobility(const JointVelocities<Real>& v, const JointRows<Real>& rows) const {
    return turning_mobility<Real>({v.m_a, v.i_a, v.m_b, v.i_b}, rows.point.arm_a, rows.point.arm_b);
  }
  Real axial_spring_mobility(const JointVelocities<Real>& v, const JointPose<Real>& at,
                             const JointRows<Real>& rows) const {
    const PairMobility<Real> pair{v.m_a, v.i_a, v.m_b, v.i_b};
    const JointRow<Real>& first = rows.axial[0];
    if constexpr (kAxial > 1) {
      const JointRow<Real>& second = rows.axial[1];
      return line_mobility(pair, first.angular_a, first.angular_b, second.angular_a, second.angular_b);
    } else {
      return sliding_mobility(pair, at.offset, first.linear_b);
    }
  }
  Symmetric2<Real> point_spring_mobility(const JointVelocities<Real>& v, const JointRows<Real>& rows) const {
    const PairMobility<Real> pair{v.m_a, v.i_a, v.m_b, v.i_b};
    const Real m = v.m_a + v.m_b, turn_together = common_turning(pair);
    const Vec2<Real> p = perpendicular(rows.point.arm_b - rows.point.arm_a);
    return {m + turn_together * p.x * p.x, turn_together * p.x * p.y, m + turn_together * p.y * p.y};
  }

  /// Returns the load of the present rows.
  JointLoad<Real> load(const SolverBodies<Real>& bodies) const {
    constexpr int kRows = kAxial + kBlock + (Rows::kPoint ? 2 : 0) + (Rows::kTurn ? 1 : 0);
    JointRow<Real> rows[kRows];
    int count = 0;
    if constexpr (Rows::kTurn)
      rows[count++] = {{}, {}, turn.count > 0 ? Real(-1) : 0, turn.count > 0 ? Real(1) : 0};
    for (int i = 0; i < kAxial; ++i) rows[count++] = axial[i].count > 0 ? axial[i].row : JointRow<Real>{};
    if constexpr (kBlock > 0)
      for (const JointRow<Real>& row : block.row) rows[count++] = row;
    if constexpr (Rows::kPoint)
      for (const Vec2<Real> n : {Vec2<Real>{1, 0}, Vec2<Real>{0, 1}})
        rows[count++] = point.point.plain_row(n);
    return joint_load(rows, velocities(bodies));
  }

  void warm_start(const SolverBodies<Real>& bodies) const {
    JointVelocities<Real> v = velocities(bodies);
    if constexpr (Rows::kTurn) turn.warm_start(v);
    for (int i = 0; i < kAxial; ++i) axial[i].warm_start(v);
    if constexpr (kBlock > 0) block.warm_start(v);
    if constexpr (Rows::kPoint) point.warm_start(v);
    store(v, bodies);
  }

  void pass(const SolverBodies<Real>& bodies, const JointStep<Real>& step, JointPass which) {
    JointVelocities<Real> v = velocities(bodies);
    solve_coordinates(v, step, which, share);
    store(v, bodies);
  }

  /// Solves all rows once. Rigid rows beside a spring are solved before and after it: the spring then sees
  /// the velocity that they leave, and its response includes them.
  void solve_coordinates(JointVelocities<Real>& v, const JointStep<Real>& step, JointPass which, Real part) {
    if (turn_beside_rigid()) solve_point(v, which);
    if (point_beside_rigid()) solve_turn(v, which), solve_point(v, which);
    if (axial_beside_rigid()) {
      for (int i = 1; i < kAxial; ++i) axial[i].solve(v, which);
      solve_block(v, step, which, part);
    }
    solve_turn(v, which);
    for (int i = 0; i < kAxial; ++i) axial[i].solve(v, which);
    solve_block(v, step, which, part);
    if (!point_beside_rigid()) solve_point(v, which);
  }
  void solve(const SolverBodies<Real>& bodies, const JointStep<Real>& step) { pass(bodies, step, kSolve); }
  void relax(const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
    evaluate(bodies, step, When::SubstepEnds);
    pass(bodies, step, kRelax);
  }

  /// Returns the present pose; counts turns on.
  JointPose<Real> pose(const SolverBodies<Real>& bodies) {
    const BodyMotion<Real>&motion_a = bodies.motion[a], &motion_b = bodies.motion[b];
    JointPose<Real> at{.rotation_a = bodies.rotation[a], .rotation_b = bodies.rotation[b]};
    if constexpr (Rows::kGrounded) {
      at.offset = offset + motion_b.moved;
      at.offset_a = offset_a + motion_a.moved;
    } else {
      at.offset = offset + (motion_b.moved - motion_a.moved);
    }
    if constexpr (kAngle == AngleUse::Geared) {
      at.angle = static_cast<Real>(angle.start) + (motion_b.turned - kind.ratio * motion_a.turned);
      angle.a = angle.start_a + motion_a.turned;
      angle.b = angle.start_b + motion_b.turned;
    } else if constexpr (kAngle != AngleUse::None) {
      const Real turned = motion_b.turned - motion_a.turned;
      at.angle = static_cast<Real>(angle.start) + turned;
      angle.b = angle.start_b + turned;
    }
    return at;
  }

  /// Returns the present pose and rows, at any time; counts turns from the last evaluation.
  std::pair<JointPose<Real>, JointRows<Real>> look(const SolverBodies<Real>& bodies) const {
    JointConstraint now = *this;
    const Vec2<Real> moved_a = bodies.motion[a].moved, moved_b = bodies.motion[b].moved;
    JointPose<Real> at{.rotation_a = bodies.rotation[a], .rotation_b = bodies.rotation[b]};
    at.offset = find_offset(bodies, b) + (Rows::kGrounded ? moved_b : moved_b - moved_a);
    if constexpr (kPulley) at.offset_a = find_offset_a(bodies) + moved_a;
    if constexpr (kAngle != AngleUse::None) {
      now.count_turns(bodies, 0);
      at.angle = static_cast<Real>(now.angle.start);
    }
    JointRows<Real> rows;
    kind.evaluate(at, rows);
    return {at, rows};
  }

  /// Returns the linear impulse on b, and the angular one about the end of `arm_b`.
  std::pair<Vec2<Real>, Real> reaction() const {
    Vec2<Real> linear{};
    Real angular = 0;
    const auto count = [&](const JointRow<Real>& row, Real impulse) {
      linear += impulse * row.linear_b;
      angular += impulse * (row.angular_b - cross(arm_b, row.linear_b));
    };
    if constexpr (Rows::kTurn) angular += turn.impulse();
    for (int i = 0; i < kAxial; ++i) count(axial[i].row, axial[i].impulse());
    if constexpr (kBlock > 0)
      for (int i = 0; i < kBlock; ++i) count(block.row[i], block.impulse[i]);
    if constexpr (Rows::kPoint) linear += point.impulse;
    return {linear, angular};
  }

  /// Clears impulses and counts.
  void forget() {
    scale(0);
    if constexpr (kAngle != AngleUse::None) angle = {};
    if constexpr (kRatchet) memory = {};
  }
  /// Clears impulses and keeps counted turns, because a pose does not contain them.
  void put_elsewhere() {
    scale(0);
    if constexpr (kRatchet) memory = {};
  }
  /// Sets the bodies' own angles, rad, with their turns, for gears that are not counted yet.
  void meet(double angle_a, double angle_b) {
    if constexpr (kAngle == AngleUse::Geared)
      if (angle.count == TurnCount::Born) angle.a = angle_a, angle.b = angle_b;
  }

 private:
  void solve_turn(JointVelocities<Real>& v, JointPass which) {
    if constexpr (Rows::kTurn) turn.solve(v, which);
  }
  void solve_block(JointVelocities<Real>& v, const JointStep<Real>& step, JointPass which, Real part) {
    if constexpr (kBlock > 0) block.solve(v, step, which, part);
  }
  void solve_point(JointVelocities<Real>& v, JointPass which) {
    if constexpr (Rows::kPoint) point.solve(v, which);
  }

  Vec2<Real> find_offset(const SolverBodies<Real>& bodies, int body) const {
    if constexpr (Rows::kGrounded) return (bodies.position[body] - kind.ground_b).template as<Real>();
    return (bodies.position[body] - bodies.position[a]).template as<Real>();
  }

  Vec2<Real> find_offset_a(const SolverBodies<Real>& bodies) const {
    return (bodies.position[a] - kind.ground_a).template as<Real>();
  }

  JointVelocities<Real> velocities(const SolverBodies<Real>& bodies) const {
    JointVelocities<Real> v(bodies.motion[a], bodies.motion[b]);
    if constexpr (kOneBody) v.v_a = {}, v.w_a = 0, v.m_a = 0, v.i_a = 0;
    return v;
  }
  void store(const JointVelocities<Real>& v, const SolverBodies<Real>& bodies) const {
    v.store(bodies.motion[a], bodies.motion[b]);
  }

  void scale(Real factor) {
    if constexpr (Rows::kTurn) turn.scale(factor);
    for (auto& coordinate : axial) coordinate.scale(factor);
    if constexpr (kBlock > 0)
      for (Real& impulse : block.impulse) impulse *= factor;
    if constexpr (Rows::kPoint) point.impulse *= factor;
  }

  /// Returns the limits of the joint's angle, rad. A ratchet's limit follows its angle.
  Range limits() const {
    Range range;
    if constexpr (Rows::kTurn && !kRatchet) {
      for (int i = 0; i < turn.count; ++i) {
        const SolverRule<Real>& rule = turn.rule[i];
        if (rule.role == RowRole::Limit) (rule.sign > 0 ? range.lower : range.upper) = rule.origin;
      }
    }
    return range;
  }

  /// Computes the angle at the start of the step. Counts turns from the predicted end of the last substep.
  void count_turns(const SolverBodies<Real>& bodies, Real h) requires(kAngle != AngleUse::None) {
    const Rotation<Real> q_a = bodies.rotation[a], q_b = bodies.rotation[b];
    const Real w_a = bodies.motion[a].angular_velocity, w_b = bodies.motion[b].angular_velocity;
    if constexpr (kAngle == AngleUse::Geared) {
      // Gears are assembled such that their teeth meet: at first, b takes the matching turn.
      const bool born = angle.count == TurnCount::Born;
      angle.a = nearest_turn(angle_of(q_a), angle.a + (born ? 0 : h * w_a));
      const double fits = kind.exact_ratio * angle.a + kind.reference;
      angle.b = nearest_turn(angle_of(q_b), born ? fits : angle.b + h * w_b);
      angle.start = angle.b - fits;
      angle.start_a = angle.a;
    } else {
      const double now = relative_angle(q_a, q_b) - kind.reference;
      const Range range = limits();
      if (angle.count == TurnCount::Born) {
        angle.start = angle_at_birth(now, range.lower, range.upper);
      } else {
        double last = angle.b - kind.reference + h * (w_b - w_a);
        if (angle.count == TurnCount::Limited) last = std::min(std::max(last, range.lower), range.upper);
        angle.start = nearest_turn(now, last);
      }
      angle.b = angle.start + kind.reference;
    }
    angle.start_b = angle.b;
    angle.count = TurnCount::Counted;
  }

  /// Advances the ratchet past a tooth; it will not go back behind it.
  void click(Real now) requires kRatchet {
    const double tooth = kind.tooth_at(now);
    if (tooth > memory.value) memory.value = tooth;
    turn.rule[0].origin = static_cast<Real>(memory.value * kind.tooth);
  }

  /// Sets the length of a rope without a given one to the placed length.
  void recall_length(const SolverBodies<Real>& bodies) requires kPulley {
    if (memory.known == 0) {
      JointRows<Real> rows;
      kind.evaluate(pose(bodies), rows);
      memory = {static_cast<double>(rows.axial[0].residual), 1};
    }
    axial[0].rule[0].origin = static_cast<Real>(memory.value);
  }
};

}  // namespace plumb
