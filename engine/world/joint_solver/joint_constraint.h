#pragma once

#include <algorithm>
#include <array>
#include <type_traits>

#include "engine/joints/joint_angle.h"
#include "engine/joints/pulley_joint.h"
#include "engine/joints/ratchet_joint.h"
#include "engine/joints/revolute_joint.h"
#include "engine/world/joint_solver/joint_block.h"
#include "engine/world/joint_solver/joint_coordinate.h"
#include "engine/world/joint_solver/joint_point.h"
#include "engine/world/joint_solver/joint_springs.h"
#include "engine/world/joint_solver/under_relaxation.h"

namespace plumb {

/// Placeholder for a part that a kind lacks.
template <int>
struct NoPart {};

/// The own angles of a block of joints in SIMD lanes, rad, at the start of the step.
template <class Real>
struct LaneAngles {
  Real start = 0;
};

/// A joint of kind `Kind`, prepared for solving. With Lanes for `Real` it holds several joints side by side,
/// whose rules have the same roles. Only the parts that the kind has take memory. They are solved in the
/// order angular, axial, block, point, so that rigid rows are satisfied best.
template <class Real, template <class> class Kind>
struct JointConstraint {
  using Rows = Kind<Real>;
  using Step = JointStep<Scalar<Real>>;
  using Definition = typename Rows::Definition;
  static constexpr AngleUse kAngle = Rows::kAngle;
  static constexpr bool kRatchet = std::is_same_v<Rows, RatchetRows<Real>>;
  static constexpr bool kPulley = std::is_same_v<Rows, PulleyRows<Real>>;
  /// Mouse joint only: body a takes no part.
  static constexpr bool kOneBody = Rows::kGrounded && !kPulley;
  static constexpr int kAxial = Rows::kAxial, kBlock = Rows::kBlock;
  /// A plain revolute joint, which may be left to another solver.
  static constexpr bool kPlainHinge = std::is_same_v<Rows, HingeRows<Real>>;
  static constexpr bool kHasRows = kAxial + kBlock > 0;
  /// Exerts a torque about b's anchor.
  static constexpr bool kHasTorque = Rows::kAngular || kHasRows;
  static constexpr bool kSoftPoint = Rows::kPoint && Rows::kSoft;
  static constexpr bool kHasRules = Rows::kAngular || kAxial > 0 || kSoftPoint;
  /// A joint that may have springs.
  static constexpr bool kHasSprings = kHasRules && !kRatchet && !kPulley &&
                                      Rows::kAngle != AngleUse::Geared &&
                                      !std::is_same_v<Definition, FrictionDefinition>;
  template <bool kHas, class Part, int kTag>
  using If = std::conditional_t<kHas, Part, NoPart<kTag>>;

  int joint = 0, a = 0, b = 0;
  Real under_relaxation = 1;  ///< under-relaxation factor of its impulses
  bool isolated = false;      ///< no other joint moves its bodies
  bool with_island = false;   ///< solved with its island: here it is only evaluated
  Scalar<Real> known_h = 0;   ///< s, substep length that the rules are set for
  [[no_unique_address]] If<kHasSprings && !kIsLanes<Real>, JointSprings<Scalar<Real>>, 8> springs{};
  Vec2<Real> offset{};  ///< m, at the start of the step
  [[no_unique_address]] If<kPulley, Vec2<Real>, 5> offset_a{};
  [[no_unique_address]] If<kHasRows, Vec2<Real>, 6> arm_b{};
  [[no_unique_address]] If<kPlainHinge, bool, 7> external{};  ///< solved elsewhere
  Vec2<Real> mean_force{};                                    ///< N, on b: sum of the step's impulses over dt
  [[no_unique_address]] If<kHasTorque, Real, 9> mean_torque{};  ///< N m, about the end of `arm_b`
  Rows kind{};
  using Angle = std::conditional_t<kIsLanes<Real>, LaneAngles<Real>, JointAngle>;
  [[no_unique_address]] If<kAngle != AngleUse::None, Angle, 0> angle{};
  [[no_unique_address]] If<kRatchet || kPulley, JointMemory, 1> memory{};
  [[no_unique_address]] If<Rows::kAngular, JointCoordinate<Real, true>, 2> angular{};
  std::array<JointCoordinate<Real, false>, kAxial> axial{};
  [[no_unique_address]] If<(kBlock > 0), JointBlock<Real, kBlock>, 3> block{};
  using Point = std::conditional_t<kSoftPoint, SoftPoint<Real>, RigidPoint<Real>>;
  [[no_unique_address]] If<Rows::kPoint, Point, 4> point{};

