#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "engine/driver/driver.h"
#include "engine/forces/laws.h"
#include "engine/integrate/compensated.h"
#include "engine/integrate/flow.h"
#include "engine/joints/joints.h"
#include "engine/linear_algebra/dense_system.h"
#include "engine/linear_algebra/joint_system.h"
#include "engine/precise/dynamics/active_contact.h"
#include "engine/precise/dynamics/ballistic_motion.h"
#include "engine/precise/dynamics/formula_switches.h"
#include "engine/precise/dynamics/hinge_system.h"
#include "engine/precise/dynamics/joints.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/scene/prescribed_path.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// The equations of motion of the integrated bodies, in maximal coordinates: y holds position, angle,
/// velocity and angular velocity of each, six numbers per body. Joints enter as constraints on the
/// accelerations,
///   M a = F + J^T lambda,   J a + (dJ/dt) v = 0,
/// and so do persistent contacts.
class EquationsOfMotion final : public Flow {
 public:
  static constexpr std::size_t kPerBody = 6;

  /// With `every_stage`, forces and joints are evaluated even if there are none. `tolerance` is that of
  /// `Precise`; closed loops whose joints are open by more than it are an error.
  EquationsOfMotion(const Scene& scene, const ScenePartition& partition, const BallisticMotion& ballistic,
                    bool every_stage, double tolerance);

  std::size_t dimension() const { return kPerBody * bodies_.size(); }

  /// Sets the time over which switched forces are averaged in all later calls, and lets formulas keep the
  /// pieces that they have after `end` until `next_switch`.
  void set_window(double start, double end);
  /// Returns the time after the window at which a formula passes to its next piece, s; infinity for none.
  double next_switch() const { return next_switch_; }
  /// Returns the formulas that select what they compute by the bodies' motion: zones, soft walls.
  struct FormulaWithPieces {
    const Formula* formula = nullptr;
    std::size_t variables = 0;  ///< number of them
  };
  std::span<const FormulaWithPieces> formulas_with_pieces() const { return formulas_with_pieces_; }
  /// Appends the variables of these formulas, one after another, at state y.
  void append_formula_variables(double time, std::span<const double> y, std::vector<double>& variables);

  const FormulaSwitches& switches() const { return switches_; }
  void restore_switches(double after, double end);
  /// Returns true if a prescribed body has another velocity at a switch than just before it.
  bool prescribed_velocity_jumps(double time) const;
  /// Returns the time for which formulas are evaluated: up to, but not at, the next switch.
  double formula_time(double time) const { return std::min(time, last_time_); }

  /// Sets `poses` and `twists` to state y.
  void update_poses(double time, std::span<const double> y);

  /// Computes dy/dt. Counts as one evaluation.
  void rate(double time, std::span<const double> y, std::span<double> out) override;
  /// Returns the power of the forces of the last evaluation, without gravity and persistent contacts.
  double power() const override { return power_; }
  /// Does the same; afterwards `rows` and `multipliers` are those of this state.
  void rate_with_rows(double time, std::span<const double> y, std::span<double> out);
  std::int64_t evaluations() const { return evaluations_; }
  void count_evaluation() { ++evaluations_; }
  void set_evaluations(std::int64_t count) { evaluations_ = count; }

  /// Moves positions and angles by the least mass-weighted amount that closes all joints and held contacts,
  /// to rounding. Then corrects velocities in the same way: they must keep joints and contacts closed, and
  /// sticking contacts must not slip. Throws `Error` (Run) if gaps cannot be closed.
  void project(double time, Compensated& y);
  /// For bodies that hang by hinges alone and start with velocities that the hinges do not allow: applies the
  /// impulses that remove them, as if the hinges were attached at that instant. `project` then computes
  /// positions and velocities from the angles.
  void apply_hinge_impulses(double time, Compensated& y);

