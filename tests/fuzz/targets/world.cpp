// Bytes as calls of a world: bodies, shapes and joints come, change and go, forces act, queries are asked,
// and after every step what must hold of a world does.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/support/world_checks.h"
#include "tests/fuzz/support/world_player.h"

namespace plumb::fuzz {
namespace {

template <class Real>
void play(ByteSource& in) {
  WorldPlayer<Real> player(in);
  if (player.play()) check_world(player.world());
}

}  // namespace
}  // namespace plumb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  plumb::fuzz::ByteSource in({data, size});
  const int kind = in.byte();
  in.set_extreme(kind & 2);
  if (kind & 1) {
    plumb::fuzz::play<double>(in);
  } else {
    plumb::fuzz::play<float>(in);
  }
  return 0;
}
