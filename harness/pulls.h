#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::harness {

/// Linearised force of a spring or an attraction on a body. The bounds need its change with errors of
/// position and velocity.
struct Pull {
  std::size_t body = 0;
  std::optional<std::size_t> partner{};
  double arm = 0, partner_arm = 0;               ///< m, of the points
  double stiffness = 0, damping = 0, force = 0;  ///< N/m, N s/m, N
};

/// Returns the linearised forces on each body that such a law acts on. A spring's force changes by k along it
/// and by T/l across; an attraction's by max(n, 1) F/r.
std::vector<Pull> pulls_in(const Scene& scene, std::span<const BodyState> states);

}  // namespace plumb::harness
