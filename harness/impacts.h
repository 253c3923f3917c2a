#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/scenario.h"

namespace plumb::harness {

/// Effect of an impact in the exact motion on one body, with its geometry.
struct Jump {
  std::size_t body = 0;
  std::optional<std::size_t> partner{};  ///< the other body of the impact; none if it is not dynamic
  Vec2d velocity{};                      ///< m/s, jump of the body's velocity
  double angular_velocity = 0;           ///< rad/s, |jump| of its angular velocity
  Vec2d normal{1, 0};                    ///< unit, along the jump
  double closing = 0;                    ///< m/s, approach speed along the jump's direction
  double sliding = 0;                    ///< m/s, relative speed across it
  double distance = 0;                   ///< m, between the two centres: lever arm of the contact's normal
};

struct Impact {
  double time = 0;  ///< s
  std::vector<Jump> jumps;
};

/// Finds the impacts of the truth within the run, in order, from its states just before and just after each.
std::vector<Impact> find_impacts(const scenarios::Problem& problem);

/// Returns the radius, m, of the circle about the centre of mass that holds all of a body's shapes.
double bounding_radius(const Body& body);

/// Offset from an impact's time of the states taken just before and after it, s.
inline constexpr double kImpactMargin = 1e-9;

}  // namespace plumb::harness
