#include "bindings/javascript/buffer.h"

using namespace plumb::javascript;

extern "C" {

PLUMB_EXPORT("world_hash") std::uint64_t js_world_hash(plumb_world* w) { return plumb_world_hash(w); }
PLUMB_EXPORT("world_full_hash") std::uint64_t js_world_full_hash(plumb_world* w) {
  return plumb_world_full_hash(w);
}

PLUMB_EXPORT("rollback_create") plumb_rollback* js_rollback_create(plumb_world* w, int frames) {
  return plumb_rollback_create(w, frames);
}
PLUMB_EXPORT("rollback_destroy") void js_rollback_destroy(plumb_rollback* r) { plumb_rollback_destroy(r); }
PLUMB_EXPORT("rollback_save") void js_rollback_save(plumb_rollback* r) { plumb_rollback_save(r); }
PLUMB_EXPORT("rollback_back_to") void js_rollback_back_to(plumb_rollback* r, double step) {
  plumb_rollback_back_to(r, static_cast<std::int64_t>(step));
}
PLUMB_EXPORT("rollback_range") double* js_rollback_range(plumb_rollback* r) {
  return Writer()
      .add(static_cast<double>(plumb_rollback_oldest(r)))
      .add(static_cast<double>(plumb_rollback_latest(r)))
      .add(plumb_rollback_size(r))
      .done();
}
PLUMB_EXPORT("rollback_holds") int js_rollback_holds(plumb_rollback* r, double step) {
  return plumb_rollback_holds(r, static_cast<std::int64_t>(step));
}

PLUMB_EXPORT("world_save") std::size_t js_save(plumb_world* w) {
  bytes.resize(plumb_world_save(w, nullptr, 0));
  return plumb_world_save(w, bytes.data(), bytes.size());
}
PLUMB_EXPORT("world_restore") void js_restore(plumb_world* w) {
  plumb_world_restore(w, bytes.data(), bytes.size());
}
}
