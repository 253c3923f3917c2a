#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/world/world.h"

/// A world as bytes: all that its future depends on. A world that is restored goes on with the same bits as
/// one that was never stopped, and handles from before the saving name the same things after it. The
/// pre-solve hook and combine rules of the user's own are code, not part of the bytes: restoring leaves those
/// that the world has. Contacts that were saved keep the coefficients that they were mixed with.
namespace plumb {

/// The same world gives the same bytes on every platform whose numbers are little-endian.
template <class Real>
std::vector<std::byte> save(const BasicWorld<Real>& world);

/// Into a buffer that is used again: once it has the room, nothing is allocated.
template <class Real>
void save(const BasicWorld<Real>& world, std::vector<std::byte>& bytes);

/// Makes `world` the one that was saved. Throws Error (Value, subject "snapshot") for bytes that are damaged,
/// cut off, of the other precision or of another version; the world is as it was then.
template <class Real>
void restore(BasicWorld<Real>& world, std::span<const std::byte> bytes);

}  // namespace plumb
