#pragma once

#include <optional>
#include <vector>

#include "harness/course/lab.h"
#include "harness/course/student/student.h"

/// Measures in what an engine under test differs from others without being wrong.
namespace plumb::course {

/// How an engine removes an overlap: a step leaves `slop` m of it, and removes the fraction `share` of the
/// rest.
struct Push {
  double share = 0, slop = 0;
};

/// Measures it on a ball that overlaps a floor at rest; nullopt if the engine removes overlaps otherwise.
std::optional<Push> measured_push(const Lab& lab);

/// Returns the fraction of a joint's error that is left after a step, measured on a ball at rest on a stick
/// that is too long; above 1 if corrections have the wrong sign. nullopt if the engine closes joints
/// otherwise.
std::optional<double> measured_joint_error(const Lab& lab);

/// Returns the number of times that a step goes over its contacts, measured on a heavy ball on a light one,
/// which takes many; nullopt if no number up to 60 gives the engine's velocities. `like` has the other
/// figures.
std::optional<int> measured_sweeps(const Lab& lab, Manner like);

/// Returns the design variants of the learner's engine by chapter, with the measured figures in them. If a
/// mistake makes results depend on the number of iterations, variants with different numbers are included.
std::vector<Manner> manners_of(int chapter, const Lab& lab);

}  // namespace plumb::course
