#pragma once

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "bindings/python/conversion.h"
#include "engine/world/world.h"
#include "engine/world/world_data.h"

namespace plumb::python {

/// Memory of a world that arrays view, and the arrays' owner. When the world needs other memory, the old
/// stays here until the last array is gone.
struct ViewedMemory {
  void* base = nullptr;  ///< the Python object that owns this
  std::vector<std::shared_ptr<void>> kept;
};

/// A world of either precision, shared by Python's handles.
struct HeldWorld : std::enable_shared_from_this<HeldWorld> {
  std::variant<World, DoubleWorld> world;
  std::weak_ptr<ViewedMemory> viewed;

  template <class Held>
  explicit HeldWorld(Held&& held) : world(std::forward<Held>(held)) {}

  template <class Function>
  decltype(auto) visit(Function&& function) {
    return std::visit(std::forward<Function>(function), world);
  }

  /// Leaves the viewed memory to the arrays, and goes on with a copy. Called before a change that could free
  /// it.
  void leave_views() {
    const std::shared_ptr<ViewedMemory> owner = viewed.lock();
    if (!owner) return;
    visit([&](auto& w) {
      auto& data = w.data();
      const auto leave = [&]<class Type>(std::vector<Type>& memory) {
        std::vector<Type> copy;
        copy.reserve(2 * memory.size() + 16);
        copy.assign(memory.begin(), memory.end());
        auto old = std::make_shared<std::vector<Type>>(std::move(memory));
        memory = std::move(copy);
        owner->kept.push_back(std::move(old));
      };
      leave(data.position), leave(data.motion), leave(std::get<0>(data.bodies.parts()));
    });
    viewed.reset();
  }

  /// Leaves the views if another body would not fit into the memory.
  void leave_views_if_full() {
    if (viewed.expired()) return;
    const bool full = visit([](auto& w) {
      auto& data = w.data();
      const auto& records = std::get<0>(data.bodies.parts());
      return data.position.size() == data.position.capacity() ||
             data.motion.size() == data.motion.capacity() || records.size() == records.capacity();
    });
    if (full) leave_views();
  }
};

using WorldPointer = std::shared_ptr<HeldWorld>;

}  // namespace plumb::python

namespace pybind11::detail {

/// Refuses None where a world belongs: pybind11 passes it as a null pointer to functions that take a shared
/// one.
template <>
struct type_caster<plumb::python::WorldPointer>
    : copyable_holder_caster<plumb::python::HeldWorld, plumb::python::WorldPointer> {
  bool load(handle source, bool convert) {
    return !source.is_none() &&
           copyable_holder_caster<plumb::python::HeldWorld, plumb::python::WorldPointer>::load(source,
                                                                                               convert);
  }
};

}  // namespace pybind11::detail

namespace plumb::python {

/// Handles as Python has them: each keeps its world alive.
template <class Id>
struct Held {
  WorldPointer world;
  Id id{};
  bool operator==(const Held& other) const { return world == other.world && id == other.id; }
};
using HeldBody = Held<BodyId>;
using HeldShape = Held<ShapeId>;
using HeldJoint = Held<JointId>;
using HeldChain = Held<ChainId>;

}  // namespace plumb::python
