#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/impacts.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// How many samples of dt lie in a run: t = 0, dt, 2 dt, ... up to the duration.
int step_count(double duration, double dt);

/// Length, speed and time that the truth reaches: what rounding and divergence are measured in.
struct Scale {
  double length = 0;         ///< m, largest |coordinate| of a body's centre
  double extent = 0;         ///< m, of the scene: spread of the bodies with their shapes, and the way they go
  double speed = 0;          ///< m/s
  double angle = 0;          ///< rad, largest |angle|, at least pi
  double angular_speed = 0;  ///< rad/s
  double impact_spin =
      0;  ///< rad/s, what the impacts would add to a spin were their arms off by length + extent
  double joint_length =
      0;                 ///< m, length + extent where there are joints: their gaps are differences of these
  double joint_arm = 1;  ///< m, from a body's centre to the nearest of its joints
  double duration = 0;   ///< s
};

/// The exact states of all bodies, evaluated once and then shared by every engine's run: on each step's
/// sample and on a finer grid between them, from which the truth's accelerations are taken.
class TruthTable {
 public:
  /// Throws `Error` (Run) when interrupted.
  TruthTable(const scenarios::Problem& problem, double dt);

  bool known() const { return !states_.empty(); }
  double dt() const { return dt_; }
  int steps() const { return steps_; }
  int refinement() const { return refinement_; }
  std::size_t bodies() const { return bodies_; }
  const Scale& scale() const { return scale_; }
  const std::vector<Impact>& impacts() const { return impacts_; }

  /// At t = sample * dt.
  std::span<const BodyState> at(int sample) const { return fine(static_cast<long>(sample) * refinement_); }
  /// At t = index * dt / refinement.
  std::span<const BodyState> fine(long index) const;
  double fine_time(long index) const;

 private:
  void measure(const Scene& scene);
  void measure_joints(const Scene& scene);

  double dt_;
  int steps_, refinement_ = 1;
  std::size_t bodies_;
  std::vector<BodyState> states_;
  std::vector<Impact> impacts_;
  Scale scale_;
};

}  // namespace plumb::harness
