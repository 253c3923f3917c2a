#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/loop_scheduler.h"
#include "engine/joints/joint_row.h"
#include "engine/joints/spring_stiffness.h"
#include "engine/math/vec2.h"
#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

class Decoder;
class Encoder;

/// Data of the step for the joints.
template <class Real>
struct JointStep {
  Real h = 0;                 ///< s, of a substep
  Real inverse_h = 0;         ///< 1/s
  Real inverse_dt = 0;        ///< 1/s, of the whole step: loads are means over it
  Softness<Real> softness{};  ///< of rigid rows
  /// h (c + h k) times the mobility, above which springs are held like rigid rows: `max_spring_stiffness`.
  Real max_stiffness = std::numeric_limits<Real>::infinity();
  Real stiff_rate = 0;  ///< 1/s, at which such springs close their error
  Real warm_start = 1;  ///< ratio of this substep's length to the previous step's: impulses scale with it
  /// Also evaluates joints that are solved with their island, because a reader of the step's joints needs
  /// them at the last pose.
  bool evaluates_all = true;
};

/// Returns the limit of h (c + h k) over the effective mass up to which sequential impulses with warm
/// starting solve a spring as it is. Stiffer springs are held like rigid rows (StiffSpring in joint_rule.h):
/// the substep is too long for them to oscillate. Linear models of chains and stars of 2 to 100 bodies, with
/// a hub down to a thousandth of their mass, are stable at 2 with one iteration per pass. At 12 they are
/// stable with 6 and more iterations, for any stiffness and damping; from 4 on chains explode with fewer.
template <class Real>
Real max_spring_stiffness(int iterations) {
  return static_cast<Real>(2 * std::min(iterations, 6));
}

/// Position error of a joint.
template <class Real>
struct JointError {
  Real linear = 0;   ///< m
  Real angular = 0;  ///< rad
};

/// One row of a joint, for the solver of a whole island.
template <class Real>
struct JointSolverRow {
  JointRow<Real> row{};  ///< its target residual is 0; for a limit, at least 0
  RowRole role = RowRole::Rigid;
  bool pair = false;  ///< `max_impulse` bounds the vector of this impulse and that of the previous row
  Real speed = 0;     ///< m/s or rad/s, of a motor
  Real max_impulse = std::numeric_limits<Real>::infinity();  ///< N s or N m s, in a substep
  Real rate = 0;        ///< 1/s, of a spring: J v + rate C + compliance impulse = 0
  Real compliance = 0;  ///< in the unit of its mobility
  Real length = 0;      ///< m, target of its coordinate, of a rod or rope
  Real* impulse =
      nullptr;  ///< its accumulated impulse, in the joint; valid until joints are added or removed
};

/// Addresses at which the caller stores its results for a hinge. Valid until joints are added or removed.
template <class Real>
struct HingeResults {
  Vec2<Real>* impulse = nullptr;  ///< N s, on b in the last substep
  Vec2<Real>* force = nullptr;    ///< N, on b, mean of the step
};

/// A plain revolute joint that the caller solves in the set's place.
template <class Real>
struct ExternalHinge {
  Vec2d anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  HingeResults<Real> results{};
};

/// All joints of a real-time world, solved by sequential impulses with soft constraints and relaxation ("TGS
/// soft", Catto, Solver2D, 2024). Joints are graph-coloured: those of one colour share no dynamic body and
/// lie in one array per colour and kind. A substep is
///     v += h a;  warm_start;  solve;  x += h v;  relax
/// `prepare` comes once before the substeps, at the positions and rotations of the step's start, with zero
/// displacements. `relax` evaluates rows after bodies have moved, and they serve the next substep too.
/// Impulses therefore act at the bodies' present positions: joints conserve angular momentum to rounding, and
/// a pendulum hardly loses energy. Nothing may move between `relax` and the next `warm_start`. None of the
/// four allocates. Threads share them, colour by colour, with the same bits as one thread.
/// The load of a joint is the mean over the step: the sum of the impulses of all substeps, divided by dt. An
/// impulse at the end of a substep is that of the whole substep, because warm starting is part of it.
template <class Real>
class JointSet {
 public:
  JointSet();
  JointSet(const JointSet& other);
  JointSet(JointSet&& other) noexcept;
  JointSet& operator=(JointSet other) noexcept;
  ~JointSet();
  /// Copies `other` into the existing memory; does not allocate if that suffices.
  void assign(const JointSet& other);

