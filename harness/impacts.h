#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/scenario.h"

namespace plumb::harness {

/// What an impact of the truth does to one body, and how it comes about.
struct Jump {
  std::size_t body = 0;
  std::optional<std::size_t> partner{};  ///< the body that it meets; none: something that does not move
  Vec2d velocity{};                      ///< m/s, jump of the body's velocity
  double angular_velocity = 0;           ///< rad/s, |jump| of its angular velocity
  Vec2d normal{1, 0};                    ///< unit, along the jump
  double closing = 0;                    ///< m/s, how fast the two approach along the jump's direction
  double sliding = 0;                    ///< m/s, how fast they pass each other across it
  double distance = 0;                   ///< m, between the two centres: the lever of the contact's normal
};

struct Impact {
  double time = 0;  ///< s
  std::vector<Jump> jumps;
};

/// The impacts of the truth within the run, in order, read off its states just before and just after each.
std::vector<Impact> find_impacts(const scenarios::Problem& problem);

/// Radius about its centre of mass of the circle that holds all of a body's shapes, m.
double bounding_radius(const Body& body);

/// How far from an impact's time the states just before and after are taken, s.
inline constexpr double kImpactMargin = 1e-9;

}  // namespace plumb::harness