  // Functions that are called less than once a step are not inlined, because they have many callers.
  /// Loads the definition's parameters; keeps impulses and memory that are still valid.
  [[gnu::noinline]] void load(const Definition& definition, Vec2d centre_a, Vec2d centre_b) {
    const Rows last = kind;
    const Range last_limits = limits();
    kind = Rows(definition, centre_a, centre_b);
    const JointRules rules = rules_of(definition);
    if constexpr (Rows::kAngular) angular.load(rules.angular);
    if constexpr (kAngle != AngleUse::None) {
      if (kind.reference != last.reference) {
        angle.count = TurnCount::New;
      } else if (angle.count == TurnCount::Counted && !(limits() == last_limits)) {
        angle.count = TurnCount::Limited;
      }
    }
    for (int i = 0; i < kAxial; ++i) axial[i].load(rules.axial[i]);
    if constexpr (kSoftPoint) point.load(rules.point);
    if constexpr (kRatchet) {
      if (kind.reference != last.reference || kind.tooth != last.tooth) memory = {};
    }
    if constexpr (kPulley) {
      // A given length may differ from the distance at which the bodies were placed.
      if (definition.length) memory = {*definition.length, 1};
    }
    restore_rule();
    known_h = 0;
    if constexpr (kHasSprings) springs = {.any = has_springs(rules)};
  }

  /// Sets the rule that follows from the stored state. A sleeping joint may be read before a step sets it.
  void restore_rule() {
    if constexpr (kRatchet)
      if (memory.known != 0) angular.rule[0].origin = static_cast<Real>(memory.value * kind.tooth);
    if constexpr (kPulley)
      if (memory.known != 0) axial[0].rule[0].origin = static_cast<Real>(memory.value);
  }

  /// Sets springs and bounds for substeps of h, s.
  [[gnu::noinline]] void set_substep(const Definition& definition, Real h) {
    const JointRules rules = rules_of(definition);
    SpringMobility mobility;
    if constexpr (kHasSprings) mobility = springs.mobility;
    if constexpr (Rows::kAngular) angular.set_substep(rules.angular, mobility.angular, h);
    for (int i = 0; i < kAxial; ++i) axial[i].set_substep(rules.axial[i], mobility.axial, h);
    if constexpr (kSoftPoint) point.set_substep(rules.point, mobility.point, h);
    known_h = h;
  }

  void begin_step(const SolverBodies<Real>& bodies, const Step& step) {
    if constexpr (kPlainHinge)
      if (external) return;
    clear_load();
    offset = find_offset(bodies, b);
    if constexpr (kPulley) offset_a = find_offset_a(bodies);
    if constexpr (kAngle != AngleUse::None) count_turns(bodies, step.h);
    if constexpr (kRatchet) {
      const double tooth = kind.tooth_at(angle.start);
      if (memory.known == 0) memory = {tooth, 1};
    }
    if constexpr (kPulley) init_length(bodies);
    if (step.warm_start != 1) scale(step.warm_start);
  }
  void end_step(const SolverBodies<Real>& bodies) { store_angles(motion_of(bodies, a, b)); }

  /// Evaluates all rows at the present poses.
  [[gnu::always_inline]] void evaluate(const JointMotion<Real>& now, const JointVelocities<Real>& v,
                                       const Step& step, JointTime time) {
    JointRows<Real> rows;
    const JointPose<Real> at = pose(now);
    if constexpr (kRatchet) advance_ratchet(at.angle);
    kind.evaluate(at, rows);
    if constexpr (kHasRows) arm_b = rows.arm_b;
    if (time != JointTime::Between) update_drift(now, rows, time == JointTime::StepStarts, step.h);
    if constexpr (kIsLanes<Real>) {
      evaluate_coordinates(at, rows, v, step, {under_relaxation, isolated});
    } else {
      evaluate_single(at, rows, v, step, {under_relaxation, isolated});
    }
    if constexpr (kBlock > 0) {
      for (int i = 0; i < kBlock; ++i) block.row[i] = rows.block[i];
      block.factorise(v);
    }
    store_angles(now);
  }