  /// Adds a joint between bodies `body_a` and `body_b`. Returns its slot, which is valid until `remove`; the
  /// slot freed last is reused first. `centre_a` and `centre_b` are the centres of mass in the bodies'
  /// frames. The pose in which `bodies` are is the joint's reference, at which its springs have their
  /// stiffness (spring_stiffness.h). The joint is active if one of them is dynamic. Throws Error (Value) for
  /// a definition that `validate` rejects, and for a body joined to itself.
  int add(const JointKind& definition, int body_a, int body_b, Vec2<Real> centre_a, Vec2<Real> centre_b,
          bool dynamic_a, bool dynamic_b, const SolverBodies<Real>& bodies);
  void remove(int joint);

  /// Activates or deactivates a joint. An inactive joint keeps its impulses and takes no part in steps (its
  /// bodies sleep, or none of them is dynamic now).
  void set_active(int joint, bool active);

  const JointKind& definition(int joint) const;
  /// Replaces the definition: new speeds, limits, targets, or another kind. Impulses and counted turns are
  /// kept if the kind is the same. A weld that becomes soft or rigid starts anew; a revolute joint without
  /// limits, motor and spring counts no turns. With another reference angle, or a new kind, the joint's angle
  /// starts at the turn nearest to 0 or its limits. New limits select the turn nearest to them. A pulley
  /// without a given length keeps its present one. Throws Error (Value) as `add`, and then changes nothing.
  void change(int joint, const JointKind& definition);
  /// Updates the centres of mass, after one has moved in its body's frame.
  void recentre(int joint, Vec2<Real> centre_a, Vec2<Real> centre_b);
  /// Updates which bodies are dynamic, and activates or deactivates the joint.
  void set_dynamic(int joint, bool dynamic_a, bool dynamic_b, bool active);
  /// Sets the angles of bodies a and b, rad, with their turns: a gear before its first step is assembled at
  /// these. Without it, such angles are in [-pi, pi].
  void set_initial_angles(int joint, double angle_a, double angle_b);
  /// Clears impulses and counted turns, after a body of the joint was replaced.
  void reset(int joint);
  /// Clears impulses, after a body of the joint was repositioned. Its angle is the one nearest to the last.
  void reset_impulses(int joint);

