#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "engine/world/handles.h"

namespace plumb {

template <class Signature>
class FunctionRef;

/// A non-owning view of a callable, without allocation. The callable must outlive it; as a parameter it may
/// view a temporary.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Function>
  requires(!std::same_as<std::remove_cvref_t<Function>, FunctionRef> &&
           std::is_invocable_r_v<Result, Function&, Arguments...>) FunctionRef(Function&& function)
      : object_(const_cast<void*>(static_cast<const void*>(&function))),
        call_([](void* object, Arguments... arguments) -> Result {
          auto& callee = *static_cast<std::remove_reference_t<Function>*>(object);
          return callee(std::forward<Arguments>(arguments)...);
        }) {}

  Result operator()(Arguments... arguments) const {
    return call_(object_, std::forward<Arguments>(arguments)...);
  }

 private:
  void* object_;
  Result (*call_)(void*, Arguments...);
};

/// A condition on shapes, as a view of a callable. The callable must be a named object and outlive the
/// filter; temporaries are rejected.
class ShapeCondition {
 public:
  ShapeCondition() = default;
  template <class Function>
  requires(!std::same_as<Function, ShapeCondition> && std::is_invocable_r_v<bool, const Function&, ShapeId>)
      ShapeCondition(const Function& function)
      : object_(&function), call_([](const void* object, ShapeId shape) -> bool {
          return (*static_cast<const Function*>(object))(shape);
        }) {}
  template <class Function>
  requires(!std::same_as<Function, ShapeCondition> && std::is_invocable_r_v<bool, const Function&, ShapeId>)
      ShapeCondition(const Function&& function)
  = delete;

  /// Returns true if a condition is set.
  bool asks() const { return call_ != nullptr; }
  bool operator()(ShapeId shape) const { return call_ == nullptr || call_(object_, shape); }

 private:
  const void* object_ = nullptr;
  bool (*call_)(const void*, ShapeId) = nullptr;
};

/// Filter of a query. The query considers a shape if one of the shape's categories is in the filter's mask,
/// and one of the filter's categories is in the shape's mask. The default considers all shapes except sensors
/// and those with an empty mask.
struct QueryFilter {
  std::uint64_t category = ~std::uint64_t{0};  ///< categories of the query
  std::uint64_t mask = ~std::uint64_t{0};      ///< categories that it considers
  bool sensors = false;                        ///< true: includes sensors
  BodyId ignore{};                             ///< a body to skip; default-constructed: none
  /// Tested last. It must not change the world: such calls throw during the query.
  ShapeCondition condition{};
};

}  // namespace plumb
