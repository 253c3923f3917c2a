#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/world.h"

/// Every call that changes a world, in a scene of sleeping bodies.
namespace plumb {

/// Sleeping bodies on, beside and under bodies of every type, and one far away on the same ground.
struct Ids {
  BodyId ground, lift, box, top, rider, hung, a, b, on_chain, far, wall;
  ShapeId tile, sensor;
  ChainId chain;
  JointId hinge, rod;
};

/// Builds the scene and steps until all bodies sleep.
template <class Real>
Ids lay_to_sleep(BasicWorld<Real>& world) {
  Ids s;
  const auto body = [&](Vec2d at, double size) {
    return world.create_body({.position = at}, ShapeDefinition{.geometry = Box{size, size}});
  };
  s.ground = world.create_body({.type = BodyType::Static});
  s.tile = world.create_shape(s.ground, {.geometry = Box{4, 1}, .position = {0, -0.5}});
  world.create_shape(s.ground, {.geometry = Box{4, 1}, .position = {40, -0.5}});
  world.create_shape(s.ground, {.geometry = Box{6, 1}, .position = {10, -0.5}});
  s.chain = world.create_chain(s.ground, {.points = {{22, 0}, {18, 0}}});
  s.lift = world.create_body({.type = BodyType::Kinematic, .position = {-10, 0}},
                             ShapeDefinition{.geometry = Box{3, 0.5}});
  s.wall = world.create_body({.type = BodyType::Static, .position = {0, 30}},
                             ShapeDefinition{.geometry = Box{1, 1}});
  s.box = body({0, 0.5}, 1), s.top = body({0, 1.4}, 0.8);
  s.rider = body({-10, 0.75}, 1);
  s.hung = body({-20, 4}, 1);
  s.hinge = world.create_joint(s.ground, s.hung,
                               {.kind = RevoluteDefinition{.anchor_a = {-20, 6}, .anchor_b = {0, 2}}});
  s.a = body({9, 0.5}, 1), s.b = body({11, 0.5}, 1);
  s.rod = world.create_joint(s.a, s.b, {.kind = DistanceDefinition{.length = 2}});
  s.on_chain = body({20, 0.5}, 1);
  s.far = body({40, 0.5}, 1);
  s.sensor = world.create_shape(s.ground, {.geometry = Box{1, 1}, .position = {0, 60}, .sensor = true});
  for (int i = 0; i < 300 && world.counts().awake > 0; ++i) world.step();
  return s;
}

/// A call on the world of `lay_to_sleep`.
template <class Real>
using Call = std::function<void(BasicWorld<Real>&, const Ids&)>;

template <class Real>
struct Row {
  std::string call;
  Call<Real> run;
  bool far_wakes = false;  ///< it acts on all
};

/// Returns the calls that change a body, its shapes or its joints.
template <class Real>
std::vector<Row<Real>> rows_of_body(BodyId Ids::*who, bool dynamic) {
  using W = BasicWorld<Real>;
  using S = const Ids;
  const auto at = [who](W& w, S& s, Vec2d by) { return w.position(s.*who) + by; };
  std::vector<Row<Real>> rows = {
      {"set_position",
       [=](W& w, S& s) {
         w.set_position(s.*who, at(w, s, {0.1, 0.3}), 0);
       }},
      {"set_velocity",
       [=](W& w, S& s) {
         w.set_velocity(s.*who, {0.3, 0.4});
       }},
      {"set_angular_velocity", [=](W& w, S& s) { w.set_angular_velocity(s.*who, 0.5); }},
      {"move_towards",
       [=](W& w, S& s) {
         w.move_towards(s.*who, at(w, s, {0.2, 0.1}), 0.1, 1);
       }},
      {"apply_force",
       [=](W& w, S& s) {
         w.apply_force(s.*who, {900, 0});
       }},
      {"apply_force",
       [=](W& w, S& s) {
         w.apply_force(s.*who, {900, 0}, at(w, s, {0, 0.2}));
       }},
      {"apply_torque", [=](W& w, S& s) { w.apply_torque(s.*who, 300); }},
      {"apply_impulse",
       [=](W& w, S& s) {
         w.apply_impulse(s.*who, {3, 0});
       }},
      {"apply_impulse",
       [=](W& w, S& s) {
         w.apply_impulse(s.*who, {3, 0}, at(w, s, {0, 0.2}));
       }},
      {"apply_angular_impulse", [=](W& w, S& s) { w.apply_angular_impulse(s.*who, 2); }},
      {"set_type", [=](W& w, S& s) { w.set_type(s.*who, BodyType::Static); }},
      {"set_type", [=](W& w, S& s) { w.set_type(s.*who, BodyType::Kinematic); }},
      {"set_type", [=](W& w, S& s) { w.set_type(s.*who, BodyType::Dynamic); }},
      {"set_mass",
       [=](W& w, S& s) {
         w.set_mass(s.*who, {.mass = 2, .centre = {0.9, 0}, .inertia = 0.3});
       }},
      {"use_densities", [=](W& w, S& s) { w.use_densities(s.*who); }},
      {"set_gravity_scale", [=](W& w, S& s) { w.set_gravity_scale(s.*who, -1); }},
      {"set_damping", [=](W& w, S& s) { w.set_damping(s.*who, 1, 1); }},
      {"set_locks", [=](W& w, S& s) { w.set_locks(s.*who, true, false, true); }},
      {"set_may_sleep", [=](W& w, S& s) { w.set_may_sleep(s.*who, false); }},
      {"set_awake", [=](W& w, S& s) { w.set_awake(s.*who, true); }},
      {"release", [=](W& w, S& s) { w.release(s.*who); }},
      {"set_user_data", [=](W& w, S& s) { w.set_user_data(s.*who, 5); }},
      {"set_continuous", [=](W& w, S& s) { w.set_continuous(s.*who, false); }},
      {"set_name", [=](W& w, S& s) { w.set_name(s.*who, "other"); }},
      {"set_enabled", [=](W& w, S& s) { w.set_enabled(s.*who, false); }},
      {"set_enabled",
       [=](W& w, S& s) {
         w.set_enabled(s.*who, false);
         w.set_enabled(s.*who, true);
       }},
      {"set_density", [=](W& w, S& s) { w.set_density(w.shapes(s.*who)[0], 5); }},
      {"set_sensor", [=](W& w, S& s) { w.set_sensor(w.shapes(s.*who)[0], true); }},
      {"set_geometry",
       [=](W& w, S& s) {
         w.set_geometry(w.shapes(s.*who)[0], Circle{0.3}, {0.1, 0});
       }},
      {"set_geometry",
       [=](W& w, S& s) {
         w.set_geometry(w.shapes(s.*who)[0], Box{1.4, 1.2});
       }},
      {"set_hit_events", [=](W& w, S& s) { w.set_hit_events(w.shapes(s.*who)[0], true); }},
      {"set_pre_solve", [=](W& w, S& s) { w.set_pre_solve(w.shapes(s.*who)[0], true); }},
      {"destroy", [=](W& w, S& s) { w.destroy(s.*who); }},
      {"destroy", [=](W& w, S& s) { w.destroy(w.shapes(s.*who)[0]); }},
      {"create_shape",
       [=](W& w, S& s) {
         w.create_shape(s.*who, {.geometry = Box{1, 1}, .position = {1.2, 0.1}, .density = 9});
       }},
      {"create_chain",
       [=](W& w, S& s) {
         w.create_chain(s.*who, {.points = {{0.2, 0.7}, {-0.2, 0.7}}});
       }},
      {"set_material",
       [=](W& w, S& s) {
         const ShapeId shape = w.shapes(s.*who)[0];
         w.set_material(shape, {.friction = 1, .surface_speed = 1});
       }},
      {"set_filter", [=](W& w, S& s) { w.set_filter(w.shapes(s.*who)[0], {.mask = 0}); }},
      {"set_filter", [=](W& w, S& s) { w.set_filter(w.shapes(s.*who)[0], {.category = 2}); }},
      {"create_joint",
       [=](W& w, S& s) {
         w.create_joint(s.*who, s.far, {.kind = DistanceDefinition{.length = 1, .spring = Spring{0.05, 1}}});
       },
       true},
  };
  if (!dynamic) return rows;
  const JointDefinition pull{
      .kind = DistanceDefinition{.anchor_a = {0, 0}, .length = 0.5, .spring = Spring{0.05, 1}}};
  const std::vector<BodyId Ids::*> others = {&Ids::wall, &Ids::lift, &Ids::a};
  for (const auto other : others) {
    if (other == who) continue;
    rows.push_back({"create_joint", [=](W& w, S& s) { w.create_joint(s.*who, s.*other, pull); }});
    rows.push_back({"create_joint", [=](W& w, S& s) { w.create_joint(s.*other, s.*who, pull); }});
  }
  return rows;
}

/// Returns the other calls.
template <class Real>
std::vector<Row<Real>> rows_of_world() {
  using W = BasicWorld<Real>;
  using S = const Ids;
  const ShapeDefinition block{.geometry = Box{1, 1}};
  return {
      {"step", [](W& w, S&) { w.step(); }},
      {"set_gravity",
       [](W& w, S&) {
         w.set_gravity({2, 4});
       },
       true},
      {"set_sleeping", [](W& w, S&) { w.set_sleeping(false); }, true},
      {"set_continuous", [](W& w, S&) { w.set_continuous(false); }},
      {"set_solver", [](W& w, S&) { w.set_solver(Solver::Xpbd); }, true},
      {"set_iterations", [](W& w, S&) { w.set_iterations(3); }, true},
      {"set_direct_islands", [](W& w, S&) { w.set_direct_islands(false); }, true},
      {"set_quarantine", [](W& w, S&) { w.set_quarantine(false); }},
      {"combine_with", [](W& w, S&) { w.combine_with(nullptr, nullptr); }},
      {"set_profiling", [](W& w, S&) { w.set_profiling(false); }},
      {"set_threads", [](W& w, S&) { w.set_threads(2); }},
      {"set_task_system", [](W& w, S&) { w.set_task_system({}); }},
      {"on_filter", [](W& w, S&) { w.on_filter([](ShapeId, ShapeId) { return false; }); }},
      {"set_thresholds", [](W& w, S&) { w.set_thresholds({.sleep = 0.01}); }, true},
      {"on_pre_solve", [](W& w, S&) { w.on_pre_solve([](const ContactReading&) { return false; }); }},
      {"create_body",
       [=](W& w, S&) {
         w.create_body({.type = BodyType::Static, .position = {0.9, 0.5}}, block);
       }},
      {"create_body",
       [=](W& w, S&) {
         w.create_body({.type = BodyType::Static, .position = {-10.9, 0.75}}, block);
       }},
      {"create_body",
       [=](W& w, S&) {
         std::vector<ShapeId> made;
         w.create_body({.type = BodyType::Kinematic, .position = {0.9, 0.5}}, std::vector{block}, made);
       }},
      {"create_body",
       [=](W& w, S&) {
         w.create_body({.position = {0.9, 0.5}}, block);
       }},
      {"set_position",
       [](W& w, S& s) {
         w.set_position(s.wall, {0.9, 0.5}, 0);
       }},
      {"set_position",
       [](W& w, S& s) {
         w.set_position(s.wall, {-20.9, 4}, 0);
       }},
      {"create_chain",
       [](W& w, S& s) {
         w.create_chain(s.ground, {.points = {{3, 0.3}, {-3, 0.3}}});
       }},
      {"create_shape",
       [=](W& w, S& s) {
         w.create_shape(s.ground, {.geometry = Box{1, 1}, .position = {0.9, 0.5}});
       }},
      {"destroy", [](W& w, S& s) { w.destroy(s.chain); }},
      {"destroy", [](W& w, S& s) { w.destroy(s.tile); }},
      {"destroy", [](W& w, S& s) { w.destroy(s.hinge); }},
      {"destroy", [](W& w, S& s) { w.destroy(s.rod); }},
      {"destroy", [](W& w, S& s) { w.destroy(s.sensor); }},
      {"set_filter", [](W& w, S& s) { w.set_filter(s.tile, {.mask = 0}); }},
      {"set_geometry",
       [](W& w, S& s) {
         w.set_geometry(s.tile, Box{4, 1}, {0, -1});
       }},
      {"set_geometry",
       [](W& w, S& s) {
         w.set_geometry(s.tile, Box{6, 2}, {8, 0.2}, 0.1);
       }},
      {"set_geometry",
       [](W& w, S& s) {
         w.set_geometry(s.sensor, Box{3, 3}, {0, -59});
       }},
      {"set_sensor", [](W& w, S& s) { w.set_sensor(s.tile, true); }},
      {"set_sensor", [](W& w, S& s) { w.set_sensor(s.sensor, false); }},
      {"set_material", [](W& w, S& s) { w.set_material(s.tile, {.friction = 1, .surface_speed = 1}); }},
      {"change",
       [](W& w, S& s) {
         RevoluteDefinition driven{.anchor_a = {-20, 6}, .anchor_b = {0, 2}};
         driven.motor = Motor{1, 1000};
         w.change(s.hinge, driven);
       }},
      {"change", [](W& w, S& s) { w.change(s.rod, DistanceDefinition{.length = 1.5}); }},
      {"set_load_events", [](W& w, S& s) { w.set_load_events(s.rod, 1, 1); }},
  };
}

}  // namespace plumb