  /// Parts of `rate` and `project`, for methods with their own treatment of joints; arrays by body. Computes
  /// the accelerations by forces alone.
  void free_accelerations(double time, std::span<const double> y, std::span<Twist<double>> out);
  /// Computes the joints' Jacobian J and factorises A = J M^-1 J^T at this state.
  void factorise_joints(double time, std::span<const double> y);
  /// Computes -M^-1 J^T A^-1 C(y), with J and A of `factorise_joints`; returns the largest gap, m.
  double position_correction(double time, std::span<const double> y, std::span<Twist<double>> out);
  /// Computes -M^-1 J^T A^-1 J v with the velocities in y, at the state of `factorise_joints`.
  void velocity_correction(std::span<const double> y, std::span<Twist<double>> out);
  double length() const { return length_; }  ///< m, the scene's
  /// Returns the least possible gap, m: the rounding of differences of the positions of the last evaluation.
  double rounding_of_gaps() const;
  std::size_t body_count() const { return poses_.size(); }

  /// Returns two extremes over the evaluations since `reset_rank`: the least `JointSystem::min_pivot_ratio`,
  /// and the largest number of dependent rows.
  double min_pivot_ratio() const { return min_pivot_ratio_; }
  int dependent_rows() const { return dependent_rows_; }
  void reset_rank() { min_pivot_ratio_ = 1, dependent_rows_ = 0; }
  /// Returns true if joints close loops: their rows may become dependent during the motion.
  bool has_loops() const { return has_loops_; }
  /// Returns `JointSystem::min_pivot_ratio` in state y; zero if rows are dependent other than those that
  /// always are. Not counted as an evaluation.
  double min_pivot_ratio_at(double time, std::span<const double> y);
  /// Treats rows that were dependent at the last factorisation as dependent everywhere.
  void freeze_dependent() { system_.freeze_dependent(); }
  void release_dependent() { system_.release_dependent(); }
  /// Makes `project` ignore rows with an independent fraction below `share`, and accept gaps up to `open`, m.
  /// With 0 it holds all rows that can be held.
  void ignore_weak_rows(double share, double open) {
    system_.set_pivot_threshold(share), allowed_gap_ = open;
  }
  /// Makes one step of Newton's method towards the point on the joints' manifold that is nearest to `target`:
  /// closes gaps, and moves towards `target` along the manifold. Returns the distance moved, m.
  double newton_step_towards(double time, std::span<const double> target, std::span<double> y);
  /// Removes from the velocities in y the part that joints do not allow.
  void project_velocities(double time, std::span<double> y);
  /// Removes the part that violates the joints from changes of positions and of velocities, with the rows of
  /// the last `hold`.
  void project_change(std::span<double> change);
  /// Closes the gaps in y, except for rows with an independent fraction below `weak`; returns the widest
  /// remaining gap, m.
  double remaining_gap(double time, std::span<double> y, double weak);
  /// Returns the joint of the weakest row of the last factorisation.
  std::string weakest_joint() const;
  /// Returns the joints that have redundant rows in state y. Such rows may be left out, or carry no force.
  std::vector<std::string> redundant_joints(double time, std::span<const double> y);

  /// Sets the persistent contacts: they are held as joints are, by accelerations and by `project`.
  void set_contacts(std::vector<ActiveContact> patches);
  std::span<const ActiveContact> active_contacts() const { return patches_; }

  /// Mode of a limit or motor (`GeneralJoints::limits_and_motors`): inactive, held as a constraint, or a
  /// motor saturated in either direction. `set_limit_motor_modes` sets them; an empty list clears them.
  enum class LimitMotorMode : signed char { Free, Held, Forward, Backward };
  void set_limit_motor_modes(std::vector<LimitMotorMode> modes);
  bool has_forces() const { return has_forces_; }
  bool has_active_constraints() const { return !patches_.empty() || held_limit_motors_ > 0; }
  /// Returns the rows of limits and motors at the bodies' last poses, and at a state.
  std::span<const Row<double>> limit_motor_rows();
  std::span<const Row<double>> limit_motor_rows(double time, std::span<const double> y);

