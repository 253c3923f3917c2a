#pragma once

#include <cstdint>

namespace plumb {

/// Names something of a world. It knows when what it names is gone: the place may be used again, with the
/// next generation. A default-constructed handle names nothing.
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
