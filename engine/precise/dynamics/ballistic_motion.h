#pragma once

#include <cstddef>
#include <vector>

#include "engine/forces/laws.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Ballistic trajectories: x = x0 + v0 s + a s^2/2 with s the time since the last event of the body. Nothing
/// is summed over steps, so the only error is the formula's own rounding.
class BallisticMotion {
 public:
  BallisticMotion(const Scene& scene, const ScenePartition& partition);

  bool contains(std::size_t body) const { return slot_[body] >= 0; }

  /// Returns the motion of `body` at `time`.
  Motion at(std::size_t body, double time) const;

  /// Starts a new polynomial at `time` from `state`.
  void restart(std::size_t body, double time, const BodyState& state);

  /// Starts new polynomials at `time` for bodies with a force that is switched at this time.
  void switch_forces(double time);

  /// Data of a polynomial, for snapshots.
  struct Arc {
    double start = 0;
    Motion motion{};
  };
  std::vector<Arc>& arcs() { return arcs_; }
  const std::vector<Arc>& arcs() const { return arcs_; }

 private:
  void update_acceleration(std::size_t body, double time);

  std::vector<int> slot_;          // by body: its index in the vectors below, or -1
  std::vector<std::size_t> body_;  // by slot
  std::vector<Arc> arcs_;
  std::vector<double> inverse_mass_, inverse_inertia_;
  std::vector<std::vector<ForceLaw>> laws_;  // by slot: constant between switching times
  Vec2d gravity_;
};

}  // namespace plumb::precise
