#pragma once

#include <optional>
#include <vector>

#include "harness/course/lab.h"
#include "harness/course/student/student.h"

/// Measures the design of an engine under test: properties in which correct engines differ.
namespace plumb::course {

/// How an engine removes an overlap: a step leaves `slop` m of it, and removes the fraction `share` of the
/// rest.
struct Push {
  double share = 0, slop = 0;
};

/// Measures these on a ball that overlaps a floor at rest; nullopt if the engine removes overlaps in another
/// way.
std::optional<Push> measured_push(const Lab& lab);

/// Measures these on two balls of equal mass that overlap at rest, for engines that treat static bodies
/// wrongly.
std::optional<Push> measured_push_of_two(const Lab& lab);

/// Returns the fraction of a joint's error that remains after a step, measured on a ball at rest on a stick
/// that is too long by `too_long`, m, or too short if it is negative, and hangs on the world or, if
/// `free`, on a ball; above 1 if corrections have the wrong
/// sign. nullopt if the engine closes joints in another way.
std::optional<double> measured_joint_error(const Lab& lab, double too_long, bool free);

/// Returns false if the engine refuses a ball that rotates, or does not rotate it. Its contacts then cause no
/// rotation, even along a wrong normal.
bool turns_bodies(const Lab& lab);

/// Returns the number of position iterations per step over the joints, measured on two balls at rest on
/// sticks that are too long by `too_long`. Each iteration leaves the same fraction of an error; a whole step
/// leaves the fraction `left` of a single joint's error. nullopt if no number up to 30 gives the engine's
/// positions. `like` has the other properties.
std::optional<int> measured_corrections(const Lab& lab, Manner like, double left, double too_long, bool free);

/// Returns the number of iterations per step over the contacts, measured on a heavy ball on a light one,
/// which needs many iterations. nullopt if no number up to 60 gives the engine's velocities. `like` has the
/// other properties.
std::optional<int> measured_sweeps(const Lab& lab, Manner like);

/// Returns true if the engine has a property of the design, and false if it does not: the one of the two that
/// gives its places and angles after a step of a scene. nullopt if both do, or neither. `like` has the other
/// properties.
std::optional<bool> measured(const Lab& lab, const Scene& scene, Manner like, bool Manner::*property);

/// Returns the design variants of the learner's engine for a chapter, with the measured properties. If a
/// mistake makes results depend on the number of iterations, variants with different numbers are included.
std::vector<Manner> manners_of(int chapter, const Lab& lab);

}  // namespace plumb::course
