#include "bindings/c/handle.h"
#include "engine/world/queries.h"

using namespace plumb::c;

plumb::ShapeGeometry plumb::c::in(const plumb_geometry& g) {
  switch (in<int>(g.kind, 5, "shape", "kind")) {
    case PLUMB_CIRCLE:
      return Circle{g.radius};
    case PLUMB_BOX:
      return Box{g.width, g.height};
    case PLUMB_CAPSULE:
      return Capsule{in(g.start), in(g.end), g.radius};
    case PLUMB_POLYGON:
      return Polygon{in(g.points, g.point_count, "polygon"), g.radius};
    default:
      return Segment{in(g.start), in(g.end)};
  }
}

plumb::ShapeDefinition plumb::c::in(const plumb_shape_definition& d) {
  ShapeDefinition result;
  result.geometry = in(d.geometry);
  result.position = in(d.position), result.angle = d.angle;
  result.density = d.density;
  result.material = in(d.material), result.filter = in(d.filter);
  result.sensor = d.sensor, result.hit_events = d.hit_events, result.pre_solve = d.pre_solve;
  result.user_data = d.user_data;
  return result;
}

namespace {

plumb::ChainDefinition definition_of(const plumb_chain_definition& d) {
  plumb::ChainDefinition result;
  result.points = in(d.points, d.point_count, "chain"), result.closed = d.closed;
  result.material = in(d.material), result.filter = in(d.filter);
  result.sensor = d.sensor, result.hit_events = d.hit_events, result.pre_solve = d.pre_solve;
  result.user_data = d.user_data;
  require_countable("chain", "material_count", d.material_count, kMostItems);
  if (d.material_count > 0) require(d.materials, "materials");
  for (std::size_t i = 0; i < d.material_count; ++i) result.materials.push_back(in(d.materials[i]));
  return result;
}

/// Returns a geometry whose points are in `points`.
plumb_geometry geometry_of(const plumb::ShapeGeometry& geometry, std::vector<plumb_vec2>& points) {
  struct Make {
    std::vector<plumb_vec2>& points;
    plumb_geometry operator()(const plumb::Circle& g) const { return plumb_circle(g.radius); }
    plumb_geometry operator()(const plumb::Box& g) const { return plumb_box(g.width, g.height); }
    plumb_geometry operator()(const plumb::Capsule& g) const {
      return plumb_capsule(out(g.start), out(g.end), g.radius);
    }
    plumb_geometry operator()(const plumb::Segment& g) const {
      return plumb_segment(out(g.start), out(g.end));
    }
    plumb_geometry operator()(const plumb::Polygon& g) const {
      points.clear();
      for (const plumb::Vec2d point : g.points) points.push_back(out(point));
      return plumb_polygon(points.data(), points.size(), g.radius);
    }
  };
  return std::visit(Make{points}, geometry);
}

}  // namespace

