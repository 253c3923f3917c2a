#pragma once

#include <array>

#include "engine/math/vec2.h"

namespace plumb::harness::thresholds {

/// The semicircular arch of `arch_thickness`.
inline constexpr int kVoussoirs = 16;
inline constexpr double kArchRadius = 10;  ///< m, of the middle of the voussoirs

/// Thickness / radius of the thinnest such arch that stands: rigid voussoirs between radial joints that do
/// not slip, with straight edges between. For ever more voussoirs it tends to 0.1075 (Milankovitch 1907;
/// Heyman 1969 has 0.106). By limit analysis: there is a line of thrust inside all joints.
inline constexpr double kThinnestArch = 0.107076203;

/// The corners of voussoir `index`, counted from the right springing, about the arch's centre, m:
/// counter-clockwise.
std::array<Vec2d, 4> voussoir(int index, double thickness);

}  // namespace plumb::harness::thresholds
