#include "engine/world/contact_solver/position_contacts.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/solvers/solvers.h"

// Solvers that project positions: bodies move by forces, then `iterations` iterations over all constraints
// move them back. The velocity is the displacement over h.
namespace plumb {
namespace {

// Makes a step by projections. At the end of each substep, calls `correct(contacts)`, which corrects
// velocities.
template <class Real, class Correct>
void project_positions(WorldData<Real>& w, double h, int substeps, int iterations, PositionFriction friction,
                       const Correct& correct) {
  const Real step = static_cast<Real>(h), inverse_h = static_cast<Real>(1 / h);
  const PositionStep<Real> contacts{
      .h = step, .inverse_h = inverse_h, .bounce_threshold = bounce_threshold(w, h * substeps)};
  const JointStep<Real> joints{.h = step,
                               .inverse_h = inverse_h,
                               .inverse_dt = static_cast<Real>(1 / (h * substeps)),
                               .softness = {inverse_h, 1, 0}};
  const SolverBodies<Real> bodies = w.solver_bodies();
  Rotation<Real>* rotation = w.rotation.data();
  const bool jointed = w.joint_set.active_count() > 0;

  prepare_integration(w, h, substeps, Integrator::SemiImplicitEuler);
  if (jointed) w.joint_set.prepare(bodies, joints);
  for (int substep = 0; substep < substeps; ++substep) {
    if (jointed) w.joint_set.begin_projection(bodies, joints);
    prepare_position_contacts(bodies.motion, w.graph);
    integrate_velocities(w);
    integrate_positions(w, step, Integrator::SemiImplicitEuler);
    for (int iteration = 0; iteration < iterations; ++iteration) {
      if (jointed) w.joint_set.project(bodies, rotation, joints);
      project_contacts(bodies.motion, rotation, w.graph, contacts, friction);
      enforce_motion_locks(w);
    }
    if (jointed) w.joint_set.add_loads(joints);
    correct(contacts);
    add_step_impulses(w);
  }
}

}  // namespace

template <class Real>
void solve_jakobsen(WorldData<Real>& w, double h, int substeps) {
  project_positions(
      w, h, substeps, w.settings.iterations, PositionFriction::Coulomb,
      [&](const PositionStep<Real>& contacts) { apply_restitution(w.motion.data(), w.graph, contacts); });
}

// Makes one projection per substep, with the compliance of soft constraints; more substeps replace
// iterations. Then corrects velocities for restitution and dynamic friction.
template <class Real>
void solve_xpbd(WorldData<Real>& w, double h, int substeps) {
  project_positions(w, h, substeps, 1, PositionFriction::Static, [&](const PositionStep<Real>& contacts) {
    correct_contact_velocities(w.motion.data(), w.graph, contacts);
  });
}

template void solve_jakobsen(WorldData<float>&, double, int);
template void solve_jakobsen(WorldData<double>&, double, int);
template void solve_xpbd(WorldData<float>&, double, int);
template void solve_xpbd(WorldData<double>&, double, int);

}  // namespace plumb
