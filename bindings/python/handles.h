#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "bindings/python/held_world.h"
#include "engine/scene/error.h"

/// Handles of a world as Python has them, and what their classes have in common.
namespace plumb::python {

// Calls of the world by way of a handle.
#define PLUMB_READ(Type, expression) \
  [](const Type& h) { return h.world->visit([&]([[maybe_unused]] auto& w) { return expression; }); }
#define PLUMB_SET(Type, Value, call) \
  [](const Type& h, Value value) { h.world->visit([&](auto& w) { call; }); }

using HeldWorldClass = py::class_<HeldWorld, WorldPointer>;

template <class Id>
py::list handles(const WorldReference& world, const std::vector<Id>& ids) {
  py::list all;
  for (const Id id : ids) all.append(Held<Id>{world, id});
  return all;
}

/// Returns the number of `handle` in `world`. Throws `Error` (Value) if it is of another world, where the
/// number would name another object.
template <class World, class Id>
Id id_in(const World& world, const Held<Id>& handle, const char* field) {
  if (!(handle.world == world))
    throw Error(Error::Kind::Value, "world", field, std::to_string(handle.id.index), "is of another world");
  return handle.id;
}

/// Returns a contact as a dict.
py::dict reading_of(const WorldReference& held, const ContactReading& c);

/// Returns the definition of a shape that is given as one, or as its geometry alone.
inline ShapeDefinition definition_of(const std::variant<ShapeDefinition, ShapeGeometry>& given) {
  if (const auto* whole = std::get_if<ShapeDefinition>(&given)) return *whole;
  ShapeDefinition shape;
  shape.geometry = std::get<ShapeGeometry>(given);
  return shape;
}

/// Adds what each handle has: index, comparison, hash and text.
template <class Class>
void bind_common(Class& type, const char* name, const char* about_index) {
  using Handle = typename Class::type;
  type.def_property_readonly(
          "index", [](const Handle& h) { return h.id.index; }, about_index)
      .def(
          "__eq__", [](const Handle& a, const Handle& b) { return a == b; }, py::is_operator())
      .def("__hash__",
           [](const Handle& h) {
             return std::hash<std::uint64_t>{}(std::uint64_t{h.id.generation} << 32 | h.id.index);
           })
      .def("__repr__", [name](const Handle& h) {
        return "<plumb." + std::string(name) + " " + std::to_string(h.id.index) + ">";
      });
}

void bind_bodies(py::module_& module);
void bind_shapes(py::module_& module);
void bind_joints(py::module_& module);
void bind_arrays(HeldWorldClass& world);
void bind_snapshots(HeldWorldClass& world);
void bind_queries(HeldWorldClass& world);
void bind_drawing(py::module_& module, HeldWorldClass& world);
void bind_laws(py::module_& module, HeldWorldClass& world);
void bind_rollback(py::module_& module);

}  // namespace plumb::python
