#pragma once

#include "engine/forces/outline.h"
#include "engine/forces/wrench.h"

namespace plumb {

/// Moving air. Pressure acts on surfaces that face the flow; there is none on the lee side.
struct Wind {
  Vec2d velocity{};      ///< m/s; zero: air at rest, which resists motion
  double density = 1.2;  ///< kg/m^2, >= 0: of the air, for a depth of 1 m
};

/// Load of the wind on a shape of a body.
struct WindLoad {
  Wrench<double> wrench{};  ///< about the body's centre of mass
  double power = 0;         ///< W, >= 0: work rate of the forces along the wind's motion relative to the
                            ///< surface
};

/// Integrates the pressure rho/2 (u . n)^2 against the outward normal n wherever u . n < 0, where u is the
/// wind relative to the surface. For an edge, u is taken at its middle. For an arc the integral is exact for
/// the u of its centre. So a polygon of many sides has the load of a disc: 2/3 of that of a plate of the same
/// width. `shape` is relative to the body's centre of mass, which moves with `velocity` and rotates at `spin`
/// (rad/s).
WindLoad wind_load(const Wind& wind, const Convex<double>& shape, Vec2d velocity, double spin);

}  // namespace plumb
