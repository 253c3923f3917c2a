#pragma once

#include "engine/world/world_data.h"

/// Bodies swept by continuous collision, and their AABBs in the broad phase meanwhile. Only for
/// continuous.cpp.
namespace plumb {

/// Sets the arm of a body hinged to a non-dynamic one: it moves on an arc about the hinge, not on a straight
/// line.
template <class Real>
void set_arm(const WorldData<Real>& w, SweptBody& flight);

/// Stores the whole swept AABB of a fast body in the tree, so that queries for other bodies find it.
template <class Real>
void insert_swept_aabb(WorldData<Real>& w, SweptBody& flight);

/// Restores the fat AABB, and adds the shapes to the move buffer.
template <class Real>
void restore_fat_aabb(WorldData<Real>& w, int body, Real dt);

/// Returns the index of a body's flight. If it has none, adds one with the motion that the solver found.
template <class Real>
int flight_place(WorldData<Real>& w, int body, double dt);

}  // namespace plumb
