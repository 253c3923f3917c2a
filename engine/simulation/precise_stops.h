#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/simulation/precise_impacts.h"
#include "engine/simulation/precise_motion.h"
#include "engine/simulation/precise_paths.h"
#include "engine/simulation/precise_smooth.h"
#include "engine/simulation/precise_touch.h"
#include "engine/simulation/snapshot.h"

namespace plumb::precise {

/// Limits and motors of joints. They take part in what is decided for contacts: a limit that is met is a
/// touch without friction and without restitution, and a constraint for as long as it pushes; a motor is a
/// constraint at its speed for as long as its force suffices (a `Brake`), and a constant force else.
class Stops {
 public:
  Stops(const Scene& scene, const Parts& parts, EquationsOfMotion& equations);

  bool empty() const { return modes_.empty(); }

  /// Takes the rows at a state, bodies' velocities besides; adds the limits that are met there.
  void find(double time, std::span<const double> y, const TouchFinder& finder,
            std::span<const BodyState> states, std::vector<Touch>& touches);

  /// After impacts: takes the rows anew, those of `touches` too. Motors that are off their speed push from
  /// now on; returns those that are at it.
  std::vector<Brake> push(double time, std::span<const double> y, std::span<const BodyState> states,
                          std::vector<Touch>& touches);

  /// What was decided: how limits, and brakes (by mode: 0 holds, +1 and -1 gives way in that direction), act
  /// from now on; `force` is the largest of theirs.
  void hold(std::size_t limit);
  void take(const Brake& brake, int mode);
  void act(double force);

  /// What is watched while they act: of limits that are free and pass what is theirs, of forces, of what
  /// motors lack of their speed. Negative, beyond the tolerance, is an event.
  double tolerance(std::size_t stop) const;
  void evaluate(double time, std::span<const double> y, std::span<double> values);
  std::size_t count() const { return modes_.size(); }

  /// Whether the step just made ended where this limit is met: it is met whatever rounding says.
  void meet(std::optional<std::size_t> limit) { met_ = limit; }
  bool is_free_limit(std::size_t stop) const;

  /// The first limit that is met within the step just made, up to `until`, and when. C obeys
  ///   C(t + s) >= C + C' s - A s^2 / 2,
  /// A a bound on C'' from the step's polynomials: nothing is missed, but what is passed and left again
  /// within 1/4096 of a step by less than that allows for.
  struct Met {
    double time = 0;
    std::size_t limit = 0;
  };
  std::optional<Met> first_met(const StepPaths& paths, SmoothMotion& smooth, double until);

  /// Of a limit at a state: how far it is off, and how fast that changes.
  struct Approach {
    double gap = 0, rate = 0;
  };
  Approach approach(std::size_t limit, double time, std::span<const double> y);

  void save(SnapshotWriter& out) const;
  void restore(SnapshotReader& in);

 private:
  using Mode = EquationsOfMotion::StopMode;
  const KindJoints::Stop& stop(std::size_t k) const { return equations_.kind_joints().stops()[k]; }
  std::optional<double> first_time(std::size_t limit, const StepPaths& paths, SmoothMotion& smooth,
                                   double until);
  double safe_step(std::size_t limit, const Approach& now, const StepPaths& paths, double time,
                   double until) const;
  double lacking(std::size_t motor, std::span<const Twist<double>> twists) const;

  EquationsOfMotion& equations_;
  double length_, speed_;  // the scene's
  std::vector<Mode> modes_;
  std::optional<std::size_t> met_;  // the limit that the last step ended at
  std::vector<Row<double>> rows_;   // at the motion's time
  std::vector<Twist<double>> twists_;
  double force_scale_ = 0;
  Compensated sample_;
};

}  // namespace plumb::precise