  /// Evaluates all rows at the start of the step.
  void prepare(const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// Does the same, and solves joints in blocks until `store_results`, which must follow the last substep.
  /// Joints that other code reads or changes before it are marked in `excluded` (by slot; may be empty).
  void prepare(const SolverBodies<Real>& bodies, const JointStep<Real>& step,
               const std::vector<char>& excluded, LoopScheduler* scheduler);
  void store_results(LoopScheduler* scheduler);
  /// Stores the angles at the end of the step, after gaps were closed.
  void finish(const SolverBodies<Real>& bodies, LoopScheduler* scheduler);
  /// Applies the impulses of the last substep.
  void warm_start(const SolverBodies<Real>& bodies, const JointStep<Real>& step,
                  LoopScheduler* scheduler = nullptr);
  /// Solves velocities with soft position correction.
  void solve(const SolverBodies<Real>& bodies, const JointStep<Real>& step,
             LoopScheduler* scheduler = nullptr);
  /// Evaluates all rows at the poses after the motion and solves velocities without bias, which removes the
  /// velocity that the bias added. Springs keep their force.
  void relax(const SolverBodies<Real>& bodies, const JointStep<Real>& step,
             LoopScheduler* scheduler = nullptr);

  /// Projects angles beyond an angular limit by more than `slack`, rad, each joint by at most `max_rotation`
  /// about its common point. Changes poses, not velocities. One iteration; returns true if any joint was
  /// rotated. Call between the motion and `relax`. Does not allocate.
  bool project_angular_limits(const SolverBodies<Real>& bodies, Rotation<Real>* rotation, Real slack,
                              Real max_rotation, LoopScheduler* scheduler = nullptr);

  /// Returns true if the joint's angle was beyond a limit by more than `slack`, rad, at the start of the
  /// step.
  bool began_beyond_limits(int joint, Real slack) const;

  /// Sets `open[slot]` (of `slots()` items) for joints of which a rigid row, or a limit along an axis, was
  /// open after the last `relax` by more than a fraction `tolerance` of its link (joint_opening.h); returns
  /// true if there are any. Call before `finish`. Does not allocate.
  bool find_open(const SolverBodies<Real>& bodies, Real tolerance, std::vector<char>& open,
                 LoopScheduler* scheduler = nullptr);

  // For solvers without relaxation. None of the four allocates.
  /// Evaluates all rows at the present poses, within a step.
  void evaluate(const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// Clears impulses: position-based solvers start each substep without any.
  void begin_projection(const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// Makes one iteration over positions: moves and rotates bodies (`rotation` is that of `bodies`) to satisfy
  /// each joint in turn. Velocities remain the displacement since the substep's start over h. The rate of
  /// `step.softness` is 1 / h: errors are corrected completely.
  void project(const SolverBodies<Real>& bodies, Rotation<Real>* rotation, const JointStep<Real>& step);

  /// Adds the impulses of a substep to the loads of all active joints. `relax` does this by itself.
  void add_loads(const JointStep<Real>& step);

  /// Adds the impulses of a substep to the load of a joint that is solved with its island, along its rows at
  /// the present poses.
  void add_load(int joint, const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// Adds an impulse on b to a joint's load, N s, with its moment about b's anchor, N m s. Call after
  /// `store_results`.
  void add_impulse(int joint, Vec2<Real> impulse, Real moment, const JointStep<Real>& step);
  /// Returns the arm of b's anchor from b's centre of mass at the present poses, m; 0 without an anchor.
  Vec2<Real> anchor_arm(int joint, const SolverBodies<Real>& bodies) const;

  /// Appends the impulses of all active joints.
  void append_impulses(std::vector<Real>& impulses) const;
  /// Sets each to `kept` times that of `earlier`, in the same order, plus `scale` times itself.
  void add_impulses(std::span<const Real> earlier, Real kept, Real scale);

  /// Appends the rows of a joint at the present poses.
  void solver_rows(int joint, const SolverBodies<Real>& bodies, std::vector<JointSolverRow<Real>>& rows);

  /// Sets a joint's springs and bounds for substeps of h, s, until the next step.
  void set_substep(int joint, Real h);

  /// Sets the fraction of a joint's impulses that iterations start from if they take the joint over.
  void set_warm_start_fraction(int joint, double fraction);
  /// Returns that fraction: 1 if the impulses balance a load, 0 if they only stop or drive something.
  double warm_start_fraction(int joint) const;
  /// Scales the impulses of a joint that iterations take over by that fraction, and returns the fraction.
  Real take_over(int joint);

  /// Returns the number of a joint's rows whose impulses have bounds: limits and motors.
  int bounded_rows(int joint) const;

  /// Returns true for a revolute joint without limits, motor and spring.
  bool is_hinge(int joint) const;
  /// Leaves such a joint to the caller: steps skip it until `clear_external`.
  ExternalHinge<Real> set_external(int joint);
  /// Takes back all joints that were left to the caller.
  void clear_external();

  /// Returns the reaction force of the last step, N: magnitude of the mean force on b.
  Real force(int joint) const;
  /// Returns the reaction torque of the last step about b's anchor, N m: magnitude of its mean.
  Real torque(int joint) const;

  /// Returns the error of the rigid rows and the limits at the present poses (`position` + `delta_position`,
  /// with `rotation`). Springs and motors have no error.
  JointError<Real> error(int joint, const SolverBodies<Real>& bodies) const;
  /// Returns the angle of b relative to a minus the reference angle (the target, the phase), rad: revolute,
  /// prismatic, weld, wheel, motor, ratchet, friction. It starts at the turn nearest to 0 that limits allow,
  /// and whole turns are counted. Revolute joints without limits, spring and motor have an angle in [-pi,
  /// pi]. Counting is correct while the bodies rotate less than pi, relative to each other, in a substep.
  Real angle(int joint, const SolverBodies<Real>& bodies) const;
  /// Returns the constants of the joint's springs for bodies with these centres and masses. Throws Error
  /// (Unsupported) for a joint without springs.
  JointStiffness stiffness(int joint, Vec2<Real> centre_a, Vec2<Real> centre_b,
                           const PairMobility<Real>& bodies) const;
  /// Returns the coordinate of anchor b along the axis from anchor a, m: prismatic, wheel.
  Real translation(int joint, const SolverBodies<Real>& bodies) const;
  /// Returns the length, m: distance between the anchors for distance; length_a + ratio length_b for pulley.
  Real length(int joint, const SolverBodies<Real>& bodies) const;

  int count() const;
  int active_count() const;
  /// Returns one more than the highest slot that was ever used.
  int slots() const;
  bool contains(int joint) const;
  bool active(int joint) const;
  std::pair<int, int> bodies(int joint) const;
  /// Returns which of its bodies are dynamic.
  std::pair<bool, bool> dynamic(int joint) const;
  /// Returns the joint's colour. Joints of one colour share no dynamic body, except those of the overflow,
  /// `colours() - 1`.
  int colour(int joint) const;
  static int colours();

  /// Saves all state that a step depends on: a restored set continues with the same bits.
  void save(Encoder& out) const;
  void restore(Decoder& in);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

extern template class JointSet<float>;
extern template class JointSet<double>;

}  // namespace plumb
