#pragma once

#include "engine/world/world_data.h"

/// Bodies swept by continuous collision, and their AABBs in the broad phase meanwhile. Only for
/// continuous.cpp.
namespace plumb {

/// Sets the arm of a body hinged to a non-dynamic one, which moves on an arc about the hinge.
template <class Real>
void set_arm(const WorldData<Real>& w, SweptBody& swept);

/// Enlarges the proxies of a body to its swept AABB, so that queries for other bodies find it.
template <class Real>
void insert_swept_aabb(WorldData<Real>& w, SweptBody& swept);

/// Restores the fat AABB, and adds the shapes to the move buffer.
template <class Real>
void restore_fat_aabb(WorldData<Real>& w, int body, Real dt);

/// Returns the index of the body's SweptBody. Adds one with the solver's motion if there is none.
template <class Real>
int swept_body_index(WorldData<Real>& w, int body, double dt);

}  // namespace plumb
