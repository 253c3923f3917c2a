#pragma once

#include <algorithm>
#include <vector>

#include "tests/world/support.h"

/// Boxes of 1 m that lie on each other.
namespace plumb {

/// Deepest overlap of any two bodies, m.
inline double deepest(const World& world, const std::vector<BodyId>& bodies) {
  double depth = 0;
  for (const BodyId body : bodies) {
    for (const ContactReading& contact : world.contacts(body)) {
      for (int i = 0; i < contact.count; ++i) depth = std::max(depth, -contact.separations[i]);
    }
  }
  return depth;
}

/// `base` rows edge to edge on the ground at y = 0, from x = 0 on; the last is the top.
inline std::vector<BodyId> add_pyramid(World& world, int base) {
  std::vector<BodyId> boxes;
  for (int row = 0; row < base; ++row) {
    for (int i = 0; i < base - row; ++i) boxes.push_back(add_box(world, {i + 0.5 * row, 0.5 + row}));
  }
  return boxes;
}

}  // namespace plumb
