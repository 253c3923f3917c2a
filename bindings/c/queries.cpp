#include "engine/world/queries.h"

#include "bindings/c/handle.h"
#include "bindings/c/query_filter.h"
#include "engine/world/mover.h"
#include "engine/world/state/validate.h"

using namespace plumb::c;

namespace {

plumb_ray_hit hit_of(const plumb::RayResult& r) {
  return {out(r.shape), out(r.body), r.fraction, out(r.point), out(r.normal)};
}
plumb_cast_hit hit_of(const plumb::CastShapeResult& r) {
  return {out(r.shape), out(r.body), r.fraction, out(r.point), out(r.normal), r.overlapped};
}
plumb_nearest_hit hit_of(const plumb::NearestResult& r) {
  return {out(r.shape), out(r.body), out(r.point), out(r.normal), r.distance};
}

/// Fills `hit` with what `query` finds. Throws before it asks if there is no place for it.
template <class Hit, class Query>
bool give(Hit* hit, Query&& query) {
  require(hit, "hit");
  const auto found = query();
  if (found) *hit = hit_of(*found);
  return found.has_value();
}

plumb::QueryShape shape_of(const plumb_geometry* geometry) { return {in(require(geometry, "shape"))}; }

}  // namespace

bool plumb_ray_cast_closest(const plumb_world* world, plumb_vec2 origin, plumb_vec2 translation,
                            const plumb_query_filter* filter, plumb_ray_hit* hit) {
  return read_or(false, world, [&](const auto& w) {
    const Filtered only(filter);
    return give(hit, [&] { return plumb::ray_cast_closest(w, in(origin), in(translation), only.get()); });
  });
}
plumb_status plumb_ray_cast(const plumb_world* world, plumb_vec2 origin, plumb_vec2 translation,
                            const plumb_query_filter* filter, plumb_ray_visitor visit, void* context) {
  return read_checked(world, [&](const auto& w) {
    const Filtered only(filter);
    require(visit, "visitor");
    plumb::ray_cast(w, in(origin), in(translation), only.get(), [&](const plumb::RayResult& result) {
      const plumb_ray_hit hit = hit_of(result);
      return visit(&hit, context);
    });
  });
}
size_t plumb_ray_cast_all(const plumb_world* world, plumb_vec2 origin, plumb_vec2 translation,
                          const plumb_query_filter* filter, plumb_ray_hit* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) {
    const Filtered only(filter);
    std::vector<plumb::RayResult> hits;
    plumb::ray_cast_all(w, in(origin), in(translation), only.get(), hits);
    if (!hits.empty() && capacity > 0) require(to, "out");
    for (size_t i = 0; i < hits.size() && i < capacity; ++i) to[i] = hit_of(hits[i]);
    return hits.size();
  });
}
bool plumb_cast_shape_closest(const plumb_world* world, const plumb_geometry* shape, plumb_pose pose,
                              plumb_vec2 translation, const plumb_query_filter* filter, plumb_cast_hit* hit) {
  return read_or(false, world, [&](const auto& w) {
    const Filtered only(filter);
    return give(hit, [&] {
      return plumb::cast_shape_closest(w, shape_of(shape), in(pose.position), pose.angle, in(translation),
                                       only.get());
    });
  });
}
plumb_status plumb_cast_shape(const plumb_world* world, const plumb_geometry* shape, plumb_pose pose,
                              plumb_vec2 translation, const plumb_query_filter* filter,
                              plumb_cast_visitor visit, void* context) {
  return read_checked(world, [&](const auto& w) {
    const Filtered only(filter);
    require(visit, "visitor");
    plumb::cast_shape(w, shape_of(shape), in(pose.position), pose.angle, in(translation), only.get(),
                      [&](const plumb::CastShapeResult& result) {
                        const plumb_cast_hit hit = hit_of(result);
                        return visit(&hit, context);
                      });
  });
}
size_t plumb_overlap_shape(const plumb_world* world, const plumb_geometry* shape, plumb_pose pose,
                           const plumb_query_filter* filter, plumb_shape* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) {
    const Filtered only(filter);
    std::vector<plumb::ShapeId> found;
    plumb::overlap_shape(w, shape_of(shape), in(pose.position), pose.angle, only.get(), found);
    return fill(found, to, capacity);
  });
}
size_t plumb_overlap_box(const plumb_world* world, plumb_vec2 lower, plumb_vec2 upper,
                         const plumb_query_filter* filter, plumb_shape* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) {
    const Filtered only(filter);
    std::vector<plumb::ShapeId> found;
    plumb::overlap_box(w, plumb::Aabb<double>{in(lower), in(upper)}, only.get(), found);
    return fill(found, to, capacity);
  });
}
size_t plumb_shapes_at(const plumb_world* world, plumb_vec2 point, const plumb_query_filter* filter,
                       plumb_shape* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) {
    const Filtered only(filter);
    std::vector<plumb::ShapeId> found;
    plumb::shapes_at(w, in(point), only.get(), found);
    return fill(found, to, capacity);
  });
}
bool plumb_nearest(const plumb_world* world, plumb_vec2 point, double max_distance,
                   const plumb_query_filter* filter, plumb_nearest_hit* hit) {
  return read_or(false, world, [&](const auto& w) {
    const Filtered only(filter);
    return give(hit, [&] { return plumb::nearest(w, in(point), max_distance, only.get()); });
  });
}
plumb_distance_result plumb_distance_between(const plumb_world* world, plumb_shape a, plumb_shape b) {
  return read_or(plumb_distance_result{}, world, [&](const auto& w) {
    const plumb::ShapeDistance d = plumb::distance(w, in(a), in(b));
    return plumb_distance_result{out(d.point_a), out(d.point_b), out(d.normal), d.distance};
  });
}

