#pragma once

#include <gtest/gtest.h>

#include <string>

#include "engine/math/vector_width.h"

namespace plumb::test {

/// Calls `act(width)` with each width of registers that this build and processor have in use, widest last.
template <class Act>
void at_each_vector_width(Act&& act) {
  struct Restored {
    VectorWidth width = vector_width();
    ~Restored() { set_vector_width(width); }
  } const restored;
  for (const VectorWidth width : {VectorWidth::None, VectorWidth::Bytes16, VectorWidth::Bytes32}) {
    if (width > widest_vectors()) continue;
    SCOPED_TRACE("vector width " + std::to_string(static_cast<int>(width)));
    set_vector_width(width);
    ASSERT_EQ(vector_width(), width);
    act(width);
  }
}

}  // namespace plumb::test
