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
  bool hinged = false;     ///< true: on a hinge; false: free, which only roots are
  Vec2d parent_anchor{};   ///< m, in the parent's frame, or in the world
  Vec2d anchor{};          ///< m, in the body's frame
  double angle = 0;        ///< rad, of the body relative to its parent, at the start
  double angle_speed = 0;  ///< rad/s, relative to the parent, at the start
};

/// The scene's dynamic bodies as trees: parents come before their children.
std::vector<Link> links_of(const Scene& scene);

/// Returns the reason why a scene is not a forest of hinges without contacts; empty if it is. Reasons:
/// another kind of joint, a loop, shapes that may touch, a hinge on a kinematic body or on one with fixed
/// rotation, motion that opens a hinge.
std::string not_a_mechanism(const Scene& scene);

}  // namespace plumb::reference
