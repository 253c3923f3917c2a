#include "engine/world/state_hash.h"

#include "engine/world/checksum.h"
#include "engine/world/snapshot.h"

namespace plumb {

template <class Real>
std::uint64_t full_hash(const BasicWorld<Real>& world, std::vector<std::byte>& buffer) {
  save(world, buffer);
  return checksum(buffer);
}

template <class Real>
std::uint64_t full_hash(const BasicWorld<Real>& world) {
  std::vector<std::byte> buffer;
  return full_hash(world, buffer);
}

#define PLUMB_FOR(Real)                                      \
  template std::uint64_t full_hash(const BasicWorld<Real>&); \
  template std::uint64_t full_hash(const BasicWorld<Real>&, std::vector<std::byte>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
