#include "bindings/javascript/buffer.h"

using namespace plumb::javascript;

extern "C" {

// Queries. Nothing is written where nothing is found. Results are written after a query, whose condition may
// use the buffer.
PLUMB_EXPORT("ray_cast") double* js_ray_cast(plumb_world* w) {
  Reader r;
  const plumb_vec2 origin = r.point(), translation = r.point();
  const plumb_query_filter f = query(r);
  plumb_ray_hit hit;
  const bool found = plumb_ray_cast_closest(w, origin, translation, &f, &hit);
  Writer out;
  if (found) out.id(hit.shape).id(hit.body).add(hit.point).add(hit.normal).add(hit.fraction);
  return out.done();
}
PLUMB_EXPORT("ray_cast_all") double* js_ray_cast_all(plumb_world* w) {
  Reader r;
  const plumb_vec2 origin = r.point(), translation = r.point();
  const plumb_query_filter f = query(r);
  const auto all = all_of<plumb_ray_hit>(
      [&](auto* to, std::size_t n) { return plumb_ray_cast_all(w, origin, translation, &f, to, n); });
  Writer out;
  for (const plumb_ray_hit& hit : all)
    out.id(hit.shape).id(hit.body).add(hit.point).add(hit.normal).add(hit.fraction);
  return out.done();
}
PLUMB_EXPORT("cast_shape") double* js_cast_shape(plumb_world* w) {
  Reader r;
  std::vector<plumb_vec2> points;
  const plumb_geometry g = geometry(r, points);
  plumb_pose pose{r.point(), 0};
  pose.angle = r.number();
  const plumb_vec2 translation = r.point();
  const plumb_query_filter f = query(r);
  plumb_cast_hit hit;
  const bool found = plumb_cast_shape_closest(w, &g, pose, translation, &f, &hit);
  Writer out;
  if (found)
    out.id(hit.shape).id(hit.body).add(hit.point).add(hit.normal).add(hit.fraction).add(hit.overlapped);
  return out.done();
}
PLUMB_EXPORT("overlap_shape") double* js_overlap_shape(plumb_world* w) {
  Reader r;
  std::vector<plumb_vec2> points;
  const plumb_geometry g = geometry(r, points);
  plumb_pose pose{r.point(), 0};
  pose.angle = r.number();
  const plumb_query_filter f = query(r);
  std::vector<plumb_shape> all(plumb_overlap_shape(w, &g, pose, &f, nullptr, 0));
  plumb_overlap_shape(w, &g, pose, &f, all.data(), all.size());
  return Writer().ids(all).done();
}
PLUMB_EXPORT("overlap_box") double* js_overlap_box(plumb_world* w) {
  Reader r;
  const plumb_vec2 lower = r.point(), upper = r.point();
  const plumb_query_filter f = query(r);
  const auto all = all_of<plumb_shape>(
      [&](auto* to, std::size_t n) { return plumb_overlap_box(w, lower, upper, &f, to, n); });
  return Writer().ids(all).done();
}
PLUMB_EXPORT("distance")
double* js_distance(plumb_world* w, std::uint32_t a, std::uint32_t a_generation, std::uint32_t b,
                    std::uint32_t b_generation) {
  const plumb_distance_result d = plumb_distance_between(w, {a, a_generation}, {b, b_generation});
  return Writer().add(d.point_a).add(d.point_b).add(d.normal).add(d.distance).done();
}
PLUMB_EXPORT("shapes_at") double* js_shapes_at(plumb_world* w) {
  Reader r;
  const plumb_vec2 point = r.point();
  const plumb_query_filter f = query(r);
  std::vector<plumb_shape> all(plumb_shapes_at(w, point, &f, nullptr, 0));
  plumb_shapes_at(w, point, &f, all.data(), all.size());
  return Writer().ids(all).done();
}
PLUMB_EXPORT("nearest") double* js_nearest(plumb_world* w) {
  Reader r;
  const plumb_vec2 point = r.point();
  const double most = r.number();
  const plumb_query_filter f = query(r);
  plumb_nearest_hit hit;
  const bool found = plumb_nearest(w, point, most, &f, &hit);
  Writer out;
  if (found) out.id(hit.shape).id(hit.body).add(hit.point).add(hit.normal).add(hit.distance);
  return out.done();
}
PLUMB_EXPORT("move") double* js_move(plumb_world* w, int push) {
  Reader r;
  std::vector<plumb_vec2> points;
  const plumb_geometry capsule = geometry(r, points);
  const plumb_vec2 position = r.point(), velocity = r.point();
  const double dt = r.number();
  plumb_mover_options o = plumb_default_mover();
  o.up = r.point(), o.max_slope = r.number(), o.step_height = r.number(), o.skin = r.number();
  o.mass = r.number(), o.push_force = r.number();
  o.filter = query(r);
  plumb_mover_hit hits[64];
  const plumb_mover_result m = plumb_move(w, &capsule, position, velocity, dt, &o, hits, 64);
  if (push != 0) plumb_apply_pushes(w, hits, m.hit_count < 64 ? m.hit_count : 64);
  return Writer()
      .add(m.position)
      .add(m.velocity)
      .add(m.on_ground)
      .add(m.squeezed)
      .add(m.ground_normal)
      .id(m.ground)
      .add(m.ground_velocity)
      .done();
}
}