plumb_mover_result plumb_move(const plumb_world* world, const plumb_geometry* capsule, plumb_vec2 position,
                              plumb_vec2 velocity, double dt, const plumb_mover_options* options,
                              plumb_mover_hit* hits, size_t capacity) {
  return read_or(plumb_mover_result{}, world, [&](const auto& w) {
    const plumb_geometry& shape = require(capsule, "capsule");
    if (shape.kind != PLUMB_CAPSULE) {
      throw plumb::Error(plumb::Error::Kind::Value, "mover", "kind", std::to_string(shape.kind),
                         "must be a capsule; make it with plumb_capsule");
    }
    const plumb_mover_options o = options != nullptr ? *options : plumb_default_mover();
    const Filtered only(&o.filter);
    const plumb::MoverOptions settings{in(o.up), o.max_slope,  o.step_height, o.skin,
                                       o.mass,   o.push_force, only.get()};
    const plumb::MoverResult r = plumb::move(w, plumb::Capsule{in(shape.start), in(shape.end), shape.radius},
                                             in(position), in(velocity), dt, settings);
    if (!r.hits.empty() && capacity > 0) require(hits, "hits");
    for (size_t i = 0; i < r.hits.size() && i < capacity; ++i) {
      const plumb::MoverHit& hit = r.hits[i];
      hits[i] = {out(hit.shape), out(hit.body), out(hit.point), out(hit.normal), hit.impulse};
    }
    return plumb_mover_result{
        out(r.position), out(r.velocity),        r.on_ground,  r.squeezed, out(r.ground_normal),
        out(r.ground),   out(r.ground_velocity), r.hits.size()};
  });
}
plumb_status plumb_apply_pushes(plumb_world* world, const plumb_mover_hit* hits, size_t count) {
  return checked([&] {
    plumb::MoverResult result;
    require_countable("pushes", "count", count, kMostItems);
    if (count > 0) require(hits, "hits");
    for (size_t i = 0; i < count; ++i) {
      const std::string push = "push " + std::to_string(i);
      plumb::require_not_negative(push, "impulse", hits[i].impulse);
      plumb::require_finite(push, "normal", in(hits[i].normal));
      plumb::require_finite(push, "impulse", hits[i].impulse * in(hits[i].normal));
      plumb::require_finite(push, "point", in(hits[i].point));
      result.hits.push_back(
          {in(hits[i].shape), in(hits[i].body), in(hits[i].point), in(hits[i].normal), hits[i].impulse});
    }
    // All or none: a body that is gone is found before the first push.
    for (const plumb::MoverHit& hit : result.hits)
      if (hit.impulse > 0) read(world, [&](const auto& w) { (void)w.type(hit.body); });
    edit(world, [&](auto& w) { plumb::apply_pushes(w, result); });
  });
}
