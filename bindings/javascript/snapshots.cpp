#include "bindings/javascript/buffer.h"

using namespace plumb::javascript;

extern "C" {

PLUMB_EXPORT("world_hash") std::uint64_t js_world_hash(plumb_world* w) { return plumb_world_hash(w); }
PLUMB_EXPORT("world_full_hash") std::uint64_t js_world_full_hash(plumb_world* w) {
  return plumb_world_full_hash(w);
}

PLUMB_EXPORT("world_save") std::size_t js_save(plumb_world* w) {
  bytes.resize(plumb_world_save(w, nullptr, 0));
  return plumb_world_save(w, bytes.data(), bytes.size());
}
PLUMB_EXPORT("world_restore") void js_restore(plumb_world* w) {
  plumb_world_restore(w, bytes.data(), bytes.size());
}
}
