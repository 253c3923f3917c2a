#include "bindings/python/handles.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"

namespace plumb::python {
namespace {

using py::arg;

}  // namespace

void bind_snapshots(HeldWorldClass& world) {
  world
      .def(
          "hash", [](HeldWorld& h) { return h.visit([](auto& w) { return w.hash(); }); },
          "Hash of all bodies' states: equal on every platform and in every language.")
      .def(
          "full_hash", [](HeldWorld& h) { return h.visit([](auto& w) { return full_hash(w); }); },
          "Hash of all that the future depends on.")
      .def(
          "save",
          [](HeldWorld& h) {
            const std::vector<std::byte> bytes = h.visit([](auto& w) { return save(w); });
            return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
          },
          "All that the future depends on, as bytes.")
      .def(
          "restore",
          [](HeldWorld& h, const py::buffer& given) {
            const Bytes bytes(given);
            h.leave_views();
            h.visit([&](auto& w) { restore(w, bytes.all()); });
          },
          arg("bytes"), "Goes back to a saved state; the world is unchanged if the bytes are refused.");
}

}  // namespace plumb::python
