#include "engine/world/solvers/solvers.h"

#include "engine/world/islands/hinge_trees.h"
#include "engine/world/state/impulse_memory.h"
#include "engine/world/step/step.h"

namespace plumb {

namespace {

template <class Real>
void solve(WorldData<Real>& w, double h, int substeps) {
  switch (w.settings.solver) {
    case Solver::SoftSteps:
    case Solver::Direct:
      return solve_soft_steps(w, h, substeps);
    case Solver::SequentialImpulses:
      return solve_sequential_impulses(w, h, substeps);
    case Solver::Jakobsen:
      return solve_jakobsen(w, h, substeps);
    case Solver::Xpbd:
      return solve_xpbd(w, h, substeps);
  }
}

}  // namespace

template <class Real>
void solve_motion(WorldData<Real>& w, double h, int substeps) {
  find_hinge_trees(w);
  ImpulseMemory<Real> impulses(w, h);
  solve(w, h, substeps);
  impulses.finish(h * substeps);
}

template void solve_motion(WorldData<float>&, double, int);
template void solve_motion(WorldData<double>&, double, int);

}  // namespace plumb
