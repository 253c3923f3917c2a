#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/impacts.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// Returns the number of steps of dt in a run: samples lie at t = 0, dt, 2 dt, ... up to the duration.
int step_count(double duration, double dt);

/// Largest length, speed and time of the truth: the units of rounding and divergence.
struct Scale {
  double length = 0;         ///< m, largest |coordinate| of a body's centre
  double extent = 0;         ///< m, of the scene: extent of all positions of the bodies with their shapes
  double speed = 0;          ///< m/s
  double angle = 0;          ///< rad, largest |angle|, at least pi
  double angular_speed = 0;  ///< rad/s
  double impact_spin =
      0;  ///< rad/s, spin that the impacts would add if their lever arms were off by length + extent
  double joint_length =
      0;  ///< m, length + extent if there are joints: their gaps are differences of such coordinates
  double joint_arm = 1;  ///< m, from a body's centre to the nearest of its joints
  double duration = 0;   ///< s
};

/// Exact states of all bodies, evaluated once and shared by every engine's run. They are stored for each
/// step's sample and on a finer grid in between, from which the truth's accelerations are computed.
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

  /// Returns the states at t = sample * dt.
  std::span<const BodyState> at(int sample) const { return fine(static_cast<long>(sample) * refinement_); }
  /// Returns the states at t = index * dt / refinement.
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