plumb_shape plumb_shape_create(plumb_world* world, plumb_body body,
                               const plumb_shape_definition* definition) {
  return checked_or(kNoShape, [&] {
    const plumb::ShapeDefinition shape = in(require(definition, "shape definition"));
    return change(world, [&](auto& w) { return out(w.create_shape(in(body), shape)); });
  });
}
plumb_status plumb_shape_destroy(plumb_world* world, plumb_shape shape) {
  return change_checked(world, [&](auto& w) { w.destroy(in(shape)); });
}
bool plumb_shape_valid(const plumb_world* world, plumb_shape shape) {
  return read_or(false, world, [&](const auto& w) { return w.valid(in(shape)); });
}
plumb_body plumb_shape_body(const plumb_world* world, plumb_shape shape) {
  return read_or(kNoBody, world, [&](const auto& w) { return out(w.body(in(shape))); });
}
uint64_t plumb_shape_user_data(const plumb_world* world, plumb_shape shape) {
  return read_or<uint64_t>(0, world, [&](const auto& w) { return w.user_data(in(shape)); });
}
plumb_material plumb_shape_material(const plumb_world* world, plumb_shape shape) {
  return read_or(plumb_material{}, world, [&](const auto& w) { return out(w.material(in(shape))); });
}
plumb_status plumb_shape_set_material(plumb_world* world, plumb_shape shape, plumb_material material) {
  return change_checked(world, [&](auto& w) { w.set_material(in(shape), in(material)); });
}
plumb_status plumb_shape_set_geometry(plumb_world* world, plumb_shape shape, const plumb_geometry* geometry,
                                      plumb_vec2 position, double angle) {
  return checked([&] {
    const plumb::ShapeGeometry wanted = in(require(geometry, "geometry"));
    change(world, [&](auto& w) { w.set_geometry(in(shape), wanted, in(position), angle); });
  });
}
plumb_filter plumb_shape_filter(const plumb_world* world, plumb_shape shape) {
  return read_or(plumb_filter{}, world, [&](const auto& w) { return out(w.filter(in(shape))); });
}
plumb_status plumb_shape_set_filter(plumb_world* world, plumb_shape shape, plumb_filter filter) {
  return change_checked(world, [&](auto& w) { w.set_filter(in(shape), in(filter)); });
}
plumb_status plumb_shape_set_user_data(plumb_world* world, plumb_shape shape, uint64_t data) {
  return change_checked(world, [&](auto& w) { w.set_user_data(in(shape), data); });
}
plumb_status plumb_shape_set_density(plumb_world* world, plumb_shape shape, double density) {
  return change_checked(world, [&](auto& w) { w.set_density(in(shape), density); });
}
plumb_status plumb_shape_set_sensor(plumb_world* world, plumb_shape shape, bool sensor) {
  return change_checked(world, [&](auto& w) { w.set_sensor(in(shape), sensor); });
}
plumb_status plumb_shape_set_hit_events(plumb_world* world, plumb_shape shape, bool on) {
  return change_checked(world, [&](auto& w) { w.set_hit_events(in(shape), on); });
}
plumb_status plumb_shape_set_pre_solve(plumb_world* world, plumb_shape shape, bool on) {
  return change_checked(world, [&](auto& w) { w.set_pre_solve(in(shape), on); });
}
plumb_box_bounds plumb_shape_box(const plumb_world* world, plumb_shape shape) {
  return read_or(plumb_box_bounds{}, world, [&](const auto& w) { return out(w.box(in(shape))); });
}
plumb_chain plumb_shape_chain(const plumb_world* world, plumb_shape shape) {
  return read_or(kNoChain, world, [&](const auto& w) { return out(w.chain(in(shape))); });
}
bool plumb_shape_ray_cast(const plumb_world* world, plumb_shape shape, plumb_vec2 origin,
                          plumb_vec2 translation, double* fraction, plumb_vec2* normal) {
  return read_or(false, world, [&](const auto& w) {
    const auto hit = plumb::ray_cast(w, in(shape), in(origin), in(translation));
    if (hit && fraction != nullptr) *fraction = hit->fraction;
    if (hit && normal != nullptr) *normal = out(hit->normal);
    return hit.has_value();
  });
}
bool plumb_shape_contains(const plumb_world* world, plumb_shape shape, plumb_vec2 point) {
  return read_or(false, world, [&](const auto& w) { return plumb::contains(w, in(shape), in(point)); });
}
double plumb_shape_density(const plumb_world* world, plumb_shape shape) {
  return read_or(0.0, world, [&](const auto& w) { return w.density(in(shape)); });
}
bool plumb_shape_sensor(const plumb_world* world, plumb_shape shape) {
  return read_or(false, world, [&](const auto& w) { return w.sensor(in(shape)); });
}
bool plumb_shape_hit_events(const plumb_world* world, plumb_shape shape) {
  return read_or(false, world, [&](const auto& w) { return w.hit_events(in(shape)); });
}
bool plumb_shape_pre_solve(const plumb_world* world, plumb_shape shape) {
  return read_or(false, world, [&](const auto& w) { return w.pre_solve(in(shape)); });
}
plumb_shape_definition plumb_shape_get_definition(const plumb_world* world, plumb_shape shape) {
  return read_or(plumb_default_shape(), world, [&](const auto& w) {
    const plumb::ShapeDefinition d = w.definition(in(shape));
    plumb_shape_definition result{};
    result.geometry = geometry_of(d.geometry, world->points);
    result.position = out(d.position), result.angle = d.angle;
    result.density = d.density;
    result.material = out(d.material), result.filter = out(d.filter);
    result.sensor = d.sensor, result.hit_events = d.hit_events, result.pre_solve = d.pre_solve;
    result.user_data = d.user_data;
    return result;
  });
}
size_t plumb_shape_overlapping(const plumb_world* world, plumb_shape sensor, plumb_shape* to,
                               size_t capacity) {
  return read_or<size_t>(0, world,
                         [&](const auto& w) { return fill(w.overlapping(in(sensor)), to, capacity); });
}

plumb_chain plumb_chain_create(plumb_world* world, plumb_body body,
                               const plumb_chain_definition* definition) {
  return checked_or(kNoChain, [&] {
    const plumb::ChainDefinition chain = definition_of(require(definition, "chain definition"));
    return change(world, [&](auto& w) { return out(w.create_chain(in(body), chain)); });
  });
}
plumb_status plumb_chain_destroy(plumb_world* world, plumb_chain chain) {
  return change_checked(world, [&](auto& w) { w.destroy(in(chain)); });
}
bool plumb_chain_valid(const plumb_world* world, plumb_chain chain) {
  return read_or(false, world, [&](const auto& w) { return w.valid(in(chain)); });
}
plumb_body plumb_chain_body(const plumb_world* world, plumb_chain chain) {
  return read_or(kNoBody, world, [&](const auto& w) { return out(w.body(in(chain))); });
}
size_t plumb_chain_segments(const plumb_world* world, plumb_chain chain, plumb_shape* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) { return fill(w.segments(in(chain)), to, capacity); });
}
plumb_chain_definition plumb_chain_get_definition(const plumb_world* world, plumb_chain chain) {
  return read_or(plumb_default_chain(), world, [&](const auto& w) {
    const plumb::ChainDefinition d = w.definition(in(chain));
    world->points.clear();
    for (const plumb::Vec2d point : d.points) world->points.push_back(out(point));
    world->materials.clear();
    for (const plumb::Material& material : d.materials) world->materials.push_back(out(material));
    plumb_chain_definition result{};
    result.materials = world->materials.data(), result.material_count = world->materials.size();
    result.points = world->points.data(), result.point_count = world->points.size();
    result.closed = d.closed;
    result.material = out(d.material), result.filter = out(d.filter);
    result.sensor = d.sensor, result.hit_events = d.hit_events, result.pre_solve = d.pre_solve;
    result.user_data = d.user_data;
    return result;
  });
}
