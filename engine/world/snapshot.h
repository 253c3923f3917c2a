#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/world/world.h"

/// Serialises a world: all state that its future depends on. A restored world continues with the same bits as
/// one that was never stopped, and earlier handles stay valid. The pre-solve hook, the user's filter and
/// combine rules are code and not part of the bytes: restoring leaves those of the world unchanged. Saved
/// contacts keep their mixed coefficients.
namespace plumb {

/// Returns the bytes of a world: the same on every little-endian platform.
template <class Real>
std::vector<std::byte> save(const BasicWorld<Real>& world);

/// Saves into a reusable buffer; does not allocate if it is large enough.
template <class Real>
void save(const BasicWorld<Real>& world, std::vector<std::byte>& bytes);

/// Restores the saved state into `world`. Throws Error (Value, subject "snapshot") for bytes that are
/// damaged, truncated, or of another precision or version; the world is then unchanged.
template <class Real>
void restore(BasicWorld<Real>& world, std::span<const std::byte> bytes);

}  // namespace plumb
