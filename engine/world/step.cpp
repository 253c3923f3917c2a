#include "engine/world/step.h"

#include "engine/world/islands.h"

namespace plumb {

template <class Real>
void step_world(WorldData<Real>& w, double dt, int substeps) {
  const double h = dt / substeps;
  w.events.clear();
  find_pairs(w);
  update_contacts(w, static_cast<Real>(dt));
  solve_soft_steps(w, h, substeps);
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
