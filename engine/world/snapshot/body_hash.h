#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/checksum.h"
#include "engine/world/snapshot/world_members.h"

namespace plumb {

/// Index of a body and the hash of its state, as recordings store them.
struct BodyHash {
  std::uint32_t body = 0, hash = 0;
  friend bool operator==(const BodyHash&, const BodyHash&) = default;
};
PLUMB_MEMBERS(BodyHash, body, hash)

/// Hashes all awake bodies, in the order of their indices.
template <class Real>
void hash_awake_bodies(const WorldData<Real>& w, std::vector<BodyHash>& hashes) {
  hashes.clear();
  for (int body = 0; body < w.bodies.size(); ++body) {
    if (!w.bodies.used(body) || !w.bodies[body].awake) continue;
    std::byte bytes[3 * sizeof(double) + 3 * sizeof(Real)];
    std::byte* to = bytes;
    const auto add = [&to](const auto& value) {
      std::memcpy(to, &value, sizeof(value));
      to += sizeof(value);
    };
    const SolverBody<Real>& motion = w.motion[body];
    add(w.position[body].x), add(w.position[body].y), add(w.bodies[body].angle);
    add(motion.velocity.x), add(motion.velocity.y), add(motion.angular_velocity);
    const std::uint64_t hash = checksum(bytes);
    hashes.push_back({static_cast<std::uint32_t>(body), static_cast<std::uint32_t>(hash)});
  }
}

}  // namespace plumb
