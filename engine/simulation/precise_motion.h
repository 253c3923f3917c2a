#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/forces/laws.h"
#include "engine/integrate/compensated.h"
#include "engine/integrate/flow.h"
#include "engine/joints/joints.h"
#include "engine/scene/scene.h"
#include "engine/simulation/driver.h"
#include "engine/simulation/precise_active.h"
#include "engine/simulation/precise_flight.h"
#include "engine/simulation/precise_hinges.h"
#include "engine/simulation/precise_joints.h"
#include "engine/simulation/precise_parts.h"
#include "engine/solve/dense_system.h"
#include "engine/solve/joint_system.h"

namespace plumb::precise {

/// The equations of motion of the integrated bodies, in maximal coordinates: y holds position, angle,
/// velocity and angular velocity of each, six numbers a body. Joints act through the accelerations that they
/// allow,
///   M a = F + J^T lambda,   J a + (dJ/dt) v = 0,
/// and so do contacts that last.
class EquationsOfMotion final : public Flow {
 public:
  static constexpr std::size_t kPerBody = 6;

  /// `every_stage`: forces and joints are gone through even where there are none.
  /// `tolerance`: of `Precise`; joints of closed loops that are off by more than it are an error.
  EquationsOfMotion(const Scene& scene, const Parts& parts, const Flight& flight, bool every_stage,
                    double tolerance);

  std::size_t dimension() const { return kPerBody * bodies_.size(); }

  /// Switched forces act with their share of this time in all that follows.
  void set_window(double start, double end) { window_start_ = start, window_end_ = end; }

  /// Puts `poses` and `twists` where bodies are in state y.
  void place(double time, std::span<const double> y);

  /// dy/dt. Counts as one evaluation.
  void rate(double time, std::span<const double> y, std::span<double> out) override;
  /// Of the forces of the last evaluation, gravity apart, and contacts that last.
  double power() const override { return power_; }
  /// The same, and `rows` and `multipliers` are those of this state then.
  void rate_with_rows(double time, std::span<const double> y, std::span<double> out);
  std::int64_t evaluations() const { return evaluations_; }
  void count_evaluation() { ++evaluations_; }
  void set_evaluations(std::int64_t count) { evaluations_ = count; }

  /// Moves positions and angles by the least mass-weighted amount that closes all joints and held contacts,
  /// to rounding; then velocities likewise until they keep them so, and what sticks from slipping. Throws
  /// `Error` (Run) where gaps cannot be closed.
  void project(double time, Compensated& y);
  /// Where bodies hang by hinges alone, and start with velocities that these do not allow: the impulses that
  /// take away what is not allowed, as if the hinges were put on in that instant. `project` then lets places
  /// and velocities follow from the angles.
  void strike_hinges(double time, Compensated& y);

  /// The parts of `rate` and `project`, for methods that hold joints in their own way; arrays by body.
  /// Accelerations by forces alone:
  void accelerate_freely(double time, std::span<const double> y, std::span<Twist<double>> out);
  /// Takes the joints' Jacobian J and factorises A = J M^-1 J^T there.
  void hold(double time, std::span<const double> y);
  /// -M^-1 J^T A^-1 C(y), with J and A of `hold`; returns the largest gap, m.
  double gap_response(double time, std::span<const double> y, std::span<Twist<double>> out);
  /// -M^-1 J^T A^-1 J v with the velocities in y, at the place of `hold`.
  void speed_response(std::span<const double> y, std::span<Twist<double>> out);
  double length() const { return length_; }  ///< m, the scene's
  /// m: what gaps cannot be less than, as differences of the positions of the last evaluation.
  double rounding_of_gaps() const;
  std::size_t body_count() const { return poses_.size(); }