  [[gnu::always_inline]] void update_drift(const JointMotion<Real>& now, const JointRows<Real>& rows,
                                           bool starts, Scalar<Real> h) {
    const auto update = [ starts, h ](auto& coordinate, Real q) __attribute__((always_inline)) {
      starts ? coordinate.start_drift(q) : coordinate.update_drift(q, h);
    };
    // Rotation since the step began (0 at that time), because the angle may have many turns.
    if constexpr (Rows::kAngular) update(angular, now.delta_angle_b - now.delta_angle_a);
    for (int i = 0; i < kAxial; ++i) update(axial[i], rows.axial[i].residual);
    if constexpr (kSoftPoint)
      if (!starts) point.update_drift(rows.point.gap);
  }

  /// Evaluates angular, axial and point rows at a pose; `at.angle` and the residuals are the coordinates.
  [[gnu::always_inline]] void evaluate_coordinates(const JointPose<Real>& at, const JointRows<Real>& rows,
                                                   const JointVelocities<Real>& v, const Step& step,
                                                   UnderRelaxation<Real> relaxation) {
    if constexpr (Rows::kAngular) {
      if (angular_beside_rigid()) {
        const Real constrained = angular_mobility(masses_of(v), rows.point.arm_a, rows.point.arm_b);
        angular.evaluate_beside_rigid(at.angle, v, constrained, step, relaxation);
      } else {
        angular.evaluate(at.angle, v, step, relaxation);
      }
    }
    for (int i = 0; i < kAxial; ++i) axial[i].row = rows.axial[i];
    for (int i = 0; i < kAxial; ++i) {
      if (i == 0 && axial_beside_rigid()) {
        axial[i].evaluate_beside_rigid(rows.axial[i].residual, v, constrained_axial_mobility(v, at, rows),
                                       step, relaxation);
      } else {
        axial[i].evaluate(rows.axial[i].residual, v, step, relaxation);
      }
    }
    if constexpr (kSoftPoint)
      if (point_beside_rigid())
        return point.evaluate_beside_rigid(rows.point, v, constrained_response(masses_of(v), rows.point),
                                           step, relaxation);
    if constexpr (Rows::kPoint) point.evaluate(rows.point, v, step, relaxation);
  }

  /// Does the same for a single joint. Not inlined: it is the larger part of a joint's code.
  [[gnu::noinline]] void evaluate_single(const JointPose<Real>& at, const JointRows<Real>& rows,
                                         const JointVelocities<Real>& v, const Step& step,
                                         UnderRelaxation<Real> relaxation) {
    evaluate_coordinates(at, rows, v, step, relaxation);
  }

  // Springs beside rigid rows of the joint respond with their effective mass given these: see
  // engine/joints/spring_mobility.h.
  /// Returns true if the angle has a spring beside a rigid point.
  [[gnu::always_inline]] bool angular_beside_rigid() const {
    if constexpr (Rows::kAngular && Rows::kPoint) return point.rigid() && angular.has(RowRole::Spring);
    return false;
  }
  /// Returns true if the first axial coordinate has a spring beside a rigid block or second coordinate.
  [[gnu::always_inline]] bool axial_beside_rigid() const {
    if constexpr (kAxial > 0 && (kBlock > 0 || kAxial > 1)) return axial[0].has(RowRole::Spring);
    return false;
  }
  /// Returns true if the point has a spring beside a rigid angle.
  [[gnu::always_inline]] bool point_beside_rigid() const {
    if constexpr (Rows::kAngular && kSoftPoint)
      return !point.rigid() && point.rule.role == RowRole::Spring && angular.has(RowRole::Rigid);
    return false;
  }
  [[gnu::always_inline]] Real constrained_axial_mobility(const JointVelocities<Real>& v,
                                                         const JointPose<Real>& at,
                                                         const JointRows<Real>& rows) const {
    const JointRow<Real>& first = rows.axial[0];
    if constexpr (kAxial > 1) {
      const JointRow<Real>& second = rows.axial[1];
      return line_mobility(masses_of(v), first.angular_a, first.angular_b, second.angular_a,
                           second.angular_b);
    } else {
      return slider_mobility(masses_of(v), at.offset, first.linear_b);
    }
  }

