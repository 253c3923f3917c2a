#include "bindings/c/handle.h"
#include "bindings/c/query_filter.h"
#include "engine/world/force_laws.h"

using namespace plumb::c;

namespace {

plumb::Attraction attraction_of(const plumb_attraction* law) {
  const plumb_attraction& a = require(law, "attraction");
  return {a.strength, in<plumb::Attraction::Falloff>(a.falloff, 2, "attraction", "falloff"), a.softening};
}

/// Runs `law` on the world; a recorded one writes the state after it.
template <class Law>
plumb_status apply(plumb_world* world, Law&& law) {
  return checked([&] { edit(world, law); });
}

}  // namespace

plumb_attraction plumb_default_attraction(void) {
  const plumb::Attraction d;
  return {d.strength, static_cast<plumb_falloff>(d.falloff), d.softening};
}
plumb_wind plumb_default_wind(void) {
  const plumb::Wind d;
  return {out(d.velocity), d.density};
}
plumb_water plumb_default_water(void) {
  const plumb::Water d;
  return {d.level, d.density, out(d.velocity), d.linear_drag, d.angular_drag};
}
plumb_elastic_spring plumb_default_elastic_spring(void) {
  const plumb::ElasticSpring d;
  return {d.stiffness, d.damping, d.rest_length, d.pulls_only};
}
plumb_blast plumb_default_blast(void) {
  const plumb::Blast d;
  return {out(d.centre), d.radius, d.impulse, false, plumb_default_query_filter()};
}

plumb_status plumb_world_apply_law(plumb_world* world, plumb_law_function law, void* context, double dt,
                                   bool wakes) {
  return apply(world, [&](auto& w) {
    require(law, "law");
    const auto wrench_on = [&](const plumb::LawBody& b) {
      const plumb_law_body body{out(b.id),          out(b.centre), b.angle,   out(b.velocity),
                                b.angular_velocity, b.mass,        b.inertia, b.user_data};
      const plumb_wrench wrench = law(&body, context);
      return plumb::Wrench<double>{in(wrench.force), wrench.torque};
    };
    plumb::apply_law(w, wrench_on, {wakes, dt});
  });
}
plumb_status plumb_world_apply_linear_drag(plumb_world* world, double linear, double angular, double dt,
                                           bool wakes) {
  return apply(world, [&](auto& w) { plumb::apply_linear_drag(w, {linear, angular}, dt, {wakes}); });
}
plumb_status plumb_world_apply_quadratic_drag(plumb_world* world, double coefficient, double dt, bool wakes) {
  return apply(world, [&](auto& w) { plumb::apply_quadratic_drag(w, coefficient, dt, {wakes}); });
}
plumb_status plumb_world_apply_attraction(plumb_world* world, plumb_vec2 centre, const plumb_attraction* law,
                                          double dt, bool wakes) {
  return apply(world,
               [&](auto& w) { plumb::apply_attraction(w, in(centre), attraction_of(law), dt, {wakes}); });
}
plumb_status plumb_world_apply_attraction_to(plumb_world* world, plumb_body centre,
                                             const plumb_attraction* law, double dt, bool wakes) {
  return apply(world, [&](auto& w) {
    plumb::apply_attraction_to_body(w, in(centre), attraction_of(law), dt, {wakes});
  });
}
plumb_status plumb_world_apply_wind(plumb_world* world, const plumb_wind* wind, double dt, bool wakes) {
  return apply(world, [&](auto& w) {
    const plumb_wind& air = require(wind, "wind");
    plumb::apply_wind(w, {in(air.velocity), air.density}, dt, {wakes});
  });
}
plumb_status plumb_world_apply_water(plumb_world* world, const plumb_water* water, double dt, bool wakes) {
  return apply(world, [&](auto& w) {
    const plumb_water& pool = require(water, "water");
    plumb::apply_water(w, {pool.level, pool.density, in(pool.velocity), pool.linear_drag, pool.angular_drag},
                       dt, {wakes});
  });
}
plumb_status plumb_world_apply_spring(plumb_world* world, plumb_body a, plumb_vec2 point_a, plumb_body b,
                                      plumb_vec2 point_b, const plumb_elastic_spring* spring, double dt,
                                      bool wakes) {
  return apply(world, [&](auto& w) {
    const plumb_elastic_spring& s = require(spring, "spring");
    plumb::apply_spring(w, in(a), in(point_a), in(b), in(point_b),
                        {s.stiffness, s.damping, s.rest_length, s.pulls_only}, dt, {wakes});
  });
}
plumb_status plumb_world_explode(plumb_world* world, const plumb_blast* blast) {
  return apply(world, [&](auto& w) {
    const plumb_blast& b = require(blast, "blast");
    const Filtered cover(&b.cover);
    plumb::explode(w, {in(b.centre), b.radius, b.impulse}, {b.occlusion, cover.get()});
  });
}
