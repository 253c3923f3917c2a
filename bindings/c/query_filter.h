#pragma once

#include "bindings/c/handle.h"
#include "engine/world/queries/query_filter.h"

namespace plumb::c {

/// A filter of a query, with the condition that it views. NULL: the defaults.
class Filtered {
 public:
  explicit Filtered(const plumb_query_filter* from) {
    if (from == nullptr) return;
    filter_.category = from->category, filter_.mask = from->mask;
    filter_.sensors = from->sensors;
    filter_.ignore = in(from->ignore);
    condition_ = {from->condition, from->context};
    if (from->condition != nullptr) filter_.condition = condition_;
  }
  Filtered(const Filtered&) = delete;
  Filtered& operator=(const Filtered&) = delete;
  const QueryFilter& get() const { return filter_; }

 private:
  struct Condition {
    bool (*call)(plumb_shape, void*) = nullptr;
    void* context = nullptr;
    bool operator()(ShapeId shape) const { return call(out(shape), context); }
  };
  Condition condition_{};
  QueryFilter filter_{};
};

}  // namespace plumb::c