  /// Returns the least opening of the angle's limits, rad, each with `slack`: negative beyond one of them.
  [[gnu::always_inline]] Real limit_opening(Real turned, Scalar<Real> slack) const {
    using std::min;
    const Real now = static_cast<Real>(angle.start) + turned;
    Real least = slack;
    for (int i = 0; i < angular.count; ++i)
      if (angular.rule[i].role == RowRole::Limit)
        least = min(least, Real(angular.rule[i].sign * (now - angular.rule[i].origin) + slack));
    return least;
  }

  /// Returns the fractions of the present rows' mobility that are the bodies'.
  MobilityFraction<Real> mobility_fractions(const JointVelocities<Real>& v) const {
    if constexpr (kPlainHinge) return point_mobility_fraction(v, point.point.arm_a, point.point.arm_b);
    constexpr int kRows = kAxial + kBlock + (Rows::kPoint ? 2 : 0) + (Rows::kAngular ? 1 : 0);
    JointRow<Real> rows[kRows];
    int count = 0;
    if constexpr (Rows::kAngular)
      rows[count++] = {{}, {}, angular.count > 0 ? Real(-1) : 0, angular.count > 0 ? Real(1) : 0};
    for (int i = 0; i < kAxial; ++i) rows[count++] = axial[i].count > 0 ? axial[i].row : JointRow<Real>{};
    if constexpr (kBlock > 0)
      for (const JointRow<Real>& row : block.row) rows[count++] = row;
    if constexpr (Rows::kPoint)
      for (const Vec2<Real> n : {Vec2<Real>{1, 0}, Vec2<Real>{0, 1}})
        rows[count++] = point.point.plain_row(n);
    return mobility_fraction(rows, v);
  }

  [[gnu::always_inline]] void warm_start(JointVelocities<Real>& v) const {
    if constexpr (Rows::kAngular) angular.warm_start(v);
    for (int i = 0; i < kAxial; ++i) axial[i].warm_start(v);
    if constexpr (kBlock > 0) block.warm_start(v);
    if constexpr (Rows::kPoint) point.warm_start(v);
  }

  /// Solves all rows once. Rigid rows beside a spring are solved before and after it: the spring then sees
  /// the velocity that they leave, and its response includes them. Before the spring they are solved exactly,
  /// as its response assumes: with softness they would lose a part of their load, for which stiff springs
  /// overcompensate, more from substep to substep. After the spring they are solved exactly too, if the joint
  /// is alone: a lost part of their load would rotate a body whose inertia is small about its centre but not
  /// about the joint.
  [[gnu::always_inline]] void solve_coordinates(JointVelocities<Real>& v, const Step& step, JointPass which,
                                                Real relaxation) {
    Softness<Scalar<Real>> soft = step.softness;
    if (angular_beside_rigid()) solve_point(v, soft, kRelax, relaxation);
    if (point_beside_rigid()) solve_angular(v, kRelax), solve_point(v, soft, which, relaxation);
    if (axial_beside_rigid()) {
      for (int i = 1; i < kAxial; ++i) axial[i].solve(v, kRelax);
      solve_block(v, soft, kRelax, relaxation);
    }
    if (isolated && (angular_beside_rigid() || axial_beside_rigid()))
      soft = {.bias_rate = soft.bias_rate, .mass_scale = 1, .impulse_scale = 0};
    solve_angular(v, which);
    for (int i = 0; i < kAxial; ++i) axial[i].solve(v, which);
    solve_block(v, soft, which, relaxation);
    if (!point_beside_rigid()) solve_point(v, soft, which, relaxation);
  }
  [[gnu::always_inline]] void solve(JointVelocities<Real>& v, const Step& step) {
    solve_coordinates(v, step, kSolve, under_relaxation);
  }
  [[gnu::always_inline]] void relax(const JointMotion<Real>& now, JointVelocities<Real>& v,
                                    const Step& step) {
    evaluate(now, v, step, JointTime::SubstepEnds);
    solve_coordinates(v, step, kRelax, under_relaxation);
    add_load(step);
  }

