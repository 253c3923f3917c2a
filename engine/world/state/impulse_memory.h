#pragma once

#include <algorithm>

#include "engine/world/world_data.h"

namespace plumb {

/// Returns the ratio of a substep, s, to the one that stored impulses are scaled to: warm starting scales
/// impulses by it. 1 before the first step.
template <class Real>
double warm_start_ratio(const WorldData<Real>& w, double h) {
  return w.impulse_h > 0 ? h / w.impulse_h : 1;
}

/// Keeps the impulses of contacts and joints from which iterations start, while steps change their length.
///
/// Impulses of a load are proportional to the substep h. The errors that iterations leave in them are not:
/// they follow from the velocities. After a short substep scaling by 1 / h would make these errors the larger
/// part: with steps of 1e-6 s between those of 1/60 s towers flew apart. Hence the stored impulses are those
/// of a substep of length `impulse_h`. A step at least as long replaces them. A shorter one adds to them, as
/// they are, the changes that it made to its (scaled down) impulses: load and error count by the time in
/// which they were found. `impulse_h` shrinks to shorter steps within about a step of its own length.
template <class Real>
class ImpulseMemory {
 public:
  /// Stores the impulses before a step with substeps of h, s.
  ImpulseMemory(WorldData<Real>& w, double h);
  /// Combines them with those after the step of length dt, s.
  void finish(double dt);

 private:
  WorldData<Real>& w_;
  double h_;
  bool shorter_;  ///< than the substep of the stored impulses
};

}  // namespace plumb
