#include "bindings/c/handle.h"
#include "bindings/javascript/buffer.h"

using namespace plumb::c;
using namespace plumb::javascript;

extern "C" {

// Definitions are kept from call to call: nothing would free them when the world refuses one.
PLUMB_EXPORT("shape_create")
double* js_shape_create(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  static ShapeInput input;
  static plumb::ShapeDefinition d;
  Reader r;
  read(r, input);
  d = in(input.definition);
  const plumb::BodyId body{index, generation};
  return Writer().id(change(w, [&](auto& world) { return out(world.create_shape(body, d)); })).done();
}
PLUMB_EXPORT("chain_create")
double* js_chain_create(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  static plumb::ChainDefinition d;
  Reader r;
  d.closed = r.flag();
  d.material = in(material(r)), d.filter = in(filter(r));
  d.sensor = r.flag(), d.hit_events = r.flag(), d.pre_solve = r.flag();
  d.user_data = r.wide();
  d.materials.clear(), d.points.clear();
  for (std::uint32_t count = r.bits(); count > 0; --count) d.materials.push_back(in(material(r)));
  for (std::uint32_t count = r.bits(); count > 0; --count) d.points.push_back(in(r.point()));
  const plumb::BodyId body{index, generation};
  return Writer().id(change(w, [&](auto& world) { return out(world.create_chain(body, d)); })).done();
}
PLUMB_EXPORT("shape_destroy") void js_shape_destroy(PLUMB_HANDLE) {
  plumb_shape_destroy(w, {index, generation});
}
PLUMB_EXPORT("shape_valid") int js_shape_valid(PLUMB_HANDLE) {
  return plumb_shape_valid(w, {index, generation});
}
PLUMB_EXPORT("shape_body") double* js_shape_body(PLUMB_HANDLE) {
  return Writer().id(plumb_shape_body(w, {index, generation})).done();
}
PLUMB_EXPORT("shape_user_data") std::uint64_t js_shape_user_data(PLUMB_HANDLE) {
  return plumb_shape_user_data(w, {index, generation});
}
PLUMB_EXPORT("shape_material") double* js_shape_material(PLUMB_HANDLE) {
  return Writer().add(plumb_shape_material(w, {index, generation})).done();
}
PLUMB_EXPORT("shape_set_material") void js_shape_set_material(PLUMB_HANDLE) {
  Reader r;
  plumb_shape_set_material(w, {index, generation}, material(r));
}
PLUMB_EXPORT("shape_set_geometry") void js_shape_set_geometry(PLUMB_HANDLE) {
  static std::vector<plumb_vec2> points;  // kept from call to call, as definitions are
  Reader r;
  const plumb_geometry g = geometry(r, points);
  const plumb_vec2 position = r.point();
  plumb_shape_set_geometry(w, {index, generation}, &g, position, r.number());
}
PLUMB_EXPORT("shape_filter") double* js_shape_filter(PLUMB_HANDLE) {
  return Writer().add(plumb_shape_filter(w, {index, generation})).done();
}
PLUMB_EXPORT("shape_set_filter") void js_shape_set_filter(PLUMB_HANDLE) {
  Reader r;
  plumb_shape_set_filter(w, {index, generation}, filter(r));
}
PLUMB_EXPORT("shape_overlapping") double* js_shape_overlapping(PLUMB_HANDLE) {
  std::vector<plumb_shape> all(plumb_shape_overlapping(w, {index, generation}, nullptr, 0));
  plumb_shape_overlapping(w, {index, generation}, all.data(), all.size());
  return Writer().ids(all).done();
}
PLUMB_EXPORT("shape_set_user_data") void js_shape_set_user_data(PLUMB_HANDLE, std::uint64_t data) {
  plumb_shape_set_user_data(w, {index, generation}, data);
}
PLUMB_EXPORT("shape_density") double js_shape_density(PLUMB_HANDLE) {
  return plumb_shape_density(w, {index, generation});
}
PLUMB_EXPORT("shape_set_density") void js_shape_set_density(PLUMB_HANDLE, double density) {
  plumb_shape_set_density(w, {index, generation}, density);
}
PLUMB_EXPORT("shape_sensor") int js_shape_sensor(PLUMB_HANDLE) {
  return plumb_shape_sensor(w, {index, generation});
}
PLUMB_EXPORT("shape_set_sensor") void js_shape_set_sensor(PLUMB_HANDLE, int on) {
  plumb_shape_set_sensor(w, {index, generation}, on != 0);
}
PLUMB_EXPORT("shape_hit_events") int js_shape_hit_events(PLUMB_HANDLE) {
  return plumb_shape_hit_events(w, {index, generation});
}
PLUMB_EXPORT("shape_pre_solve") int js_shape_pre_solve(PLUMB_HANDLE) {
  return plumb_shape_pre_solve(w, {index, generation});
}
PLUMB_EXPORT("shape_chain") double* js_shape_chain(PLUMB_HANDLE) {
  return Writer().id(plumb_shape_chain(w, {index, generation})).done();
}
/// Writes kind, radius, start, end, position, angle and the points of the shape's geometry.
PLUMB_EXPORT("shape_geometry") double* js_shape_geometry(PLUMB_HANDLE) {
  const plumb_shape_definition d = plumb_shape_get_definition(w, {index, generation});
  Writer out;
  out.add(d.geometry.kind).add(d.geometry.radius).add(d.geometry.start).add(d.geometry.end);
  out.add(d.position).add(d.angle);
  for (std::size_t i = 0; i < d.geometry.point_count; ++i) out.add(d.geometry.points[i]);
  return out.done();
}
PLUMB_EXPORT("shape_set_hit_events") void js_shape_set_hit_events(PLUMB_HANDLE, int on) {
  plumb_shape_set_hit_events(w, {index, generation}, on != 0);
}
PLUMB_EXPORT("shape_set_pre_solve") void js_shape_set_pre_solve(PLUMB_HANDLE, int on) {
  plumb_shape_set_pre_solve(w, {index, generation}, on != 0);
}
PLUMB_EXPORT("shape_box") double* js_shape_box(PLUMB_HANDLE) {
  const plumb_box_bounds box = plumb_shape_box(w, {index, generation});
  return Writer().add(box.lower).add(box.upper).done();
}
/// Writes the normal and the fraction of a hit of this shape alone, and nothing for none.
PLUMB_EXPORT("shape_ray_cast")
double* js_shape_ray_cast(PLUMB_HANDLE, double x, double y, double way_x, double way_y) {
  double fraction = 0;
  plumb_vec2 normal{};
  Writer out;
  if (plumb_shape_ray_cast(w, {index, generation}, {x, y}, {way_x, way_y}, &fraction, &normal))
    out.add(normal).add(fraction);
  return out.done();
}
PLUMB_EXPORT("shape_contains") int js_shape_contains(PLUMB_HANDLE, double x, double y) {
  return plumb_shape_contains(w, {index, generation}, {x, y});
}
PLUMB_EXPORT("chain_valid") int js_chain_valid(PLUMB_HANDLE) {
  return plumb_chain_valid(w, {index, generation});
}
PLUMB_EXPORT("chain_body") double* js_chain_body(PLUMB_HANDLE) {
  return Writer().id(plumb_chain_body(w, {index, generation})).done();
}
PLUMB_EXPORT("chain_segments") double* js_chain_segments(PLUMB_HANDLE) {
  const plumb_chain chain{index, generation};
  return Writer()
      .ids(
          all_of<plumb_shape>([&](auto* to, std::size_t n) { return plumb_chain_segments(w, chain, to, n); }))
      .done();
}
/// Writes 1 for a closed chain, 0 otherwise, and its points.
PLUMB_EXPORT("chain_points") double* js_chain_points(PLUMB_HANDLE) {
  const plumb_chain_definition d = plumb_chain_get_definition(w, {index, generation});
  Writer out;
  out.add(d.closed);
  for (std::size_t i = 0; i < d.point_count; ++i) out.add(d.points[i]);
  return out.done();
}
PLUMB_EXPORT("chain_destroy") void js_chain_destroy(PLUMB_HANDLE) {
  plumb_chain_destroy(w, {index, generation});
}
}
