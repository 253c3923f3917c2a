#pragma once

#include "engine/forces/outline.h"
#include "engine/forces/wrench.h"

namespace plumb {

/// Moving air. Pressure acts where a surface faces the flow; the lee side feels none.
struct Wind {
  Vec2d velocity{};      ///< m/s; zero: air at rest, which resists motion
  double density = 1.2;  ///< kg/m^2, >= 0: of the air, for a depth of 1 m
};

/// What the wind does to a shape of a body.
struct WindLoad {
  Wrench<double> wrench{};  ///< about the body's centre of mass
  double power = 0;         ///< W, >= 0: of the forces along the wind's motion relative to the surface
};

/// Pressure rho/2 (u . n)^2 against the outward normal n wherever u . n < 0, u the wind relative to the
/// surface. Each edge feels it at its middle; over a rounding its integral is exact, with u of the rounding's
/// centre, so that a polygon of many sides feels what a disc does: 2/3 of a plate as wide. `shape` is seen
/// from the body's centre of mass, which moves with `velocity` and spins at `spin` (rad/s).
WindLoad wind_load(const Wind& wind, const Convex<double>& shape, Vec2d velocity, double spin);

}  // namespace plumb
