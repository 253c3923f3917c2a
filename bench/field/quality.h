#pragma once

#include <limits>
#include <span>

#include "bench/field/builder.h"

namespace plumb::field {

/// Two shapes nearer than this are neighbours. It exceeds the distance at which Box2D's skins keep resting
/// boxes (15 mm).
inline constexpr double kNear = 0.02;  // m

/// Depth from which shapes count as overlapping; less is rounding, also in float far from the origin.
inline constexpr double kTouch = 1e-6;  // m

/// Quality of shapes and joints, measured in the same way for all engines, from poses and from the shapes
/// that the scene requested.
struct Quality {
  bool finite = true;         ///< true if no pose and no velocity is NaN or infinite
  int near = 0;               ///< pairs that may touch and are nearer than `kNear`
  int overlapping = 0;        ///< pairs that overlap
  double deepest = 0;         ///< m, the deepest penetration
  double mean_depth = 0;      ///< m, mean depth of the pairs that overlap
  double worst_joint = 0;     ///< m, the largest distance between a joint's anchors
  double mean_joint = 0;      ///< m
  double kinetic_energy = 0;  ///< J, of dynamic bodies, by the engine's velocities
  double worst_limit = 0;     ///< rad, the largest excess of a joint beyond a limit
};

Quality measure_quality(const Inventory& inventory, std::span<const BodyState> states);

/// Speed of the centres of mass of dynamic bodies, from their displacement in a step.
struct Speed {
  double rms = 0, max = 0;  ///< m/s
};

Speed measure_speed(const Inventory& inventory, std::span<const BodyState> before,
                    std::span<const BodyState> after, double dt);

/// Returns true if the scene lets two shapes collide.
bool may_touch(const ShapeDefinition& a, const ShapeDefinition& b);

}  // namespace plumb::field
