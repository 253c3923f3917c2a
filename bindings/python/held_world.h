#pragma once

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "bindings/python/collected.h"
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

/// A world of either precision. A Python object owns it, and Python's handles own that object.
struct HeldWorld : std::enable_shared_from_this<HeldWorld> {
  py::object pre_solve, filter;  ///< the user's hooks, which the world calls
  std::variant<World, DoubleWorld> world;
  std::weak_ptr<ViewedMemory> viewed;

  explicit HeldWorld(World&& held) : world(std::move(held)) {}
  explicit HeldWorld(DoubleWorld&& held) : world(std::move(held)) {}
  HeldWorld(const HeldWorld&) = delete;
  HeldWorld& operator=(const HeldWorld&) = delete;
  ~HeldWorld() {
    for_viewed_memory([](auto& memory) { return std::move(memory); });
  }

  template <class Function>
  decltype(auto) visit(Function&& function) {
    return std::visit(std::forward<Function>(function), world);
  }

  bool has_hooks() const { return pre_solve || filter; }
  /// Visits the hooks, if its Python object alone owns the world: a call that runs now needs them.
  template <class Visit>
  void traverse(Visit&& visit) const {
    if (weak_from_this().use_count() == 1) visit(pre_solve), visit(filter);
  }
  void clear() {
    visit([](auto& w) { w.on_pre_solve({}), w.on_filter({}); });
    const py::object gone[] = {std::move(pre_solve), std::move(filter)};
  }

  /// Leaves the viewed memory to the arrays, and goes on with a copy. Called before a change that could free
  /// it.
  void leave_views() {
    for_viewed_memory([]<class Type>(std::vector<Type>& memory) {
      std::vector<Type> other;
      other.reserve(2 * memory.size() + 16);
      other.assign(memory.begin(), memory.end());
      std::swap(memory, other);
      return other;
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

 private:
  /// Gives what `take(memory)` returns of each viewed array to the arrays, if there are any.
  template <class Take>
  void for_viewed_memory(Take&& take) {
    const std::shared_ptr<ViewedMemory> owner = viewed.lock();
    if (!owner) return;
    visit([&](auto& w) {
      const auto keep = [&]<class Type>(std::vector<Type>& memory) {
        owner->kept.push_back(std::make_shared<std::vector<Type>>(take(memory)));
      };
      auto& data = w.data();
      keep(data.position), keep(data.motion), keep(std::get<0>(data.bodies.parts()));
    });
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
    if (isinstance<plumb::python::HeldWorld>(source) &&
        plumb::python::constructed<plumb::python::HeldWorld>(source.ptr()) == nullptr)
      plumb::python::refuse_uninitialised();
    return !source.is_none() &&
           copyable_holder_caster<plumb::python::HeldWorld, plumb::python::WorldPointer>::load(source,
                                                                                               convert);
  }
};

}  // namespace pybind11::detail

namespace plumb::python {

/// A world by the Python object that has it, which stays as long as this.
class WorldReference {
 public:
  WorldReference() = default;
  WorldReference(const WorldPointer& world) : world_(world.get()), object_(py::cast(world)) {}
  HeldWorld* operator->() const { return world_; }
  WorldPointer pointer() const { return world_->shared_from_this(); }
  bool operator==(const WorldReference& other) const { return world_ == other.world_; }
  bool operator==(const WorldPointer& other) const { return world_ == other.get(); }
  template <class Visit>
  void traverse(Visit&& visit) const {
    visit(object_);
  }

 private:
  HeldWorld* world_ = nullptr;
  py::object object_;
};

/// Handles as Python has them: each keeps its world alive.
template <class Id>
struct Held {
  WorldReference world;
  Id id{};
  bool operator==(const Held& other) const { return world == other.world && id == other.id; }
  template <class Visit>
  void traverse(Visit&& visit) const {
    world.traverse(visit);
  }
};
using HeldBody = Held<BodyId>;
using HeldShape = Held<ShapeId>;
using HeldJoint = Held<JointId>;
using HeldChain = Held<ChainId>;

}  // namespace plumb::python
