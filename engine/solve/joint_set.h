#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "engine/joints/joint_row.h"
#include "engine/math/vec2.h"
#include "engine/solve/body_motion.h"

namespace plumb {

class ByteReader;
class ByteWriter;

/// What joints need to know of the step that they are solved in.
template <class Real>
struct JointStep {
  Real h = 0;                 ///< s, of a substep
  Real inverse_h = 0;         ///< 1/s
  Softness<Real> softness{};  ///< of rows that are rigid
  /// h (c + h k) by the effective mass beyond which springs are held as rigid rows are: `stiffest_spring`.
  Real stiffest = std::numeric_limits<Real>::infinity();
  Real warm_start = 1;  ///< this substep over the previous step's one: impulses scale with it
};

/// The stiffest spring that so many sweeps, started from the last impulses, follow as it is: h (c + h k) over
/// its effective mass. Stiffer ones are held as rigid rows are (StiffSpring in joint_rule.h): a substep is
/// too long for them to swing. The linear models of chains and stars of 2 to 100 bodies, hub down to a
/// thousandth, are stable at 2 for a sweep a pass, and at 12 for 6 and more, with any stiffness and damping;
/// from 4 on chains explode.
template <class Real>
Real stiffest_spring(int sweeps) {
  return static_cast<Real>(2 * std::min(sweeps, 6));
}

/// How far a joint is from what it should hold.
template <class Real>
struct JointError {
  Real linear = 0;   ///< m
  Real angular = 0;  ///< rad
};

/// One row of a joint, for who solves all of an island at once.
template <class Real>
struct JointSolverRow {
  JointRow<Real> row{};  ///< the residual is what it holds: 0, or at least 0 of a limit
  RowRole role = RowRole::Rigid;
  bool pair = false;  ///< `most` bounds the vector of this impulse and the one of the row before it
  Real speed = 0;     ///< m/s or rad/s, of a motor
  Real most = std::numeric_limits<Real>::infinity();  ///< N s or N m s, in a substep
  Real rate = 0;                ///< 1/s, of a spring: J v + rate C + compliance impulse = 0
  Real compliance = 0;          ///< of its mobility's unit
  Real coupled_compliance = 0;  ///< likewise, with the impulse of the row before it
  Real* impulse = nullptr;      ///< its accumulated impulse, in the joint: valid until joints come or go
};

/// A plain revolute joint, for who solves it in the set's place.
template <class Real>
struct HeldHinge {
  Vec2d anchor_a{}, anchor_b{};   ///< m, from the centres of mass, in the bodies' frames
  Vec2<Real>* impulse = nullptr;  ///< N s, on b in the last substep: valid until joints come or go
};

/// All joints of a real-time world, solved by sequential impulses with soft steps and a relaxation ("TGS
/// soft", Catto, Solver2D, 2024). Joints are coloured such that those of one colour share no dynamic body,
/// and lie in one array per colour and kind. A substep is
///     v += h a;  warm_start;  solve;  x += h v;  relax
/// and `prepare` comes once before the substeps, when positions and rotations are those of the step's start
/// and nothing has moved or turned. Rows are evaluated after bodies have moved, by `relax`, and serve the
/// next substep too: impulses always act where bodies are, so that joints conserve angular momentum to
/// rounding and a pendulum hardly loses energy. Nothing may move between `relax` and the next `warm_start`.
/// None of the four allocates.
template <class Real>
class JointSet {
 public:
  JointSet();
  JointSet(const JointSet& other);
  JointSet(JointSet&& other) noexcept;
  JointSet& operator=(JointSet other) noexcept;
  ~JointSet();
  /// Becomes a copy of `other` in the room that is there: nothing is allocated where it suffices.
  void assign(const JointSet& other);

  /// A new joint between bodies `body_a` and `body_b`; returns its slot, which stays its own until `remove`.
  /// Slots that are free are taken again, the last one freed first. `centre_a` and `centre_b` are the centres
  /// of mass in the bodies' frames. Error (Value) for a definition that `validate` refuses, for a body joined
  /// to itself and when no body is dynamic.
  int add(const JointKind& definition, int body_a, int body_b, Vec2<Real> centre_a, Vec2<Real> centre_b,
          bool dynamic_a, bool dynamic_b);
  void remove(int joint);

  /// A joint that is not active keeps its impulses and takes no part in steps (its bodies sleep).
  void set_active(int joint, bool active);