  /// Returns the pose.
  [[gnu::always_inline]] JointPose<Real> pose(const JointMotion<Real>& now) const {
    JointPose<Real> at{.rotation_a = now.rotation_a, .rotation_b = now.rotation_b};
    if constexpr (Rows::kGrounded) {
      at.offset = offset + now.delta_position_b;
      if constexpr (kPulley) at.offset_a = offset_a + now.delta_position_a;
    } else {
      at.offset = offset + (now.delta_position_b - now.delta_position_a);
    }
    if constexpr (kAngle == AngleUse::Geared) {
      at.angle = static_cast<Real>(angle.start) + (now.delta_angle_b - kind.ratio * now.delta_angle_a);
    } else if constexpr (kAngle != AngleUse::None) {
      at.angle = static_cast<Real>(angle.start) + (now.delta_angle_b - now.delta_angle_a);
    }
    return at;
  }
  JointPose<Real> pose(const SolverBodies<Real>& bodies) const { return pose(motion_of(bodies, a, b)); }

  /// Stores the angles from which turns are counted.
  [[gnu::always_inline]] void store_angles(const JointMotion<Real>& now) {
    if constexpr (kIsLanes<Real>) {
      return;  // done at the end of the step, by `end_step`
    } else if constexpr (kAngle == AngleUse::Geared) {
      angle.a = angle.start_a + now.delta_angle_a;
      angle.b = angle.start_b + now.delta_angle_b;
    } else if constexpr (kAngle != AngleUse::None) {
      angle.b = angle.start_b + (now.delta_angle_b - now.delta_angle_a);
    }
  }

  /// Returns the current pose and rows, at any time; counts turns since the last evaluation.
  std::pair<JointPose<Real>, JointRows<Real>> current(const SolverBodies<Real>& bodies) const {
    JointConstraint now = *this;
    const Vec2<Real> delta_position_a = bodies.motion[a].delta_position,
                     delta_position_b = bodies.motion[b].delta_position;
    JointPose<Real> at{.rotation_a = bodies.rotation[a], .rotation_b = bodies.rotation[b]};
    at.offset =
        find_offset(bodies, b) + (Rows::kGrounded ? delta_position_b : delta_position_b - delta_position_a);
    if constexpr (kPulley) at.offset_a = find_offset_a(bodies) + delta_position_a;
    if constexpr (kAngle != AngleUse::None) {
      now.count_turns(bodies, 0);
      at.angle = static_cast<Real>(now.angle.start);
    }
    JointRows<Real> rows;
    kind.evaluate(at, rows);
    return {at, rows};
  }

  /// Adds the impulses of a substep, at its end, to the load of the step.
  [[gnu::always_inline]] void add_load(const Step& step) {
    add_load_along(
        step, [&](const auto& count) __attribute__((always_inline)) {
          if constexpr (kHasRows) {
            for (int i = 0; i < kAxial; ++i) count(arm_b, axial[i].row, axial[i].impulse());
            if constexpr (kBlock > 0)
              for (int i = 0; i < kBlock; ++i) count(arm_b, block.row[i], block.impulse[i]);
          }
        });
  }
  /// Does the same along the rows of another pose.
  void add_load(const Step& step, const JointRows<Real>& at) {
    add_load_along(step, [&](const auto& count) {
      for (int i = 0; i < kAxial; ++i) count(at.arm_b, at.axial[i], axial[i].impulse());
      if constexpr (kBlock > 0)
        for (int i = 0; i < kBlock; ++i) count(at.arm_b, at.block[i], block.impulse[i]);
    });
  }
  /// Adds an impulse on b, with its moment about b's anchor.
  void add_impulse(Vec2<Real> impulse, Real moment, const Step& step) {
    mean_force += step.inverse_dt * impulse;
    if constexpr (kHasTorque) mean_torque += step.inverse_dt * moment;
  }
  void clear_load() {
    mean_force = {};
    if constexpr (kHasTorque) mean_torque = 0;
  }

