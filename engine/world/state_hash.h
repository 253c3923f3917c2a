#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/world/world.h"

namespace plumb {

/// Over everything that a snapshot of the world holds: contacts, impulses, trees, free places, where
/// BasicWorld::hash is over the bodies' state alone. Worlds that it finds equal go on alike. Equal on every
/// platform for the same calls.
template <class Real>
std::uint64_t full_hash(const BasicWorld<Real>& world);

/// The same with a buffer to work in: once it has the room, nothing is allocated.
template <class Real>
std::uint64_t full_hash(const BasicWorld<Real>& world, std::vector<std::byte>& buffer);

}  // namespace plumb