  /// The least `JointSystem::weakest`, and the most dependent rows, in evaluations since `forget_rank`.
  double weakest() const { return weakest_; }
  int dependent_rows() const { return dependent_rows_; }
  void forget_rank() { weakest_ = 1, dependent_rows_ = 0; }
  /// Whether joints close loops: their rows may come to depend on each other on the way.
  bool has_loops() const { return has_loops_; }
  /// `JointSystem::weakest` in state y; zero where rows depend on others that do not always. As an evaluation
  /// without forces it is not counted.
  double weakness(double time, std::span<const double> y);
  /// Takes rows that depend on others where the last factorisation was, as dependent everywhere.
  void keep_dependent() { system_.keep_dependent(); }
  void release_dependent() { system_.release_dependent(); }
  /// Rows that the others leave less than this share of are not held by `project`, and gaps up to `open`, m,
  /// may stay; 0: all that can be held is.
  void hold_only_above(double share, double open) { system_.set_least_share(share), may_stay_open_ = open; }
  /// One step of Newton's method towards the place on the joints' manifold that is nearest to `target`: both
  /// what closes gaps and what leads towards it along the manifold. Returns how far it went, m.
  double draw_near(double time, std::span<const double> target, std::span<double> y);
  /// Takes from the velocities in y what joints do not allow.
  void allow_velocities(double time, std::span<double> y);
  /// Takes from changes of places, and of velocities, what joints do not allow where they were held last.
  void keep_allowed(std::span<double> change);
  /// Closes the gaps in y but those of rows that the others leave less than `weak` of; returns the widest gap
  /// that is left, m.
  double left_open(double time, std::span<double> y, double weak);
  /// The joint of the weakest row of the last factorisation.
  std::string weakest_joint() const;
  /// Joints some of whose rows follow from others in state y: they may be left out, or carry no force of
  /// their own.
  std::vector<std::string> redundant_joints(double time, std::span<const double> y);

  /// Contacts that last from now on: they are held as joints are, by accelerations and by `project`.
  void hold_contacts(std::vector<ActivePatch> patches);
  std::span<const ActivePatch> held() const { return patches_; }

  /// Stops of joints (`KindJoints::stops`) by how they act from now on: held as constraints, motors at their
  /// bound pushing this way (+1, -1), or not at all. Cleared by an empty list.
  enum class StopMode : signed char { Free, Held, Forward, Backward };
  void hold_stops(std::vector<StopMode> modes);
  std::span<const StopMode> stop_modes() const { return stop_modes_; }
  bool has_forces() const { return has_forces_; }
  bool holds_anything() const { return !patches_.empty() || held_stops_ > 0; }
  /// Their rows where bodies were placed last, and those at a state.
  std::span<const Row<double>> stop_rows();
  std::span<const Row<double>> stop_rows(double time, std::span<const double> y);

  /// The forces of the contacts that are held, at a state. Counts as one evaluation.
  const ContactForces& contact_forces(double time, std::span<const double> y);
  const ContactForces& last_contact_forces() const { return contact_forces_; }

  /// What unit impulses along `rows` change at the state `y`, joints included; `matrix`, row after row, the
  /// change of each row's rate by each impulse.
  void respond(double time, std::span<const double> y, std::vector<Row<double>> rows,
               ContactResponse& response, std::vector<double>& matrix);

  /// Adds the impulses along the rows of `response` to the velocities in `y`.
  void push(const ContactResponse& response, std::span<const double> impulses, Compensated& y) const;

  /// By body of the scene, as if no contact lasted; valid until the next call of anything. Zero for what is
  /// not integrated.
  std::span<const Twist<double>> accelerations_without_contacts(double time, std::span<const double> y);

  /// Adds `scale` times `response` to the velocities in `y`.
  void kick(std::span<const Twist<double>> response, double scale, Compensated& y) const;

  /// Whether what is held, joints and contacts, may do work where bodies were placed last: friction that
  /// slips, a motor that holds its speed, what is guided and moves.
  bool held_works() const;

  /// Whether gravity and hinges, of masses not far apart, are all that acts but for contacts.
  bool has_hinges_alone() const;

