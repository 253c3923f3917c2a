#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include "engine/world/handles.h"

namespace plumb {

template <class Signature>
class FunctionRef;

/// A view of something that can be called; it owns nothing and allocates nothing. What it views must outlive
/// it: as a parameter it may view a temporary.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Function>
  requires(!std::same_as<std::remove_cvref_t<Function>, FunctionRef> &&
           std::is_invocable_r_v<Result, Function&, Arguments...>) FunctionRef(Function&& function)
      : object_(const_cast<void*>(static_cast<const void*>(std::addressof(function)))),
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

/// A condition on shapes that a filter views. It must have a name and outlive the filter; temporaries are
/// refused.
class ShapeCondition {
 public:
  ShapeCondition() = default;
  template <class Function>
  requires(!std::same_as<Function, ShapeCondition> && std::is_invocable_r_v<bool, const Function&, ShapeId>)
      ShapeCondition(const Function& function)
      : object_(std::addressof(function)), call_([](const void* object, ShapeId shape) -> bool {
          return (*static_cast<const Function*>(object))(shape);
        }) {}
  template <class Function>
  requires(!std::same_as<Function, ShapeCondition> && std::is_invocable_r_v<bool, const Function&, ShapeId>)
      ShapeCondition(const Function&& function)
  = delete;

  /// Whether there is one.
  bool asks() const { return call_ != nullptr; }
  bool operator()(ShapeId shape) const { return call_ == nullptr || call_(object_, shape); }

 private:
  const void* object_ = nullptr;
  bool (*call_)(const void*, ShapeId) = nullptr;
};

/// Which shapes a query sees: those whose category is in its mask, and whose mask has one of its categories.
/// By default all but sensors and shapes whose mask is empty.
struct QueryFilter {
  std::uint32_t category = 0xFFFFFFFFu;  ///< what the query counts as
  std::uint32_t mask = 0xFFFFFFFFu;      ///< what it looks for
  bool sensors = false;                  ///< whether it sees sensors too
  BodyId ignore{};                       ///< a body that it does not see
  ShapeCondition condition{};            ///< asked last; must not change the world, which refuses that
};

}  // namespace plumb
