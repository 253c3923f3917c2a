#include "engine/world/step.h"

#include <utility>

#include "engine/world/islands.h"
#include "engine/world/quarantine.h"

namespace plumb {
namespace {

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

}  // namespace

template <class Real>
void step_world(WorldData<Real>& w, double dt, int substeps) {
  const double h = dt / substeps;
  // Let go of even when a stage throws.
  const Stepping<Real> stepping(w);
  if (w.settings.quarantine && w.loads.used()) quarantine_overloaded(w, dt);
  find_pairs(w);
  update_contacts(w, static_cast<Real>(dt), static_cast<Real>(h));
  solve_motion(w, h, substeps);
  report_impacts(w);
  finish_motion(w, static_cast<Real>(dt));
  stop_at_impacts(w, static_cast<Real>(dt));
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
