#pragma once

#include <limits>
#include <span>

#include "bench/field/builder.h"

namespace plumb::field {

/// Two shapes nearer than this are neighbours: more than Box2D's skins keep resting boxes apart (15 mm).
inline constexpr double kNear = 0.02;  // m

/// Shapes overlap when they do by more than this: less is rounding, of float far from the origin too.
inline constexpr double kTouch = 1e-6;  // m

/// How shapes and joints stand, by one ruler for all engines: poses, and the shapes that the scene asked for.
struct Quality {
  bool finite = true;         ///< no pose and no velocity is NaN or infinite
  int near = 0;               ///< pairs that may touch and are nearer than `kNear`
  int overlapping = 0;        ///< pairs that overlap
  double deepest = 0;         ///< m, the deepest overlap
  double mean_depth = 0;      ///< m, of those that overlap
  double worst_joint = 0;     ///< m, the widest gap between a joint's anchors
  double mean_joint = 0;      ///< m
  double kinetic_energy = 0;  ///< J, of dynamic bodies, by the engine's velocities
  double worst_limit = 0;     ///< rad, the farthest that a joint is beyond a limit
};

Quality measure_quality(const Inventory& inventory, std::span<const BodyState> states);

/// Speed of the centres of mass of dynamic bodies, by how far a step carried them.
struct Speed {
  double rms = 0, max = 0;  ///< m/s
};

Speed measure_speed(const Inventory& inventory, std::span<const BodyState> before,
                    std::span<const BodyState> after, double dt);

/// Whether the scene lets two shapes touch.
bool may_touch(const ShapeDefinition& a, const ShapeDefinition& b);

}  // namespace plumb::field
