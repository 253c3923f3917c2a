#pragma once

#include <span>

#include "engine/world/world_data.h"

/// Creation and removal of bodies, shapes, chains and joints. The caller has validated definitions before,
/// and identifies objects by index.
namespace plumb {

template <class Real>
int add_body(WorldData<Real>& w, const BodyDefinition& definition, std::span<const ShapeDefinition> shapes);
template <class Real>
void remove_body(WorldData<Real>& w, int body);

/// Returns the position of the body's origin, m.
template <class Real>
Vec2d origin_of(const WorldData<Real>& w, int body);
template <class Real>
void set_gravity_scale(WorldData<Real>& w, int body, double scale);
/// Sets the rates of decay, 1/s.
template <class Real>
void set_damping(WorldData<Real>& w, int body, double linear, double angular);
/// Switches continuous collision of a body on or off.
template <class Real>
void set_continuous(WorldData<Real>& w, int body, bool on);
/// Teleports the body's origin, and wakes bodies that touched it or are joined to it.
template <class Real>
void teleport_body(WorldData<Real>& w, int body, Vec2d origin, double angle);
template <class Real>
void set_type(WorldData<Real>& w, int body, BodyType type);

/// Sets the loads above which a joint is reported, N and N m; 0: never.
template <class Real>
void set_load_events(WorldData<Real>& w, int joint, double force, double torque);

/// Returns the body's optional data, and allocates it if there is none yet.
template <class Real>
BodyExtras<Real>& make_extras(WorldData<Real>& w, int body);

/// Removes a shape without contacts from the body's list and the trees. The caller updates the mass.
template <class Real>
void erase_shape(WorldData<Real>& w, int shape);
/// Removes all shapes of a chain in the same way.
template <class Real>
void erase_chain(WorldData<Real>& w, int chain);

/// Adds the shape to the move buffer, so that the next step looks up its pairs.
template <class Real>
void add_to_move_buffer(WorldData<Real>& w, int shape);
/// Emits the end events of a sensor's overlaps, and removes its record.
template <class Real>
void end_overlaps(WorldData<Real>& w, int shape);

/// Adds the shape to the tree of its body's type and to the move buffer, or removes it from the tree.
template <class Real>
void create_proxy(WorldData<Real>& w, int shape);
template <class Real>
void destroy_proxy(WorldData<Real>& w, int shape);

template <class Real>
int add_shape(WorldData<Real>& w, int body, const ShapeDefinition& definition);
template <class Real>
void remove_shape(WorldData<Real>& w, int shape);
/// Replaces a shape's geometry and its place in the body's frame by those of `definition`; all else stays.
/// Ends its contacts.
template <class Real>
void set_geometry(WorldData<Real>& w, int shape, const ShapeDefinition& definition);
template <class Real>
void set_filter(WorldData<Real>& w, int shape, const Filter& filter);
template <class Real>
void set_material(WorldData<Real>& w, int shape, const Material& material);
/// Sets a shape's density, kg/m^2. Throws Error (Value) if the body's mass would be beyond `Real`, and then
/// changes nothing.
template <class Real>
void set_density(WorldData<Real>& w, int shape, double density);
template <class Real>
void set_sensor(WorldData<Real>& w, int shape, bool sensor);
/// Switches hit events and the pre-solve hook on or off, for existing contacts as well.
template <class Real>
void set_flags(WorldData<Real>& w, int shape, bool hit_events, bool pre_solve);

template <class Real>
int add_chain(WorldData<Real>& w, int body, const ChainDefinition& definition);
template <class Real>
void remove_chain(WorldData<Real>& w, int chain);

template <class Real>
int add_joint(WorldData<Real>& w, int body_a, int body_b, const JointDefinition& definition);
template <class Real>
void remove_joint(WorldData<Real>& w, int joint);

/// Returns the constants of the joint's springs for the present masses of its bodies. Throws Error
/// (Unsupported) for a joint without springs.
template <class Real>
JointStiffness stiffness_of(const WorldData<Real>& w, int joint);

}  // namespace plumb
