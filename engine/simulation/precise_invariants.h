#pragma once

#include <cstdint>

#include "engine/integrate/compensated.h"
#include "engine/simulation/precise_motion.h"
#include "engine/simulation/precise_smooth.h"
#include "engine/simulation/snapshot.h"

namespace plumb::precise {

/// Keeps account of a run's energy: over each step of the motion, what bodies gain of kinetic energy and of
/// height is the work of the other forces, which the step's own weights add up as exactly as the step itself.
/// Joints and contacts that hold do none. Where it does not come out even, the motion is not what the
/// tolerance promises, whatever the step's estimate says: `Error` (Run).
///
/// A step whose states err by `tolerance` / 1000 in its units (`Precise`) errs in energy by that share of
///   S = sum of m max(v, s)^2 + I max(w, s / l)^2,   l and s the scene's length and speed;
/// a thousand steps may come to `tolerance` S, and what rounding makes of positions and speeds comes on top.
class Invariants {
 public:
  Invariants(const Scene& scene, const Parts& parts, const Precise& precise, EquationsOfMotion& equations);

  /// The step that `motion` has just made, before anything jumps at its end.
  void account(const SmoothMotion& motion);

  /// J: what came up, or was lost, without work; and the most that this may be by now.
  double drift() const { return drift_; }
  double bound() const;

  void save(SnapshotWriter& out) const;
  void restore(SnapshotReader& in);

 private:
  const EquationsOfMotion& equations_;
  Vec2d gravity_;
  double tolerance_, length_, speed_;
  double drift_ = 0;     // J
  double most_ = 0;      // J: the largest S so far
  double rounding_ = 0;  // J^2: of the steps so far
  std::int64_t steps_ = 0;
};

}  // namespace plumb::precise
