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
#include "engine/precise/integration/smooth.h"

namespace plumb::precise {

/// Limits and motors of joints. They take part in the decisions about contacts. A reached limit is a touch
/// without friction and restitution, and a constraint for as long as it pushes. A motor is a constraint at
/// its speed for as long as its force suffices (a `Brake`), and a constant force otherwise.
class Stops {
 public:
  Stops(const Scene& scene, const Parts& parts, EquationsOfMotion& equations);

  bool empty() const { return modes_.empty(); }

  /// Computes the rows at a state, with the bodies' velocities; appends the limits that are reached there to
  /// `touches`.
  void find(double time, std::span<const double> y, const TouchFinder& finder,
            std::span<const BodyState> states, std::vector<ContactCandidate>& touches);

  /// Updates the rows after impacts, including those of `touches`. Motors that are not at their speed push
  /// from now on; returns those at their speed.
  std::vector<Brake> push(double time, std::span<const double> y, std::span<const BodyState> states,
                          std::vector<ContactCandidate>& touches);

  /// Returns the rate of a motor's target speed, m/s^2 or rad/s^2; 0 without a drive.
  double gain_of_speed(const Brake& brake, double time) const {
    return stop(brake.stop).speed_at(time).first;
  }

  /// Sets the decided modes of limits and of brakes (0 holds, +1 and -1 yields in that direction) from now
  /// on; `force` is the largest of their forces.
  void hold(std::size_t limit);
  void take(const Brake& brake, int mode);
  void act(double force);

  /// Returns the monitored values: gaps of free limits, force margins of held stops, speeds that motors lack.
  /// A value below minus the tolerance is an event.
  double tolerance(std::size_t stop) const;
  void evaluate(double time, std::span<const double> y, std::span<double> values);
  std::size_t count() const { return modes_.size(); }

  /// Declares that the last step ended at this limit: it counts as reached, even if rounding leaves a gap.
  void meet(std::optional<std::size_t> limit) { met_ = limit; }
  bool is_free_limit(std::size_t stop) const;

  /// Finds the first limit that is reached within the last step, up to `until`, and the time. C obeys
  ///   C(t + s) >= C + C' s - A s^2 / 2,
  /// A a bound on C'' from the step's polynomials. Only limits that are passed and left again within 1/4096
  /// of a step may be missed.
  struct ReachedLimit {
    double time = 0;
    std::size_t limit = 0;
  };
  std::optional<ReachedLimit> first_reached(const StepMotionBounds& paths, EventFreeIntegrator& smooth,
                                            double until);

  /// The gap of a limit at a state, and its rate.
  struct Approach {
    double gap = 0, rate = 0;
  };
  Approach approach(std::size_t limit, double time, std::span<const double> y);

  /// Releases limits and motors. Call it after bodies were changed from outside: nothing is held until it is
  /// decided anew.
  void let_go();

  /// Takes over the modes of another scene's stops, of the same structure.
  void follow(const Stops& other);

  void save(SnapshotWriter& out) const;
  void restore(SnapshotReader& in);

 private:
  using Mode = EquationsOfMotion::StopMode;
  const GeneralJoints::Stop& stop(std::size_t k) const { return equations_.kind_joints().stops()[k]; }
  std::optional<double> first_time(std::size_t limit, const StepMotionBounds& paths,
                                   EventFreeIntegrator& smooth, double until);
  double safe_step(std::size_t limit, const Approach& now, const StepMotionBounds& paths, double time,
                   double until) const;
  double lacking(std::size_t motor, double time, std::span<const Twist<double>> twists) const;

  EquationsOfMotion& equations_;
  double length_, speed_;  // the scene's
  std::vector<Mode> modes_;
  std::optional<std::size_t> met_;  // the limit at which the last step ended
  std::vector<Row<double>> rows_;   // at the motion's time
  std::vector<Twist<double>> twists_;
  double force_scale_ = 0;
  Compensated sample_;
};

}  // namespace plumb::precise
