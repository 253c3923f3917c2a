#pragma once

#include <cstdint>

#include "engine/driver/snapshot.h"
#include "engine/integrate/compensated.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/integration/integrator.h"

namespace plumb::precise {

/// Checks a run's energy. Over each step, the gain in kinetic and in gravitational energy equals the work of
/// the other forces. That work is summed with the step's own weights, so it is as accurate as the step.
/// Joints and contacts that hold do no work. If the balance fails, the motion is less accurate than the
/// tolerance, whatever the step's estimate says: `Error` (Run).
/// A step whose states err by `tolerance` / 1000 in its units (`Precise`) errs in energy by that fraction of
///     S = sum of m max(v, s)^2 + I max(w, s / l)^2,
/// with l and s the scene's length and speed. A thousand steps may err by `tolerance` S, plus the rounding of
/// positions and speeds.
class Invariants {
 public:
  Invariants(const Scene& scene, const ScenePartition& partition, const Precise& precise,
             EquationsOfMotion& equations);

  /// Accounts for the last step of `motion`, before any jump at its end.
  void account(const EventFreeIntegrator& motion);

  /// Returns the energy gained or lost without work, J, and the bound on it so far.
  double drift() const { return drift_; }
  double bound() const;

  void save(SnapshotWriter& out) const;
  void restore(SnapshotReader& in);

 private:
  const EquationsOfMotion& equations_;
  Vec2d gravity_;
  double tolerance_, length_, speed_;
  double drift_ = 0;       // J
  double max_energy_ = 0;  // J: the largest S so far
  double rounding_ = 0;    // J^2: sum of squares over the steps so far
  std::int64_t steps_ = 0;
};

}  // namespace plumb::precise
