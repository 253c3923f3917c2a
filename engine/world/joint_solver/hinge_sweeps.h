#pragma once

#include "engine/world/joint_solver/joint_hinge.h"

namespace plumb {

/// Plain revolute joints of one colour, in order. Fits into two registers.
template <class Real>
struct HingeRun {
  HingeConstraint<Real>* first = nullptr;
  int count = 0;
  bool apart = true;  ///< no two share a dynamic body
};

// The three iterations of JointSet over such a run: four joints at a time if they share no body, with the
// same bits as one at a time.
template <class Real>
void warm_start_hinges(HingeRun<Real> run, const SolverBodies<Real>& bodies);
template <class Real>
void solve_hinges(HingeRun<Real> run, const SolverBodies<Real>& bodies, const JointStep<Real>& step);
template <class Real>
void relax_hinges(HingeRun<Real> run, const SolverBodies<Real>& bodies, const JointStep<Real>& step);

}  // namespace plumb
