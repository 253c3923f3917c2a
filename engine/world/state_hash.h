#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/world/world.h"

namespace plumb {

/// Returns a hash of all data in a snapshot of the world: contacts, impulses, trees, free slots.
/// (BasicWorld::hash covers only the bodies' state.) Worlds with equal hashes continue in the same way. The
/// hash is equal on every platform for the same calls.
template <class Real>
std::uint64_t full_hash(const BasicWorld<Real>& world);

/// Does the same in a reusable buffer; does not allocate if it is large enough.
template <class Real>
std::uint64_t full_hash(const BasicWorld<Real>& world, std::vector<std::byte>& buffer);

}  // namespace plumb
