#include "engine/world/joint_solver/joint_parts.h"
#include "engine/world/joint_solver/joint_projection.h"

/// Methods of a set of joints for solvers without relaxation.
namespace plumb {

template <class Real>
void JointSet<Real>::begin_projection(const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
  parts_->for_each_active(
      [bodies, step](auto& constraint) { plumb::begin_projection(constraint, bodies, step); });
}

template <class Real>
void JointSet<Real>::project(const SolverBodies<Real>& bodies, Rotation<Real>* rotation,
                             const JointStep<Real>& step) {
  parts_->for_each_active(
      [bodies, rotation, step](auto& constraint) { plumb::project(constraint, bodies, rotation, step); });
}

#define PLUMB_FOR(Real)                                                                              \
  template void JointSet<Real>::begin_projection(const SolverBodies<Real>&, const JointStep<Real>&); \
  template void JointSet<Real>::project(const SolverBodies<Real>&, Rotation<Real>*, const JointStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
