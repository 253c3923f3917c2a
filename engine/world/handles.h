#pragma once

#include <cstdint>

namespace plumb {

/// Identifies an object of a world. The generation makes it invalid when the object is gone and its index is
/// reused. A default-constructed handle is invalid.
template <class Tag>
struct Handle {
  std::uint32_t index = 0xFFFFFFFFu;
  std::uint32_t generation = 0;
  friend bool operator==(const Handle&, const Handle&) = default;
};

using BodyId = Handle<struct BodyTag>;
using ShapeId = Handle<struct ShapeTag>;
using JointId = Handle<struct JointTag>;
using ChainId = Handle<struct ChainTag>;

}  // namespace plumb
