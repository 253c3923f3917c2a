#pragma once

#include <cstddef>
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
#include "engine/precise/dynamics/active.h"
#include "engine/precise/dynamics/flight.h"
#include "engine/precise/dynamics/hinges.h"
#include "engine/precise/dynamics/joints.h"
#include "engine/precise/dynamics/parts.h"
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
  EquationsOfMotion(const Scene& scene, const Parts& parts, const Flight& flight, bool every_stage,
                    double tolerance);

  std::size_t dimension() const { return kPerBody * bodies_.size(); }

  /// Sets the time over which switched forces are averaged in all later calls.
  void set_window(double start, double end) { window_start_ = start, window_end_ = end; }

  /// Sets `poses` and `twists` to state y.
  void place(double time, std::span<const double> y);

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
  void strike_hinges(double time, Compensated& y);

  /// Parts of `rate` and `project`, for methods with their own treatment of joints; arrays by body. Computes
  /// the accelerations by forces alone.
  void accelerate_freely(double time, std::span<const double> y, std::span<Twist<double>> out);
  /// Computes the joints' Jacobian J and factorises A = J M^-1 J^T at this state.
  void hold(double time, std::span<const double> y);
  /// Computes -M^-1 J^T A^-1 C(y), with J and A of `hold`; returns the largest gap, m.
  double gap_response(double time, std::span<const double> y, std::span<Twist<double>> out);
  /// Computes -M^-1 J^T A^-1 J v with the velocities in y, at the place of `hold`.
  void speed_response(std::span<const double> y, std::span<Twist<double>> out);
  double length() const { return length_; }  ///< m, the scene's
  /// Returns the least possible gap, m: the rounding of differences of the positions of the last evaluation.
  double rounding_of_gaps() const;
  std::size_t body_count() const { return poses_.size(); }

  /// Returns two extremes over the evaluations since `forget_rank`: the least `JointSystem::weakest`, and the
  /// largest number of dependent rows.
  double weakest() const { return weakest_; }
  int dependent_rows() const { return dependent_rows_; }
  void forget_rank() { weakest_ = 1, dependent_rows_ = 0; }
  /// Returns true if joints close loops: their rows may become dependent during the motion.
  bool has_loops() const { return has_loops_; }
  /// Returns `JointSystem::weakest` in state y; zero if rows are dependent other than those that always are.
  /// Not counted as an evaluation.
  double weakness(double time, std::span<const double> y);
  /// Treats rows that were dependent at the last factorisation as dependent everywhere.
  void keep_dependent() { system_.keep_dependent(); }
  void release_dependent() { system_.release_dependent(); }
  /// Makes `project` ignore rows with an independent fraction below `share`, and accept gaps up to `open`, m.
  /// With 0 it holds all rows that can be held.
  void hold_only_above(double share, double open) { system_.set_least_share(share), may_stay_open_ = open; }
  /// Makes one step of Newton's method towards the point on the joints' manifold that is nearest to `target`:
  /// closes gaps, and moves towards `target` along the manifold. Returns the distance moved, m.
  double draw_near(double time, std::span<const double> target, std::span<double> y);
  /// Removes from the velocities in y the part that joints do not allow.
  void allow_velocities(double time, std::span<double> y);
  /// Removes the part that violates the joints from changes of positions and of velocities, with the rows of
  /// the last `hold`.
  void keep_allowed(std::span<double> change);
  /// Closes the gaps in y, except for rows with an independent fraction below `weak`; returns the widest
  /// remaining gap, m.
  double left_open(double time, std::span<double> y, double weak);
  /// Returns the joint of the weakest row of the last factorisation.
  std::string weakest_joint() const;
  /// Returns the joints that have redundant rows in state y. Such rows may be left out, or carry no force.
  std::vector<std::string> redundant_joints(double time, std::span<const double> y);

  /// Sets the persistent contacts: they are held as joints are, by accelerations and by `project`.
  void hold_contacts(std::vector<ActiveContact> patches);
  std::span<const ActiveContact> held() const { return patches_; }

  /// Mode of a stop of a joint (`GeneralJoints::stops`): inactive, held as a constraint, or a motor saturated
  /// in either direction. `hold_stops` sets them; an empty list clears them.
  enum class StopMode : signed char { Free, Held, Forward, Backward };
  void hold_stops(std::vector<StopMode> modes);
  bool has_forces() const { return has_forces_; }
  bool holds_anything() const { return !patches_.empty() || held_stops_ > 0; }
  /// Returns the stops' rows at the bodies' last poses, and at a state.
  std::span<const Row<double>> stop_rows();
  std::span<const Row<double>> stop_rows(double time, std::span<const double> y);

  /// Computes the forces of the held contacts at a state. Counts as one evaluation.
  const ContactForces& contact_forces(double time, std::span<const double> y);
  const ContactForces& last_contact_forces() const { return contact_forces_; }

  /// Computes the response to unit impulses along `rows` at the state `y`, joints included; `matrix`, row
  /// after row, is the change of each row's rate by each impulse.
  void respond(double time, std::span<const double> y, std::vector<Row<double>> rows,
               ContactResponse& response, std::vector<double>& matrix);

  /// Adds the impulses along the rows of `response` to the velocities in `y`.
  void push(const ContactResponse& response, std::span<const double> impulses, Compensated& y) const;

  /// Returns the accelerations without contacts by body of the scene; valid until the next call of any
  /// function. Zero for bodies that are not integrated.
  std::span<const Twist<double>> accelerations_without_contacts(double time, std::span<const double> y);

  /// Adds `scale` times `response` to the velocities in `y`.
  void kick(std::span<const Twist<double>> response, double scale, Compensated& y) const;

  /// Returns true if held joints and contacts may do work at the bodies' last poses: slipping friction, a
  /// motor that holds its speed, a moving prescribed body.
  bool held_works() const;

  /// Returns true if, contacts apart, only gravity and hinges act, and the masses do not differ widely.
  bool has_hinges_alone() const;

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
  const GeneralJoints& kind_joints() const { return kind_joints_; }
  BodiesNow bodies_now() const { return {poses_, angles_, twists_}; }
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
  void find_multipliers_beside_contacts(double time, std::span<const double> y);
  static std::vector<JointEnd> ends_of_joints(const Scene& scene);
  void find_rows(std::span<Row<double>> out) const;
  bool find_loops() const;
  void linearise();
  bool only_hinges() const { return !hinges_.empty() && !holds_anything(); }
  void accelerate_joints();
  void accelerate_prescribed(double time, std::span<Twist<double>> out) const;
  void keep_prescribed(double time, Compensated& y) const;
  void write_rate(std::span<const double> y, std::span<double> out) const;
  void hang(double time, Compensated& y);
  void close_gaps(double time, Compensated& y);
  void shift_places(std::span<const Twist<double>> shift, Compensated& y) const;
  struct WorstGap {
    double gap = 0;
    std::string subject;
  };
  WorstGap worst_gap() const;
  void check_speeds(std::span<const Twist<double>> shift) const;
  void solve_joints();
  void pull(std::span<Twist<double>> motion) const;
  double row_speed(const Row<double>& row, std::span<const Twist<double>> motion) const;

  // Persistent contacts (contact_motion.cpp).
  void find_response(std::vector<Row<double>> rows, ContactResponse& out);
  double gain(const Row<double>& row, const ContactResponse& response, std::size_t k) const;
  void find_gains(std::span<const Row<double>> rows, const ContactResponse& response,
                  std::vector<double>& matrix) const;
  void add_response(const ContactResponse& response, std::span<const double> impulses,
                    std::span<Twist<double>> motion) const;
  void linearise_contacts(bool forces);
  void solve_contacts(std::span<double> right_side);
  std::vector<double> decided_forces() const;
  void press(std::span<Twist<double>> accelerations);
  void add_motors();
  void close_contacts(std::span<const Twist<double>> motion, bool gaps, std::span<Twist<double>> shift);

  std::vector<std::size_t> bodies_;  // integrated, by slot
  std::vector<int> slot_;            // by body: its slot, or -1
  std::vector<std::size_t> guides_;  // prescribed bodies: not integrated, but with joints, laws or contacts
  const Flight& flight_;
  Vec2d gravity_;
  Forces forces_;
  Joints joints_;
  GeneralJoints kind_joints_;
  std::vector<std::string> joint_of_row_, names_;
  std::vector<JointEnd> joint_ends_;  // of the scene's joints, in its order: their bodies b
  std::vector<Row<double>> rows_, rows_elsewhere_;
  // By body of the scene. Inverse masses for contacts are those of all dynamic bodies, those for joints of
  // the integrated ones alone: joints do not move flying bodies.
  std::vector<double> inverse_mass_, inverse_inertia_, joint_inverse_mass_, joint_inverse_inertia_;
  std::vector<Pose<double>> poses_;
  std::vector<double> angles_;
  std::vector<Twist<double>> twists_, accelerations_;
  std::vector<Wrench<double>> wrenches_;
  JointSystem<double> system_;
  HingeLines hinges_;  // empty if there is anything else
  std::vector<double> right_side_, multipliers_;
  bool has_forces_, has_joints_, has_loops_, wide_mass_ratio_;
  double weakest_ = 1;
  int dependent_rows_ = 0;
  double power_ = 0;  // W, of the forces of the last evaluation
  double window_start_ = 0, window_end_ = 0;
  double time_ = 0;  // s, of the last `place`
  struct Prescribed {
    std::size_t body, slot;
    PrescribedPath path;
  };
  std::vector<Prescribed> prescribed_;  // bodies with a prescribed motion, which no force changes
  double length_ = 1, speed_ = 1;       // the scene's, m and m/s
  double tolerance_ = 0;
  double may_stay_open_ = 0;  // m, of gaps
  std::int64_t evaluations_ = 0;

  std::vector<ActiveContact> patches_;
  std::vector<Row<double>> constraints_;  // of active contacts: normals, then tangents of sticking ones
  std::size_t points_ = 0;                // number of normals
  ContactResponse active_response_;
  DenseSystem contact_system_;
  std::vector<double> scale_, contact_side_, scratch_;
  ContactForces contact_forces_;

  std::vector<StopMode> stop_modes_;  // by stop
  std::size_t held_stops_ = 0, pushing_stops_ = 0;
  std::vector<Row<double>> stop_rows_;
};

}  // namespace plumb::precise
