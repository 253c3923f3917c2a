#pragma once

#include <span>

#include "engine/geometry/convex_hull.h"
#include "engine/world/world_data.h"

/// Shapes are created in three steps. Everything that may throw or allocate comes first, so that a call that
/// runs out of memory changes nothing.
namespace plumb {

/// A shape that is not yet part of a body.
template <class Real>
struct NewShape {
  Corners corners;  ///< in the body's frame; for a chain's segment also its neighbours, before and after
  int count = 0;    ///< number of its own corners
  ShapeForm<Real> form{};
  ShapeRecord<Real> record{};
  std::uint64_t user_data = 0;
};

template <class Real>
NewShape<Real> prepare_shape(const ShapeDefinition& definition);
/// Prepares the segment that begins at point `index`.
template <class Real>
NewShape<Real> prepare_segment(const ChainDefinition& definition, int index);

/// Reserves memory for shapes of a body of this type.
template <class Real>
void reserve_shapes(WorldData<Real>& w, BodyType type, std::span<const NewShape<Real>> shapes);

/// Adds a shape to the body's list; the caller updates mass and tree. Does not allocate if memory is
/// reserved.
template <class Real>
int insert_shape(WorldData<Real>& w, int body, const NewShape<Real>& made);

}  // namespace plumb
