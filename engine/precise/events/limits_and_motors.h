#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/driver/snapshot.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/event_search/motion_bounds.h"
#include "engine/precise/events/contact_candidate.h"
#include "engine/precise/events/impacts.h"
#include "engine/precise/integration/integrator.h"

namespace plumb::precise {

/// Limits and motors of joints. They take part in the decisions about contacts. A reached limit is a contact
/// candidate without friction and restitution, and a constraint for as long as it pushes. A motor is a
/// constraint at its speed for as long as its force suffices (a `MotorAtSpeed`), and a constant force
/// otherwise.
class LimitsAndMotors {
 public:
  LimitsAndMotors(const Scene& scene, const ScenePartition& partition, EquationsOfMotion& equations);

  bool empty() const { return modes_.empty(); }

  /// Computes the rows at a state, with the bodies' velocities; appends the limits that are reached there to
  /// `candidates`.
  void find_reached_limits(double time, std::span<const double> y, const ContactFinder& finder,
                           std::span<const BodyState> states, std::vector<ContactCandidate>& candidates);

  /// Updates the rows after impacts, including those of `candidates`. Motors that are not at their speed push
  /// from now on; returns those at their speed.
  std::vector<MotorAtSpeed> update_motors(double time, std::span<const double> y,
                                          std::span<const BodyState> states,
                                          std::vector<ContactCandidate>& candidates);

  /// Returns the rate of a motor's target speed, m/s^2 or rad/s^2; 0 without a drive.
  double target_acceleration(const MotorAtSpeed& motor, double time) const {
    return definition(motor.index).speed_at(time).first;
  }

  /// Sets the decided modes of limits and of motors at their speed (0 holds it, +1 and -1: the speed changes
  /// in that direction); `force` is the largest of their forces.
  void activate_limit(std::size_t limit);
  void set_motor_mode(const MotorAtSpeed& motor, int mode);
  void apply_modes(double force);

  /// Returns the monitored values: gaps of free limits, force margins of held limits and motors, speed errors
  /// of the other motors. A value below minus the tolerance is an event.
  double tolerance(std::size_t index) const;
  void evaluate(double time, std::span<const double> y, std::span<double> values);
  std::size_t count() const { return modes_.size(); }

  /// Declares that the last step ended at this limit: it counts as reached, even if rounding leaves a gap.
  void set_reached_limit(std::optional<std::size_t> limit) { reached_limit_ = limit; }
  bool is_free_limit(std::size_t index) const;

  /// Finds the first limit that is reached within the last step, up to `until`, and the time. C obeys
  ///   C(t + s) >= C + C' s - A s^2 / 2,
  /// A a bound on C'' from the step's polynomials. Only limits that are passed and left again within 1/4096
  /// of a step may be missed.
  struct ReachedLimit {
    double time = 0;
    std::size_t limit = 0;
  };
  std::optional<ReachedLimit> first_reached(const StepMotionBounds& bounds, EventFreeIntegrator& integrator,
                                            double until);

  /// The gap of a limit at a state, and its rate.
  struct LimitGap {
    double gap = 0, rate = 0;
  };
  LimitGap gap_of_limit(std::size_t limit, double time, std::span<const double> y);

  /// Releases limits and motors. Call it after bodies were changed from outside: nothing is held until it is
  /// decided anew.
  void release();

  /// Copies the modes from another scene of the same structure.
  void copy_modes(const LimitsAndMotors& other);

  void save(SnapshotWriter& out) const;
  void restore(SnapshotReader& in);

 private:
  using Mode = EquationsOfMotion::LimitMotorMode;
  const GeneralJoints::LimitOrMotor& definition(std::size_t k) const {
    return equations_.general_joints().limits_and_motors()[k];
  }
  std::optional<double> first_reached_time(std::size_t limit, const StepMotionBounds& bounds,
                                           EventFreeIntegrator& integrator, double until);
  double safe_step(std::size_t limit, const LimitGap& now, const StepMotionBounds& bounds, double time,
                   double until) const;
  double speed_error(std::size_t motor, double time, std::span<const Twist<double>> twists) const;

  EquationsOfMotion& equations_;
  double length_, speed_;  // the scene's
  std::vector<Mode> modes_;
  std::optional<std::size_t> reached_limit_;  // the limit at which the last step ended
  std::vector<Row<double>> rows_;             // at the motion's time
  std::vector<Twist<double>> twists_;
  double force_scale_ = 0;
  Compensated sample_;
};

}  // namespace plumb::precise