  /// Calls visit(impulse) for each impulse.
  template <class Visit>
  void for_each_impulse(const Visit& visit) {
    if constexpr (Rows::kAngular) angular.for_each_impulse(visit);
    for (auto& coordinate : axial) coordinate.for_each_impulse(visit);
    if constexpr (kBlock > 0)
      for (Real& impulse : block.impulse) visit(impulse);
    if constexpr (Rows::kPoint) visit(point.impulse.x), visit(point.impulse.y);
  }
  void scale(Real factor) {
    for_each_impulse([&](Real& impulse) { impulse *= factor; });
  }

  /// Clears impulses, counts and rows. A failed step may have left NaNs, which remain NaN when multiplied by
  /// 0, and whose sign depends on how many joints were solved side by side.
  void reset() {
    clear_load();
    if constexpr (kHasRows) arm_b = {};
    if constexpr (Rows::kAngular) angular.reset();
    for (auto& coordinate : axial) coordinate.reset();
    if constexpr (kBlock > 0) {
      for (auto& row : block.row) row = {};
      for (Real& impulse : block.impulse) impulse = 0;
    }
    if constexpr (Rows::kPoint) point.impulse = {}, point.point = {};
    if constexpr (kSoftPoint) point.drift = {};
    if constexpr (kAngle != AngleUse::None) angle = {};
    if constexpr (kRatchet) memory = {};
  }
  /// Clears impulses but keeps counted turns, because a pose does not contain them.
  void reset_impulses() {
    scale(0);
    clear_load();
    if constexpr (kRatchet) memory = {};
  }
  /// Sets the bodies' own angles, rad, with their turns, for gears that are not counted yet.
  void set_initial_angles(double angle_a, double angle_b) {
    if constexpr (kAngle == AngleUse::Geared)
      if (angle.count == TurnCount::New) angle.a = angle_a, angle.b = angle_b;
  }

  /// Calls visit(x, y) for each number that is read after a step: x of this joint (or block of joints), y of
  /// `one`.
  template <class One, class Visit>
  [[gnu::always_inline]] void results(One& one, const Visit& visit) {
    const auto pair = [&](auto& x, auto& y) __attribute__((always_inline)) {
      visit(x.x, y.x), visit(x.y, y.y);
    };
    const auto row = [&](auto& x, auto& y) __attribute__((always_inline)) {
      pair(x.linear_a, y.linear_a), pair(x.linear_b, y.linear_b);
      visit(x.angular_a, y.angular_a), visit(x.angular_b, y.angular_b), visit(x.residual, y.residual);
    };
    const auto coordinate = [&](auto& x, auto& y) __attribute__((always_inline)) {
      for (int i = 0; i < x.count; ++i)
        visit(x.rule[i].impulse, y.rule[i].impulse), visit(x.rule[i].drift, y.rule[i].drift);
    };
    if constexpr (kHasRows) pair(arm_b, one.arm_b);
    if constexpr (Rows::kAngular) coordinate(angular, one.angular);
    for (int i = 0; i < kAxial; ++i) coordinate(axial[i], one.axial[i]), row(axial[i].row, one.axial[i].row);
    if constexpr (kBlock > 0)
      for (int i = 0; i < kBlock; ++i)
        row(block.row[i], one.block.row[i]), visit(block.impulse[i], one.block.impulse[i]);
    if constexpr (Rows::kPoint) {
      pair(point.impulse, one.point.impulse);
      pair(point.point.arm_a, one.point.point.arm_a), pair(point.point.arm_b, one.point.point.arm_b);
    }
    if constexpr (kSoftPoint) pair(point.drift, one.point.drift);
    pair(mean_force, one.mean_force);
    if constexpr (kHasTorque) visit(mean_torque, one.mean_torque);
  }