  const JointKind& definition(int joint) const;
  /// Replaces the definition: new speeds, limits, targets, or another kind. Impulses and counted turns are
  /// kept where the kind is the same (of a weld that becomes soft or rigid they start anew; a revolute joint
  /// without limits, motor and spring counts no turns). With another reference angle, and where it is none of
  /// a, the joint's angle starts at the turn nearest to 0 or its limits; new limits find it at the one
  /// nearest to them. A pulley whose length is not given any more keeps the one it has. Error (Value) as
  /// `add`; nothing has changed then.
  void change(int joint, const JointKind& definition);
  /// The centre of mass of a body of the joint has moved in the body's frame.
  void recentre(int joint, Vec2<Real> centre_a, Vec2<Real> centre_b);
  /// A body of the joint has become dynamic, or is no longer.
  void set_dynamic(int joint, bool dynamic_a, bool dynamic_b);
  /// rad, how bodies a and b stand, with the turns that they have come: a gear that no step has seen is put
  /// together there. Without it, such angles are in [-pi, pi].
  void meet(int joint, double angle_a, double angle_b);
  /// Forgets impulses and counted turns: a body of the joint is another one.
  void forget(int joint);
  /// Forgets impulses: a body of the joint has been put elsewhere. Its angle is the one nearest to the last.
  void put_elsewhere(int joint);

  /// Evaluates all rows at the step's start.
  void prepare(const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// Applies the impulses of the last substep.
  void warm_start(const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// Impulses that hold velocities and pull errors back softly.
  void solve(const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// Evaluates all rows at the poses after the motion and holds velocities only: takes out what pulling back
  /// put in. Springs keep their force.
  void relax(const SolverBodies<Real>& bodies, const JointStep<Real>& step);

  /// Turns back what has passed an angular limit by more than `slack`, rad, each joint by at most `most`
  /// about its common point: poses change, velocities do not. One sweep; returns whether any joint was
  /// turned. Between the motion and `relax`. Does not allocate.
  bool turn_back(const SolverBodies<Real>& bodies, Rotation<Real>* rotation, Real slack, Real most);

  // For solvers that do not relax. None of the three allocates.
  /// Evaluates all rows where bodies are now, within a step.
  void evaluate(const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// Position-based solvers start each substep without impulses.
  void begin_projection(const SolverBodies<Real>& bodies, const JointStep<Real>& step);
  /// One sweep over positions: moves and turns bodies (`rotation` is that of `bodies`) such that each joint
  /// in turn holds. Velocities are, and stay, the way since the substep's start over h. Of `step.softness`
  /// the rate is 1 / h: all of an error is taken back.
  void project(const SolverBodies<Real>& bodies, Rotation<Real>* rotation, const JointStep<Real>& step);

  /// Appends the rows of a joint where its bodies are now.
  void solver_rows(int joint, const SolverBodies<Real>& bodies, std::vector<JointSolverRow<Real>>& rows);

  /// Whether the joint is a revolute one without limits, motor and spring.
  bool is_hinge(int joint) const;
  /// Leaves such a joint to the caller: the steps here pass it over until `let_go`.
  HeldHinge<Real> hold(int joint);
  /// No joint is left to the caller any more.
  void let_go();

  /// N, the reaction over the last substep: the size of the impulse on b, times 1 / h.
  Real force(int joint, Real inverse_h) const;
  /// N m, about b's anchor, over the last substep.
  Real torque(int joint, Real inverse_h) const;

  /// How far the rigid rows and the limits are from what they hold, where bodies are now: at `position` +
  /// `moved`, with `rotation`. Springs and motors have no error.
  JointError<Real> error(int joint, const SolverBodies<Real>& bodies) const;
  /// rad, of b relative to a less the reference angle (the target, the phase): revolute, prismatic, weld,
  /// wheel, motor, ratchet, friction. It is born at the turn nearest to 0 that limits allow, and whole turns
  /// are counted from there; of revolute joints without limits, spring and motor it is in [-pi, pi].
  /// They are counted right while the bodies turn less than pi, relative to each other, in a substep.
  Real angle(int joint, const SolverBodies<Real>& bodies) const;
  /// m, of anchor b along the axis from anchor a: prismatic, wheel.
  Real translation(int joint, const SolverBodies<Real>& bodies) const;
  /// m, between the anchors: distance; length_a + ratio length_b: pulley.
  Real length(int joint, const SolverBodies<Real>& bodies) const;

  int count() const;
  int active_count() const;
  /// One more than the highest slot that was ever in use.
  int slots() const;
  bool contains(int joint) const;
  bool active(int joint) const;
  std::pair<int, int> bodies(int joint) const;
  /// Which of its bodies are said to give way.
  std::pair<bool, bool> dynamic(int joint) const;
  /// Index of the joint's colour; joints of one colour share no dynamic body, but for those of the last one,
  /// `colours() - 1`, which hold what found no place.
  int colour(int joint) const;
  static int colours();

  /// Everything that a step depends on, such that a set that is restored continues with the same bits.
  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

extern template class JointSet<float>;
extern template class JointSet<double>;

}  // namespace plumb
