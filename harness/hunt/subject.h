#pragma once

#include <vector>

#include "harness/hunt/case.h"

/// Facts about a case that several judges need.
namespace plumb::harness::hunt {

/// The largest distance of a point of the body from its centre of mass, m; of one without shapes that of the
/// farthest anchor.
std::vector<double> reaches(const Scene& scene);

/// The smallest reach of a dynamic body, m; 1 where there is none.
double typical_size(const Scene& scene);

/// The largest reach of a dynamic body, m; 1 where there is none.
double largest_size(const Scene& scene);

/// Whether a joint keeps two bodies from touching.
bool joined(const Scene& scene, std::size_t a, std::size_t b);

/// Whether something does work on the bodies without a bound that the scene states: moving kinematic bodies,
/// surfaces that run, forces that depend on time, things that are done while it runs.
bool driven(const Case& one);

/// J: the most that motors with a speed may have done by `time`, and what springs of joints and motors that
/// follow a pose hold at the start at most.
double stored(const Scene& scene, double time);

/// Whether no two shapes that may touch lie in each other at the start, by more than a hundredth of the
/// smaller.
bool starts_apart(const Scene& scene);

/// Whether all joints and limits fit at the start, within 1 % of the smallest body and 0.01 rad.
bool starts_closed(const Scene& scene);

}  // namespace plumb::harness::hunt
