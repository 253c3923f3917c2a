#pragma once

#include <span>

#include "engine/geometry/convex_hull.h"
#include "engine/world/world_data.h"

/// Shapes are made in three steps, so that a call that runs out of memory has changed nothing: all that may
/// be refused or allocate comes first.
namespace plumb {

/// A shape before it is in a body.
template <class Real>
struct NewShape {
  Corners corners;  ///< in the body's frame; a chain's segment has its neighbours before and after
  int count = 0;    ///< of corners that are its own
  ShapeForm<Real> form{};
  ShapeRecord<Real> record{};
  std::uint64_t user_data = 0;
};

template <class Real>
NewShape<Real> prepare_shape(const ShapeDefinition& definition);
/// The segment that begins at point number `which`.
template <class Real>
NewShape<Real> prepare_segment(const ChainDefinition& definition, int which);

/// Makes room for shapes of a body that has this type.
template <class Real>
void make_room_for(WorldData<Real>& w, BodyType type, std::span<const NewShape<Real>> shapes);

/// Puts a shape into the body's list; mass and tree are the caller's business. Allocates nothing once there
/// is room.
template <class Real>
int insert_shape(WorldData<Real>& w, int body, const NewShape<Real>& made);

}  // namespace plumb
