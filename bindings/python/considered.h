#pragma once

#include <cstdint>
#include <optional>

#include "bindings/python/handles.h"
#include "engine/world/queries/query_filter.h"

namespace plumb::python {

/// The shapes that a query considers, as its keyword arguments say it. Stays in place while the query runs,
/// because the engine's filter views its condition.
class Considered {
 public:
  Considered(const WorldPointer& world, const std::optional<HeldBody>& ignore, std::uint64_t category,
             std::uint64_t mask, bool sensors, const std::optional<py::function>& condition)
      : condition_{world, condition.value_or(py::function())} {
    filter_.category = category, filter_.mask = mask, filter_.sensors = sensors;
    if (ignore) filter_.ignore = id_in(world, *ignore, "ignore");
    if (condition) filter_.condition = condition_;
  }
  Considered(const Considered&) = delete;
  Considered& operator=(const Considered&) = delete;
  const QueryFilter& filter() const { return filter_; }

 private:
  struct Condition {
    WorldReference world;
    py::object call;
    bool operator()(ShapeId shape) const {
      return returned<bool>(call(HeldShape{world, shape}), "a condition", "True or False");
    }
  };
  Condition condition_;
  QueryFilter filter_{};
};

}  // namespace plumb::python
