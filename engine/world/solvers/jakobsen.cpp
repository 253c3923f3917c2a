#include "engine/world/contact_solver/position_contacts.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/solvers/solvers.h"

namespace plumb {

// Moves bodies by forces, then projects positions onto all constraints by iterations. The velocity is the
// displacement over h.
template <class Real>
void solve_jakobsen(WorldData<Real>& w, double h, int substeps) {
  const Real step = static_cast<Real>(h), inverse_h = static_cast<Real>(1 / h);
  const PositionStep<Real> contacts{
      .h = step, .inverse_h = inverse_h, .bounce_threshold = bounce_threshold(w, h * substeps)};
  const JointStep<Real> joints{.h = step, .inverse_h = inverse_h, .softness = {inverse_h, 1, 0}};
  const SolverBodies<Real> bodies = w.solver_bodies();
  Rotation<Real>* rotation = w.rotation.data();
  const bool jointed = w.joint_set.active_count() > 0;

  prepare_integration(w, h, substeps, Integrator::SemiImplicitEuler);
  if (jointed) w.joint_set.prepare(bodies, joints);
  for (int substep = 0; substep < substeps; ++substep) {
    if (jointed) w.joint_set.begin_projection(bodies, joints);
    begin_position_contacts(bodies.motion, w.graph);
    integrate_velocities(w);
    integrate_positions(w, step, Integrator::SemiImplicitEuler);
    for (int sweep = 0; sweep < w.settings.iterations; ++sweep) {
      if (jointed) w.joint_set.project(bodies, rotation, joints);
      project_contacts(bodies.motion, rotation, w.graph, contacts, PositionFriction::Coulomb);
      enforce_motion_locks(w);
    }
    restore_bounces(bodies.motion, w.graph, contacts);
    add_step_impulses(w);
  }
}

template void solve_jakobsen(WorldData<float>&, double, int);
template void solve_jakobsen(WorldData<double>&, double, int);

}  // namespace plumb
