#pragma once

#include <algorithm>
#include <cmath>

#include "engine/math/vec2.h"

namespace plumb {

/// Attraction to a point, by a field that gives every mass the same acceleration.
struct Attraction {
  enum class Falloff {
    InverseSquare,  ///< strength / r^2
    Linear,         ///< strength r
  };
  double strength = 1;  ///< m^3/s^2 (inverse square) or 1/s^2 (linear); negative repels
  Falloff falloff = Falloff::InverseSquare;
  double softening = 0.1;  ///< m, > 0: below this distance the inverse square law grows linearly from 0
};

/// Returns the force (N) on `mass` (kg) at `offset` (m) from the centre of attraction.
inline Vec2d attraction_force(const Attraction& law, double mass, Vec2d offset) {
  if (law.falloff == Attraction::Falloff::Linear) return (-law.strength * mass) * offset;
  // F = -k m r / max(|r|, a)^3: outside a Newton's law, inside that of a ball of uniform density.
  const double distance = std::max(std::sqrt(length_squared(offset)), law.softening);
  return (-law.strength * mass / (distance * distance * distance)) * offset;
}

}  // namespace plumb
