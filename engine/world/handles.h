#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace plumb {

/// Identifies an object of a world. The generation makes it invalid when the object is gone and its index is
/// reused. A default-constructed handle is invalid.
template <class Tag>
struct Handle {
  std::uint32_t index = 0xFFFFFFFFu;
  std::uint32_t generation = 0;
  friend bool operator==(const Handle&, const Handle&) = default;
  /// Orders by index, then by generation. The order has no meaning; it is fixed, for use in maps.
  friend auto operator<=>(const Handle&, const Handle&) = default;
};

using BodyId = Handle<struct BodyTag>;
using ShapeId = Handle<struct ShapeTag>;
using JointId = Handle<struct JointTag>;
using ChainId = Handle<struct ChainTag>;

}  // namespace plumb

/// Handles are keys of unordered maps. Equal handles of two worlds have the same hash.
template <class Tag>
struct std::hash<plumb::Handle<Tag>> {
  std::size_t operator()(const plumb::Handle<Tag>& handle) const {
    return std::hash<std::uint64_t>{}(std::uint64_t{handle.generation} << 32 | handle.index);
  }
};
