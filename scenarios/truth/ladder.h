#pragma once

#include "scenarios/truth/parts.h"

namespace plumb::scenarios::truth {

inline constexpr double kLadder = 2;  ///< m, length of the ladder of these scenes

/// Returns a uniform rod of 1 kg on a floor with friction and against a smooth wall, `angle` rad from the
/// vertical. Its shape is a thin rhombus, so that it touches with points at its very ends.
Scene ladder_scene(std::string_view name, std::string_view variant, double angle, double friction);

/// Returns the motion of that ladder, which must slip. With a the angle, w = a', c and s its cosine and sine,
/// l = L/2, the wall's force H and the floor's N:
///
///   N = m (g - l (s a'' + c w^2)),  H = m l (c a'' - s w^2) + mu N,
///   (I + m l^2 (c^2 + s (s - 2 mu c))) a'' = m l ((g - l c w^2)(s - 2 mu c) + l c s w^2)
///
/// until H = 0. From then on (without friction only), with x'' = 0: (I + m l^2 s^2) a'' = m l s (g - l c
/// w^2). Throws `Error` (Run) if it leaves the wall with friction. Source: Newton and Euler.
Truth ladder_truth(const Scene& scene, double angle, double friction, double duration);

}  // namespace plumb::scenarios::truth
