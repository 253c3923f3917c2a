#pragma once

#include "bench/field/scene.h"

namespace plumb::field {

// One file per scene. The parameters follow the field's own benchmark of the same name (Box2D v3,
// shared/benchmarks.c, August 2026), so that figures can be compared with published ones.
Scene large_pyramid();
Scene many_pyramids();
Scene joint_grid();
Scene tumbler();
Scene smash();
Scene spinner();
Scene washer();
Scene rain();
Scene junkyard();
Scene compounds();

// Small worlds, which show the overhead of a step.
Scene empty();
Scene one_free_body();
Scene chain_10();
Scene pyramid_10();
Scene free_10000();

// A million bodies, for comparison with ten thousand.
Scene free_1000000();
Scene stacks_10000();
Scene stacks_1000000();

}  // namespace plumb::field
