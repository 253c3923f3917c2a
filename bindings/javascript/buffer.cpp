#include "bindings/javascript/buffer.h"

extern "C" {
/// Calls the condition of the query that runs now.
PLUMB_IMPORT("condition") int js_condition(std::uint32_t index, std::uint32_t generation);
}

namespace plumb::javascript {

std::vector<double> numbers(256);
std::vector<unsigned char> bytes;

plumb_material material(Reader& r) {
  plumb_material m{};
  m.friction = r.number(), m.restitution = r.number();
  m.rolling_resistance = r.number(), m.surface_speed = r.number();
  return m;
}
plumb_filter filter(Reader& r) {
  plumb_filter f{};
  f.category = r.wide(), f.mask = r.wide(), f.group = r.integer();
  return f;
}

plumb_geometry geometry(Reader& r, std::vector<plumb_vec2>& points) {
  plumb_geometry g{};
  g.kind = static_cast<plumb_shape_kind>(r.integer());
  g.radius = r.number(), g.width = r.number(), g.height = r.number();
  g.start = r.point(), g.end = r.point();
  points = r.points();
  g.points = points.data(), g.point_count = points.size();
  return g;
}

void read(Reader& r, ShapeInput& shape) {
  plumb_shape_definition& d = shape.definition;
  d.geometry = geometry(r, shape.points);
  d.position = r.point(), d.angle = r.number(), d.density = r.number();
  d.material = material(r), d.filter = filter(r);
  d.sensor = r.flag(), d.hit_events = r.flag(), d.pre_solve = r.flag();
  d.user_data = r.wide();
}

plumb_query_filter query(Reader& r) {
  plumb_query_filter f = plumb_default_query_filter();
  f.category = r.wide(), f.mask = r.wide(), f.sensors = r.flag();
  f.ignore.index = r.bits(), f.ignore.generation = r.bits();
  if (r.flag()) {
    f.condition = [](plumb_shape shape, void*) { return js_condition(shape.index, shape.generation) != 0; };
  }
  return f;
}

}  // namespace plumb::javascript

using namespace plumb::javascript;

extern "C" {

/// Returns the buffer, with room for `count` numbers.
PLUMB_EXPORT("numbers") double* js_numbers(std::size_t count) {
  numbers.resize(count);
  return numbers.data();
}
PLUMB_EXPORT("number_count") std::size_t js_number_count() { return numbers.size(); }
/// Returns room for `count` bytes.
PLUMB_EXPORT("bytes") unsigned char* js_bytes(std::size_t count) {
  bytes.resize(count);
  return bytes.data();
}
}
