#pragma once

#include "engine/math/lanes.h"

namespace plumb {

/// Size in bytes of the widest vector register that a processor of this target may have, 0 for none. Loops
/// for wider registers are not compiled, because AVX2 exists only on x86, and these loops are half of the
/// solver's code.
#if !defined(PLUMB_VECTORS)
inline constexpr int kWidestRegister = 0;
#elif defined(__x86_64__) || defined(__i386__)
inline constexpr int kWidestRegister = 32;
#elif defined(__ARM_NEON) || defined(__wasm_simd128__)
inline constexpr int kWidestRegister = 16;
#else
inline constexpr int kWidestRegister = 0;
#endif

}  // namespace plumb
