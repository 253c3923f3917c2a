#pragma once

#include <span>

#include "bench/field/definitions.h"

namespace plumb::field {

struct MassProperties {
  double mass = 0;     ///< kg
  Vec2d centre{};      ///< m, in the body's frame
  double inertia = 0;  ///< kg m^2, about the centre
};

/// Returns the mass of a body made of `shapes`, each with its density. Overlapping areas count for each
/// shape. The rounding of a polygon counts; a segment has no mass.
MassProperties mass_of(std::span<const ShapeDefinition> shapes);

}  // namespace plumb::field
