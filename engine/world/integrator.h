#pragma once

#include <cstdint>

namespace plumb {

/// Integration of velocities and positions by the solvers SoftSteps and Direct. The other solvers are
/// semi-implicit by construction. The two Euler schemes are included for comparison with textbooks.
enum class Integrator : std::uint8_t {
  VelocityVerlet,     ///< second order; free flight under constant force is exact
  SemiImplicitEuler,  ///< first order: v += h a, then x += h v; falls g h t / 2 too far
  ExplicitEuler,      ///< first order: x += h v, then v += h a; falls g h t / 2 too little; gains energy
};

}  // namespace plumb
