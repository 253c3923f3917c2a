#include "engine/world/step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/world/islands.h"
#include "engine/world/quarantine.h"

namespace plumb {
namespace {

// By how much a substep may be longer than the last one, and how many times the substeps that were asked for
// a step may take for that. A pyramid of 12 rows rests under steps of random lengths from 1 to 10 as it does
// under equal ones; with 1.1 it creeps ten times as fast, and where nothing bounds the growth it flies apart
// at 1 and 3 in turn. Beyond the most (a step 60 times as long as the last) what rests is disturbed.
constexpr double kSubstepGrowth = 1.02;
constexpr int kSubstepsMost = 16;

// While it lives, events are told to the step; what happened between two steps belongs to the later one.
template <class Real>
struct Stepping {
  explicit Stepping(WorldData<Real>& world) : w(world) {
    std::swap(w.events, w.pending);
    w.pending.clear();
    w.stepping = true;
  }
  ~Stepping() { w.stepping = false; }
  WorldData<Real>& w;
};

// Impulses of the last substep start this step's first, in proportion to h. What sweeps have not converged
// grows with them, while the velocities that go with it do not: steps that are long and short in turn would
// pump it up. Overlaps at rest, which go with the square of h, would come and go besides. So a step that is
// longer than the last takes more substeps instead, and h grows by degrees. Solvers that start from nothing,
// or sweep until they converge, need none of that.
template <class Real>
int substeps_of(const WorldData<Real>& w, double dt, int asked) {
  const bool starts_warm = w.settings.solver == Solver::SoftSteps || w.settings.solver == Solver::Direct;
  if (!starts_warm || !(w.last_h > 0) || (w.graph.empty() && w.joint_set.active_count() == 0)) return asked;
  const double longest = kSubstepGrowth * w.last_h;
  if (dt <= longest * asked) return asked;
  const double wanted = std::ceil(dt / longest), most = double(kSubstepsMost) * asked;
  return static_cast<int>(std::min(wanted, most));
}

}  // namespace

template <class Real>
void step_world(WorldData<Real>& w, double dt, int substeps) {
  // Let go of even when a stage throws.
  const Stepping<Real> stepping(w);
  if (w.settings.quarantine && w.loads.used()) quarantine_overloaded(w, dt);
  find_pairs(w);
  update_contacts(w, static_cast<Real>(dt));
  substeps = substeps_of(w, dt, substeps);
  const double h = dt / substeps;
  solve_motion(w, h, substeps);
  report_impacts(w);
  finish_motion(w, static_cast<Real>(dt));
  if (w.settings.continuous) stop_at_impacts(w, static_cast<Real>(dt));
  break_joints(w, h);
  update_sensors(w);
  sleep_islands(w);
  w.time += dt;
  w.last_h = h;
  ++w.steps;
}

template void step_world(WorldData<float>&, double, int);
template void step_world(WorldData<double>&, double, int);

}  // namespace plumb