  /// Computes the forces of the held contacts at a state. Counts as one evaluation.
  const ContactForces& contact_forces(double time, std::span<const double> y);
  const ContactForces& last_contact_forces() const { return contact_forces_; }

  /// Computes the response to unit impulses along `rows` at the state `y`, joints included; `matrix`, row
  /// after row, is the change of each row's rate by each impulse.
  void compute_response(double time, std::span<const double> y, std::vector<Row<double>> rows,
                        ContactResponse& response, std::vector<double>& matrix);

  /// Adds the impulses along the rows of `response` to the velocities in `y`.
  void apply_impulses(const ContactResponse& response, std::span<const double> impulses,
                      Compensated& y) const;

  /// Returns the accelerations without contacts by body of the scene; valid until the next call of any
  /// function. Zero for bodies that are not integrated.
  std::span<const Twist<double>> accelerations_without_contacts(double time, std::span<const double> y);

  /// Adds `scale` times `response` to the velocities in `y`.
  void add_velocities(std::span<const Twist<double>> response, double scale, Compensated& y) const;

  /// Returns true if held joints and contacts may do work at the bodies' last poses: slipping friction, a
  /// motor that holds its speed, a moving prescribed body.
  bool constraints_do_work() const;

  /// Returns true if, contacts apart, only gravity and hinges act, and the masses do not differ widely.
  bool has_hinges_only() const;

  /// Computes the forces of all joints and of the held contacts at a state. Not counted as an evaluation.
  Reactions reactions(double time, std::span<const double> y);

  double inverse_mass(std::size_t body) const { return inverse_mass_[body]; }
  double inverse_inertia(std::size_t body) const { return inverse_inertia_[body]; }

  std::span<const std::size_t> bodies() const { return bodies_; }

  /// Results of the last evaluation of `rate`: poses and twists by body. Of the last `rate_with_rows`: the
  /// joints' rows and their multipliers.
  std::span<const Pose<double>> poses() const { return poses_; }
  std::span<const Twist<double>> twists() const { return twists_; }
  std::span<const Row<double>> rows() const { return rows_; }
  std::span<const double> multipliers() const { return multipliers_; }
  const Joints& joints() const { return joints_; }
  const GeneralJoints& general_joints() const { return general_joints_; }
  BodiesView bodies_view() const { return {poses_, angles_, twists_}; }
  const std::string& name(std::size_t body) const { return names_[body]; }
  static BodyState state(std::span<const double> y, std::size_t slot);
  static void set_state(Compensated& y, std::size_t slot, const BodyState& state);

  /// Time spent in each part while clocks are on, ns.
  struct Cost {
    bool on = false;
    double forces = 0, joints = 0;
  };
  Cost cost;

 private:
  struct JointEnd {
    std::string joint;
    int body = kFixedFrame;
    Vec2d anchor{};  // m, in the frame of body b
  };
  void find_multipliers_with_contacts(double time, std::span<const double> y);
  static std::vector<JointEnd> ends_of_joints(const Scene& scene);
  void find_rows(std::span<Row<double>> out) const;
  bool find_loops() const;
  void linearise();
  bool uses_hinge_system() const { return !hinges_.empty() && !has_active_constraints(); }
  void accelerate_joints();
  void set_prescribed_accelerations(double time, std::span<Twist<double>> out) const;
  void set_prescribed(double time, Compensated& y) const;
  void write_rate(std::span<const double> y, std::span<double> out) const;
  void forward_kinematics(double time, Compensated& y);
  void set_next_switch(double time);
  void close_gaps(double time, Compensated& y);
  void add_displacement(std::span<const Twist<double>> shift, Compensated& y) const;
  struct WorstGap {
    double gap = 0;
    std::string subject;
  };
  WorstGap worst_gap() const;
  void check_speeds(std::span<const Twist<double>> shift) const;
  void solve_joints();
  void add_joint_response(std::span<Twist<double>> motion) const;
  double row_speed(const Row<double>& row, std::span<const Twist<double>> motion) const;