  /// The forces of all joints and of the contacts that are held, at a state. Not counted as an evaluation.
  Reactions reactions(double time, std::span<const double> y);

  double inverse_mass(std::size_t body) const { return inverse_mass_[body]; }
  double inverse_inertia(std::size_t body) const { return inverse_inertia_[body]; }

  std::span<const std::size_t> bodies() const { return bodies_; }

  /// As the last evaluation of `rate` found them: poses and twists by body; of `rate_with_rows`, the joints'
  /// rows and their multipliers.
  std::span<const Pose<double>> poses() const { return poses_; }
  std::span<const Twist<double>> twists() const { return twists_; }
  std::span<const Row<double>> rows() const { return rows_; }
  std::span<const double> multipliers() const { return multipliers_; }
  const Joints<double>& joints() const { return joints_; }
  const KindJoints& kind_joints() const { return kind_joints_; }
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

  // Contacts that last (precise_contact_motion.cpp).
  void find_response(std::vector<Row<double>> rows, ContactResponse& out);
  double gain(const Row<double>& row, const ContactResponse& response, std::size_t k) const;
  void find_gains(std::span<const Row<double>> rows, const ContactResponse& response,
                  std::vector<double>& matrix) const;
  void add_response(const ContactResponse& response, std::span<const double> impulses,
                    std::span<Twist<double>> motion) const;
  void linearise_contacts(bool forces);
  void solve_contacts(std::span<double> right_side);
  void press(std::span<Twist<double>> accelerations);
  void add_motors();
  void close_contacts(std::span<const Twist<double>> motion, bool gaps, std::span<Twist<double>> shift);

  std::vector<std::size_t> bodies_;  // integrated, by slot
  std::vector<int> slot_;            // by body: its place among those, or -1
  std::vector<std::size_t> guides_;  // not integrated, but with joints or at the end of a law
  const Flight& flight_;
  Vec2d gravity_;
  Forces<double> forces_;
  Joints<double> joints_;
  KindJoints kind_joints_;
  std::vector<std::string> joint_of_row_, names_;
  std::vector<JointEnd> joint_ends_;  // of the scene's joints, in its order: their bodies b
  std::vector<Row<double>> rows_, rows_elsewhere_;
  // By body of the scene. Inverse masses of contacts are those of all dynamic bodies, those of joints of the
  // integrated ones alone: joints do not move what flies.
  std::vector<double> inverse_mass_, inverse_inertia_, joint_inverse_mass_, joint_inverse_inertia_;
  std::vector<Pose<double>> poses_;
  std::vector<double> angles_;
  std::vector<Twist<double>> twists_, accelerations_;
  std::vector<Wrench<double>> wrenches_;
  JointSystem<double> system_;
  HingeLines hinges_;  // empty where there is anything else
  std::vector<double> right_side_, multipliers_;
  bool has_forces_, has_joints_, has_loops_, wide_mass_ratio_;
  double weakest_ = 1;
  int dependent_rows_ = 0;
  double power_ = 0;  // W, of the forces of the last evaluation
  double window_start_ = 0, window_end_ = 0;
  double length_ = 1, speed_ = 1;  // the scene's, m and m/s
  double tolerance_ = 0;
  double may_stay_open_ = 0;  // m, of gaps
  std::int64_t evaluations_ = 0;

  std::vector<ActivePatch> patches_;
  std::vector<Row<double>> constraints_;  // of active contacts: normals, then tangents of what sticks
  std::size_t points_ = 0;                // how many normals
  ContactResponse active_response_;
  DenseSystem contact_system_;
  std::vector<double> scale_, contact_side_, scratch_;
  ContactForces contact_forces_;

  std::vector<StopMode> stop_modes_;  // by stop
  std::size_t held_stops_ = 0, pushing_stops_ = 0;
  std::vector<Row<double>> stop_rows_;
};

}  // namespace plumb::precise
