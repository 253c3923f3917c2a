#include "engine/world/contact_solver/position_contacts.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/solvers/solvers.h"

namespace plumb {

// One projection per substep, with compliance of soft constraints; more substeps replace iterations. Then
// velocities: restitution and dynamic friction.
template <class Real>
void solve_xpbd(WorldData<Real>& w, double h, int substeps) {
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
    if (jointed) w.joint_set.project(bodies, rotation, joints);
    project_contacts(bodies.motion, rotation, w.graph, contacts, PositionFriction::Static);
    enforce_motion_locks(w);
    correct_contact_velocities(bodies.motion, w.graph, contacts);
    add_step_impulses(w);
  }
}

template void solve_xpbd(WorldData<float>&, double, int);
template void solve_xpbd(WorldData<double>&, double, int);

}  // namespace plumb
