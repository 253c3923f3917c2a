#pragma once

#include "scenarios/truth/parts.h"

namespace plumb::scenarios::truth {

/// Returns `scene` with a fixed cylinder of 1 m about the origin and a disc of 0.25 m at rest on it, `angle`
/// rad from its top towards +x.
Scene cylinder_scene(Scene scene, double angle, double friction);

/// Returns the disc's motion. With a the angle, l the distance between the centres, n = g cos a - l a'^2 the
/// normal force over the mass and r the disc's radius:
///   rolling    l a'' = (2/3) g sin a, until (g sin a)/3 = mu n;
///   slipping l a'' = g sin a - mu n, r w' = -2 mu n, until n = 0 (from the start if there is no friction);
///   flying     a parabola.
/// Source: Newton and Euler with Coulomb friction.
Truth cylinder_truth(const Scene& scene, double angle, double friction, double duration);

}  // namespace plumb::scenarios::truth
