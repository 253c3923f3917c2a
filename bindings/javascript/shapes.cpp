#include "bindings/javascript/buffer.h"

using namespace plumb::javascript;

extern "C" {

PLUMB_EXPORT("shape_create")
double* js_shape_create(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  Reader r;
  ShapeInput input;
  read(r, input);
  return Writer().id(plumb_shape_create(w, {index, generation}, &input.definition)).done();
}
PLUMB_EXPORT("chain_create")
double* js_chain_create(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  Reader r;
  plumb_chain_definition d = plumb_default_chain();
  d.closed = r.flag();
  d.material = material(r), d.filter = filter(r);
  const std::vector<plumb_vec2> points = r.points();
  d.points = points.data(), d.point_count = points.size();
  return Writer().id(plumb_chain_create(w, {index, generation}, &d)).done();
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
  const plumb_material m = plumb_shape_material(w, {index, generation});
  return Writer().add(m.friction).add(m.restitution).add(m.rolling_resistance).add(m.surface_speed).done();
}
PLUMB_EXPORT("shape_set_material") void js_shape_set_material(PLUMB_HANDLE) {
  Reader r;
  plumb_shape_set_material(w, {index, generation}, material(r));
}
PLUMB_EXPORT("shape_set_filter") void js_shape_set_filter(PLUMB_HANDLE) {
  Reader r;
  plumb_shape_set_filter(w, {index, generation}, filter(r));
}
PLUMB_EXPORT("shape_overlapping") double* js_shape_overlapping(PLUMB_HANDLE) {
  std::vector<plumb_shape> all(plumb_shape_overlapping(w, {index, generation}, nullptr, 0));
  plumb_shape_overlapping(w, {index, generation}, all.data(), all.size());
  Writer out;
  for (const plumb_shape shape : all) out.id(shape);
  return out.done();
}
PLUMB_EXPORT("chain_destroy") void js_chain_destroy(PLUMB_HANDLE) {
  plumb_chain_destroy(w, {index, generation});
}
}
