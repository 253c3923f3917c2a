#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::reference {

/// A dynamic body in a tree of hinges, for engines whose coordinates are the joints' angles.
struct Link {
  std::size_t body = 0;    ///< in the scene
  int parent = -1;         ///< an earlier link; -1: the world
  bool hinged = false;     ///< else it is free: only roots are
  Vec2d parent_anchor{};   ///< m, in the parent's frame, or in the world
  Vec2d anchor{};          ///< m, in the body's frame
  double angle = 0;        ///< rad, of the body relative to its parent, at the start
  double angle_speed = 0;  ///< rad/s, likewise
};

/// The scene's dynamic bodies as trees: parents come before their children.
std::vector<Link> links_of(const Scene& scene);

/// Empty, or why a scene is not a forest of hinges in which nothing touches: a joint of another kind, a loop,
/// shapes that may touch, a hinge on a moving kinematic body, motion that does not fit the hinges.
std::string not_a_mechanism(const Scene& scene);

}  // namespace plumb::reference