  // Persistent contacts (contact_motion.cpp).
  void find_response(std::vector<Row<double>> rows, ContactResponse& out);
  double row_response(const Row<double>& row, const ContactResponse& response, std::size_t k) const;
  void response_matrix(std::span<const Row<double>> rows, const ContactResponse& response,
                       std::vector<double>& matrix) const;
  void add_response(const ContactResponse& response, std::span<const double> impulses,
                    std::span<Twist<double>> motion) const;
  void linearise_contacts(bool forces);
  void solve_contacts(std::span<double> right_side);
  std::vector<double> decided_forces() const;
  void add_contact_accelerations(std::span<Twist<double>> accelerations);
  void add_motors();
  void close_contacts(std::span<const Twist<double>> motion, bool gaps, std::span<Twist<double>> shift);

  std::vector<std::size_t> bodies_;  // integrated, by slot
  std::vector<int> slot_;            // by body: its slot, or -1
  std::vector<std::size_t>
      ballistic_bodies_;  // prescribed bodies: not integrated, but with joints, laws or contacts
  const BallisticMotion& ballistic_;
  Vec2d gravity_;
  Forces forces_;
  Joints joints_;
  GeneralJoints general_joints_;
  std::vector<std::string> joint_of_row_, names_;
  std::vector<JointEnd> joint_ends_;  // of the scene's joints, in its order: their bodies b
  std::vector<Row<double>> rows_, trial_rows_;
  // By body of the scene. Inverse masses for contacts are those of all dynamic bodies, those for joints of
  // the integrated ones alone: joints do not move flying bodies.
  std::vector<double> inverse_mass_, inverse_inertia_, joint_inverse_mass_, joint_inverse_inertia_;
  std::vector<Pose<double>> poses_;
  std::vector<double> angles_;
  std::vector<Twist<double>> twists_, accelerations_;
  std::vector<Wrench<double>> wrenches_;
  JointSystem<double> system_;
  HingeSystem hinges_;  // empty if there is anything else
  std::vector<double> right_side_, multipliers_;
  bool has_forces_, has_joints_, has_loops_, wide_mass_ratio_;
  double min_pivot_ratio_ = 1;
  int dependent_rows_ = 0;
  double power_ = 0;  // W, of the forces of the last evaluation
  double window_start_ = 0, window_end_ = 0;
  FormulaSwitches switches_;
  std::vector<FormulaWithPieces> formulas_with_pieces_;  // of forces_
  double next_switch_ = std::numeric_limits<double>::infinity();
  double last_time_ = std::numeric_limits<double>::infinity();  // the last one before it
  double time_ = 0;                                             // s, of the last `update_poses`
  struct Prescribed {
    std::size_t body, slot;
    PrescribedPath path;
  };
  std::vector<Prescribed> prescribed_;  // bodies with a prescribed motion, which no force changes
  double length_ = 1, speed_ = 1;       // the scene's, m and m/s
  double tolerance_ = 0;
  double allowed_gap_ = 0;  // m, of gaps
  std::int64_t evaluations_ = 0;

  std::vector<ActiveContact> patches_;
  std::vector<Row<double>> constraints_;  // of active contacts: normals, then tangents of sticking ones
  std::size_t normal_count_ = 0;          // number of normals
  ContactResponse active_response_;
  DenseSystem contact_system_;
  std::vector<double> scale_, contact_right_side_, scratch_;
  ContactForces contact_forces_;

  std::vector<LimitMotorMode> limit_motor_modes_;  // by limit or motor
  std::size_t held_limit_motors_ = 0, saturated_motors_ = 0;
  std::vector<Row<double>> limit_motor_rows_;
};

}  // namespace plumb::precise
