#include "bindings/javascript/buffer.h"

using namespace plumb::javascript;

namespace {

plumb_attraction attraction(Reader& r) {
  plumb_attraction a{};
  a.strength = r.number();
  a.falloff = static_cast<plumb_falloff>(r.integer());
  a.softening = r.number();
  return a;
}

}  // namespace

extern "C" {

// A law of the user's is asked between these two calls: an error of it then leaves the world as it was.
/// Returns the bodies on which a law acts, as at the middle of a step of dt s: 12 numbers each.
PLUMB_EXPORT("law_bodies") double* js_law_bodies(plumb_world* w, double dt, int wakes) {
  Writer out;
  const auto list = [](const plumb_law_body* body, void* context) {
    auto& to = *static_cast<Writer*>(context);
    to.id(body->body).add(body->centre).add(body->angle).add(body->velocity).add(body->angular_velocity);
    to.add(body->mass).add(body->inertia).wide(body->user_data);
    return plumb_wrench{};
  };
  plumb_world_apply_law(w, list, &out, dt, wakes != 0);
  return out.done();
}
/// Applies the forces in the buffer to the same bodies, in the same order.
PLUMB_EXPORT("apply_wrenches") void js_apply_wrenches(plumb_world* w, int wakes) {
  Reader r;
  const auto next = [](const plumb_law_body*, void* context) {
    auto& from = *static_cast<Reader*>(context);
    const plumb_vec2 force = from.point();
    return plumb_wrench{force, from.number()};
  };
  plumb_world_apply_law(w, next, &r, 0, wakes != 0);
}
PLUMB_EXPORT("apply_linear_drag")
void js_apply_linear_drag(plumb_world* w, double linear, double angular, double dt, int wakes) {
  plumb_world_apply_linear_drag(w, linear, angular, dt, wakes != 0);
}
PLUMB_EXPORT("apply_quadratic_drag")
void js_apply_quadratic_drag(plumb_world* w, double coefficient, double dt, int wakes) {
  plumb_world_apply_quadratic_drag(w, coefficient, dt, wakes != 0);
}
PLUMB_EXPORT("apply_attraction") void js_apply_attraction(plumb_world* w, double dt, int wakes) {
  Reader r;
  const plumb_attraction law = attraction(r);
  plumb_world_apply_attraction(w, r.point(), &law, dt, wakes != 0);
}
PLUMB_EXPORT("apply_attraction_to") void js_apply_attraction_to(PLUMB_HANDLE, double dt, int wakes) {
  Reader r;
  const plumb_attraction law = attraction(r);
  plumb_world_apply_attraction_to(w, {index, generation}, &law, dt, wakes != 0);
}
PLUMB_EXPORT("apply_wind")
void js_apply_wind(plumb_world* w, double x, double y, double density, double dt, int wakes) {
  const plumb_wind wind{{x, y}, density};
  plumb_world_apply_wind(w, &wind, dt, wakes != 0);
}
PLUMB_EXPORT("apply_water") void js_apply_water(plumb_world* w, double dt, int wakes) {
  Reader r;
  plumb_water water{};
  water.level = r.number(), water.density = r.number(), water.velocity = r.point();
  water.linear_drag = r.number(), water.angular_drag = r.number();
  plumb_world_apply_water(w, &water, dt, wakes != 0);
}
PLUMB_EXPORT("apply_spring")
void js_apply_spring(plumb_world* w, std::uint32_t a, std::uint32_t a_generation, std::uint32_t b,
                     std::uint32_t b_generation, double dt, int wakes) {
  Reader r;
  const plumb_vec2 point_a = r.point(), point_b = r.point();
  plumb_elastic_spring spring{};
  spring.stiffness = r.number(), spring.damping = r.number(), spring.rest_length = r.number();
  spring.pulls_only = r.flag();
  plumb_world_apply_spring(w, {a, a_generation}, point_a, {b, b_generation}, point_b, &spring, dt,
                           wakes != 0);
}
PLUMB_EXPORT("explode") void js_explode(plumb_world* w) {
  Reader r;
  plumb_blast blast{};
  blast.centre = r.point(), blast.radius = r.number(), blast.impulse = r.number();
  blast.occlusion = r.flag();
  blast.cover = query(r);
  plumb_world_explode(w, &blast);
}
}
