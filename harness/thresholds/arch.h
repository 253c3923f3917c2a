#pragma once

#include <array>

#include "engine/math/vec2.h"

namespace plumb::harness::thresholds {

/// Semicircular arch of `arch_thickness`.
inline constexpr int kVoussoirs = 16;
inline constexpr double kArchRadius = 10;  ///< m, of the middle of the voussoirs

/// Thickness / radius of the thinnest such arch that stands: rigid voussoirs with straight edges between
/// radial joints that do not slip. As the number of voussoirs grows it tends to 0.1075 (Milankovitch 1907;
/// Heyman 1969 has 0.106). Found by limit analysis: the arch stands if a line of thrust exists inside all
/// joints.
inline constexpr double kThinnestArch = 0.107076203;

/// Returns the corners of voussoir `index`, counted from the right springing, relative to the arch's centre,
/// m; counter-clockwise.
std::array<Vec2d, 4> voussoir(int index, double thickness);

}  // namespace plumb::harness::thresholds
