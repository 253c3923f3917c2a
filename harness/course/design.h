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

/// Returns false if the engine refuses a ball that turns, or does not turn it: its contacts then spin
/// nothing, along a wrong normal as well.
bool turns_bodies(const Lab& lab);

/// Returns the number of times that a step goes over the errors of its joints, measured on two balls at rest
/// on sticks that are too long; each time leaves the same fraction of an error, and a step leaves `left` of a
/// single one. nullopt if no number up to 30 gives the engine's positions. `like` has the other figures.
std::optional<int> measured_corrections(const Lab& lab, Manner like, double left);

/// Returns the number of times that a step goes over its contacts, measured on a heavy ball on a light one,
/// which takes many; nullopt if no number up to 60 gives the engine's velocities. `like` has the other
/// figures.
std::optional<int> measured_sweeps(const Lab& lab, Manner like);

/// Returns the design variants of the learner's engine by chapter, with the measured figures in them. If a
/// mistake makes results depend on the number of iterations, variants with different numbers are included.
std::vector<Manner> manners_of(int chapter, const Lab& lab);

}  // namespace plumb::course
