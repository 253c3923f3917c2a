#include "engine/world/contact_solver/sequential_contacts.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/solvers/driven_contacts.h"
#include "engine/world/solvers/error_feedback.h"
#include "engine/world/solvers/solvers.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/impulse_memory.h"

namespace plumb {

// Makes steps of semi-implicit Euler: integrates forces, iterates over all velocity constraints, feeds
// position errors back, then moves the bodies.
template <class Real>
void solve_sequential_impulses(WorldData<Real>& w, double h, int substeps) {
  const Real inverse_h = static_cast<Real>(1 / h),
             feedback_rate = static_cast<Real>(tuning::kBaumgarteFraction / h);
  const Real warm_start = static_cast<Real>(warm_start_ratio(w, h));
  SequentialStep<Real> contacts{.h = static_cast<Real>(h),
                                .inverse_h = inverse_h,
                                .warm_start = warm_start,
                                .bounce_threshold = bounce_threshold(w, h * substeps)};
  const JointStep<Real> joints{.h = static_cast<Real>(h),
                               .inverse_h = inverse_h,
                               .inverse_dt = static_cast<Real>(1 / (h * substeps)),
                               .softness = {0, 1, 0},
                               .max_stiffness = max_spring_stiffness<Real>(w.settings.iterations),
                               .stiff_rate = feedback_rate,
                               .warm_start = warm_start};
  const SolverBodies<Real> bodies = w.solver_bodies();
  const bool jointed = w.joint_set.active_count() > 0;

  prepare_integration(w, h, substeps, Integrator::SemiImplicitEuler);
  if (jointed) w.joint_set.prepare(bodies, joints);
  const bool driven = mark_driven_contacts(w);
  if (driven) set_driver_loads(w);
  for (int substep = 0; substep < substeps; ++substep) {
    integrate_velocities(w);
    if (jointed) w.joint_set.warm_start(bodies, joints);
    warm_start_sequentially(bodies.motion, w.graph, contacts);
    for (int iteration = 0; iteration < w.settings.iterations; ++iteration) {
      if (jointed) w.joint_set.solve(bodies, joints);
      iterate_contacts(bodies.motion, w.graph, contacts);
    }
    if (jointed) w.joint_set.add_loads(joints);
    feed_back_errors(w, feedback_rate);
    integrate_positions(w, static_cast<Real>(h), Integrator::SemiImplicitEuler);
    stop_closed_gaps(bodies.motion, w.graph, contacts);
    add_step_impulses(w);
    if (jointed && substep + 1 < substeps) w.joint_set.evaluate(bodies, joints);
    contacts.warm_start = 1;
  }
  if (driven) unmark_driven_contacts(w);
}

template void solve_sequential_impulses(WorldData<float>&, double, int);
template void solve_sequential_impulses(WorldData<double>&, double, int);

}  // namespace plumb
