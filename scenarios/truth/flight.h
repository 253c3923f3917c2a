#pragma once

#include "scenarios/truth/parts.h"

namespace plumb::scenarios::truth {

/// Returns the truth of free bodies in uniform gravity, each with at most one drag law among the scene's
/// forces: none, a linear one, or a quadratic one on a body that is dropped from rest. Source: any mechanics
/// text, e.g. Taylor, Classical Mechanics, ch. 2.
Truth flight_truth(const Scene& scene);

}  // namespace plumb::scenarios::truth