 private:
  /// Adds the impulses to the load: linear, and angular about the end of `arm`. `rows(count)` calls
  /// `count(arm, row, impulse)` for each axial and block row.
  template <class RowsOf>
  [[gnu::always_inline]] void add_load_along(const Step& step, const RowsOf& rows) {
    Vec2<Real> linear{};
    Real moment = 0;
    if constexpr (Rows::kAngular) moment += angular.impulse();
    rows([&](const Vec2<Real>& arm, const JointRow<Real>& row, Real impulse) __attribute__((always_inline)) {
      linear += impulse * row.linear_b;
      moment += impulse * (row.angular_b - cross(arm, row.linear_b));
    });
    if constexpr (Rows::kPoint) linear += point.impulse;
    const Real rate = step.inverse_dt;
    mean_force.x += rate * linear.x, mean_force.y += rate * linear.y;
    if constexpr (kHasTorque) mean_torque += rate * moment;
  }

  [[gnu::always_inline]] void solve_angular(JointVelocities<Real>& v, JointPass which) {
    if constexpr (Rows::kAngular) angular.solve(v, which);
  }
  [[gnu::always_inline]] void solve_block(JointVelocities<Real>& v, const Softness<Scalar<Real>>& soft,
                                          JointPass which, Real relaxation) {
    if constexpr (kBlock > 0) block.solve(v, soft, which, relaxation);
  }
  [[gnu::always_inline]] void solve_point(JointVelocities<Real>& v, const Softness<Scalar<Real>>& soft,
                                          JointPass which, Real relaxation) {
    if constexpr (Rows::kPoint) point.solve(v, soft, which, relaxation);
  }

  Vec2<Real> find_offset(const SolverBodies<Real>& bodies, int body) const {
    if constexpr (Rows::kGrounded) return (bodies.position[body] - kind.ground_b).template as<Real>();
    return (bodies.position[body] - bodies.position[a]).template as<Real>();
  }

  Vec2<Real> find_offset_a(const SolverBodies<Real>& bodies) const {
    return (bodies.position[a] - kind.ground_a).template as<Real>();
  }

  /// Returns the limits of the joint's angle, rad. A ratchet's limit follows its angle.
  Range limits() const {
    Range range;
    if constexpr (Rows::kAngular && !kRatchet) {
      for (int i = 0; i < angular.count; ++i) {
        const SolverRule<Real>& rule = angular.rule[i];
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
      // Gears are assembled with matching teeth: initially, b gets the matching turn.
      const bool is_new = angle.count == TurnCount::New;
      angle.a = unwrap_angle(angle_of(q_a), angle.a + (is_new ? 0 : h * w_a));
      const double fits = kind.exact_ratio * angle.a + kind.reference;
      angle.b = unwrap_angle(angle_of(q_b), is_new ? fits : angle.b + h * w_b);
      angle.start = angle.b - fits;
      angle.start_a = angle.a;
    } else {
      const double now = relative_angle(q_a, q_b) - kind.reference;
      const Range range = limits();
      if (angle.count == TurnCount::New) {
        angle.start = angle_at_creation(now, range.lower, range.upper);
      } else {
        double last = angle.b - kind.reference + h * (w_b - w_a);
        if (angle.count == TurnCount::Limited) last = std::min(std::max(last, range.lower), range.upper);
        angle.start = unwrap_angle(now, last);
      }
      angle.b = angle.start + kind.reference;
    }
    angle.start_b = angle.b;
    angle.count = TurnCount::Counted;
  }

  /// Advances the ratchet past a tooth; it will not go back behind that tooth.
  void advance_ratchet(Real now) requires kRatchet {
    const double tooth = kind.tooth_at(now);
    if (tooth > memory.value) memory.value = tooth;
    restore_rule();
  }

  /// Sets the length of a rope without a given one to the placed length.
  void init_length(const SolverBodies<Real>& bodies) requires kPulley {
    if (memory.known == 0) {
      JointRows<Real> rows;
      kind.evaluate(pose(bodies), rows);
      memory = {static_cast<double>(rows.axial[0].residual), 1};
    }
    restore_rule();
  }
};

}  // namespace plumb
