#pragma once

#include <cstdint>

namespace plumb {

/// Width of the vector registers that loops over many items use. Each gives the same bits.
enum class VectorWidth : std::uint8_t {
  None,     ///< one number at a time
  Bytes16,  ///< SSE2, NEON: available on all such processors
  Bytes32,  ///< AVX2
};

/// Returns the widest registers that this build and this processor have.
VectorWidth widest_vectors();

/// Returns the width in use: the widest, unless another was set.
VectorWidth vector_width();

/// Sets the width for all worlds, at most the widest one. For comparisons.
void set_vector_width(VectorWidth width);

}  // namespace plumb
