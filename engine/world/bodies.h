#pragma once

#include <span>

#include "engine/world/world_data.h"

/// Bodies, shapes, chains and joints come and go. Definitions are valid when they arrive here; names are
/// indices.
namespace plumb {

template <class Real>
int add_body(WorldData<Real>& w, const BodyDefinition& definition, std::span<const ShapeDefinition> shapes);
template <class Real>
void remove_body(WorldData<Real>& w, int body);

/// Where the body's origin is, and its frame.
template <class Real>
Vec2d origin_of(const WorldData<Real>& w, int body);
template <class Real>
void set_gravity_scale(WorldData<Real>& w, int body, double scale);
/// Rates of decay, 1/s.
template <class Real>
void set_damping(WorldData<Real>& w, int body, double linear, double angular);
/// Puts the body's origin somewhere else; what it rested on or held wakes up.
template <class Real>
void place_body(WorldData<Real>& w, int body, Vec2d origin, double angle);
template <class Real>
void set_type(WorldData<Real>& w, int body, BodyType type);

/// What few bodies have: a place of its own for it, from now on.
template <class Real>
UncommonBody<Real>& make_uncommon(WorldData<Real>& w, int body);

/// Takes a shape that has no contacts out of the body's list and the trees; mass is the caller's business.
template <class Real>
void take_out_shape(WorldData<Real>& w, int shape);
/// Likewise all shapes of a chain.
template <class Real>
void take_out_chain(WorldData<Real>& w, int chain);

/// Has pairs looked for with the shape in the next step.
template <class Real>
void note_moved(WorldData<Real>& w, int shape);
/// Ends what a sensor sees, and its record.
template <class Real>
void end_visits(WorldData<Real>& w, int shape);

/// Into the tree of the body's type, to be paired in the next step, and out of it.
template <class Real>
void enter_tree(WorldData<Real>& w, int shape);
template <class Real>
void leave_tree(WorldData<Real>& w, int shape);

template <class Real>
int add_shape(WorldData<Real>& w, int body, const ShapeDefinition& definition);
template <class Real>
void remove_shape(WorldData<Real>& w, int shape);
template <class Real>
void set_filter(WorldData<Real>& w, int shape, const Filter& filter);
template <class Real>
void set_material(WorldData<Real>& w, int shape, const Material& material);

template <class Real>
int add_chain(WorldData<Real>& w, int body, const ChainDefinition& definition);
template <class Real>
void remove_chain(WorldData<Real>& w, int chain);

template <class Real>
int add_joint(WorldData<Real>& w, int body_a, int body_b, const JointDefinition& definition);
template <class Real>
void remove_joint(WorldData<Real>& w, int joint);

}  // namespace plumb
