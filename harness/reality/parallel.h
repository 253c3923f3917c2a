#pragma once

#include <cstddef>
#include <future>
#include <vector>

#include "harness/interrupt.h"

namespace plumb::harness::reality {

/// Returns of(0) .. of(count - 1), computed on two threads; after an interrupt the rest are default values.
template <class Of>
auto in_parallel(std::size_t count, const Of& of) {
  std::vector<decltype(of(std::size_t{0}))> out(count);
  const auto part = [&](std::size_t first) {
    for (std::size_t i = first; i < count && !interrupted(); i += 2) out[i] = of(i);
  };
  auto other = std::async(std::launch::async, part, std::size_t{1});
  part(0);
  other.get();
  return out;
}

}  // namespace plumb::harness::reality
