#include <cstring>

#include "bindings/javascript/buffer.h"

using namespace plumb::javascript;

namespace {

/// Kinds of items, as plumb.world.mjs reads them.
enum Item { kPolygon, kCircle, kCapsule, kSegment, kPoint, kText };

Writer& begin(void* context, Item item, plumb_draw_role role) {
  return static_cast<Writer*>(context)->add(item).add(role);
}

}  // namespace

extern "C" {

/// Writes all items that the options in the buffer ask for: kind, role, then the kind's numbers.
PLUMB_EXPORT("world_draw") double* js_world_draw(plumb_world* w) {
  Reader r;
  plumb_draw_options o = plumb_default_draw();
  o.shapes = r.flag(), o.joints = r.flag(), o.contacts = r.flag(), o.normals = r.flag();
  o.impulses = r.flag(), o.boxes = r.flag(), o.centres = r.flag(), o.names = r.flag();
  o.normal_length = r.number(), o.impulse_length = r.number();
  o.bounded = r.flag();
  o.bounds.lower = r.point(), o.bounds.upper = r.point();
  Writer out;
  plumb_debug_draw to{};
  to.polygon = [](const plumb_vec2* corners, size_t count, double radius, plumb_draw_role role, void* c) {
    Writer& items = begin(c, kPolygon, role).add(radius).add(static_cast<double>(count));
    for (size_t i = 0; i < count; ++i) items.add(corners[i]);
  };
  to.circle = [](plumb_vec2 centre, double radius, plumb_vec2 axis, plumb_draw_role role, void* c) {
    begin(c, kCircle, role).add(centre).add(radius).add(axis);
  };
  to.capsule = [](plumb_vec2 start, plumb_vec2 end, double radius, plumb_draw_role role, void* c) {
    begin(c, kCapsule, role).add(start).add(end).add(radius);
  };
  to.segment = [](plumb_vec2 start, plumb_vec2 end, plumb_draw_role role, void* c) {
    begin(c, kSegment, role).add(start).add(end);
  };
  to.point = [](plumb_vec2 point, plumb_draw_role role, void* c) { begin(c, kPoint, role).add(point); };
  to.text = [](plumb_vec2 point, const char* text, plumb_draw_role role, void* c) {
    Writer& items = begin(c, kText, role).add(point).add(static_cast<double>(std::strlen(text)));
    for (; *text != '\0'; ++text) items.add(static_cast<unsigned char>(*text));
  };
  to.context = &out;
  plumb_world_draw(w, &to, &o);
  return out.done();
}
}
