#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/world/force_laws.h"
#include "engine/world/mover.h"
#include "engine/world/queries.h"
#include "engine/world/rollback.h"
#include "tests/bad_input/fields.h"
#include "tests/bad_input/things.h"

/// Every call of a world that takes a number, and which numbers it may take.
namespace plumb::bad_input {

constexpr Rule kAny{-1e12, 1e12}, kPlace{-1e100, 1e100}, kNotNegative{0, 1e12}, kPositive{1e-12, 1e12};

/// A number of a call.
template <class Real>
struct NumberCall {
  std::string call, subject, field;
  Rule rule;
  std::function<void(Things<Real>&, double)> run;
};

template <class Real>
struct CallList {
  std::vector<NumberCall<Real>> calls{};
  std::string subject{};  ///< that errors of the calls from here on name

  void number(const std::string& call, const std::string& field, Rule rule,
              std::function<void(Things<Real>&, double)> run) {
    calls.push_back({call, subject, field, rule, std::move(run)});
  }
  /// Both components of a vector.
  void vector(const std::string& call, const std::string& field,
              const std::function<void(Things<Real>&, Vec2d)>& run, Rule rule = kAny) {
    number(call, field, rule, [run](Things<Real>& t, double x) { run(t, {x, 0.5}); });
    number(call, field, rule, [run](Things<Real>& t, double y) { run(t, {0.5, y}); });
  }
};

inline void expect_finite(const MoverResult& at) { expect_finite(at.position), expect_finite(at.velocity); }
template <class Hit>
void finite_hit(const std::optional<Hit>& hit) {
  if (hit) expect_finite(Vec2d{hit->fraction, 0}), expect_finite(hit->point), expect_finite(hit->normal);
}

template <class Real>
void add_world_calls(CallList<Real>& list) {
  using T = Things<Real>;
  list.subject = "step";
  list.number("step", "dt", kPositive, [](T& t, double x) { t.world.step(x, 1); });
  list.number("step", "substeps", {1, 1000},
              [](T& t, double x) { t.world.step(1.0 / 60, static_cast<int>(x)); });
  list.subject = "world";
  list.vector("set_gravity", "gravity", [](T& t, Vec2d v) { t.world.set_gravity(v); });
  list.number("set_iterations", "iterations", {1, 1000},
              [](T& t, double x) { t.world.set_iterations(static_cast<int>(x)); });
  list.number("set_threads", "threads", {1, 64},
              [](T& t, double x) { t.world.set_threads(static_cast<int>(x)); });
  list.number("set_solver", "solver", {0, 4},
              [](T& t, double x) { t.world.set_solver(static_cast<Solver>(x)); });
}

template <class Real>
void add_motion_calls(CallList<Real>& list) {
  using T = Things<Real>;
  list.subject = "body 'box'";
  list.vector(
      "velocity_at", "point", [](T& t, Vec2d v) { expect_finite(t.world.velocity_at(t.box, v)); }, kPlace);
  list.vector(
      "world_point", "local", [](T& t, Vec2d v) { expect_finite(t.world.world_point(t.box, v)); }, kPlace);
  list.vector(
      "local_point", "world", [](T& t, Vec2d v) { expect_finite(t.world.local_point(t.box, v)); }, kPlace);
  list.vector("set_position", "position", [](T& t, Vec2d v) { t.world.set_position(t.box, v, 0); });
  list.number("set_position", "angle", kAny, [](T& t, double x) { t.world.set_position(t.box, {0, 3}, x); });
  list.vector("set_velocity", "velocity", [](T& t, Vec2d v) { t.world.set_velocity(t.box, v); });
  list.number("set_angular_velocity", "angular_velocity", kAny,
              [](T& t, double x) { t.world.set_angular_velocity(t.box, x); });
  list.subject = "body 1";
  list.vector("move_towards", "position", [](T& t, Vec2d v) { t.world.move_towards(t.lift, v, 0, 1); });
  list.number("move_towards", "angle", kAny, [](T& t, double x) { t.world.move_towards(t.lift, {}, x, 1); });
  list.number("move_towards", "dt", kPositive,
              [](T& t, double x) { t.world.move_towards(t.lift, {}, 0, x); });
}

template <class Real>
void add_force_calls(CallList<Real>& list) {
  using T = Things<Real>;
  list.subject = "body 'box'";
  list.vector("apply_force", "force", [](T& t, Vec2d v) { t.world.apply_force(t.box, v); });
  list.vector("apply_force", "force", [](T& t, Vec2d v) { t.world.apply_force(t.box, v, {}); });
  list.vector("apply_force", "point", [](T& t, Vec2d v) { t.world.apply_force(t.box, {1, 1}, v); });
  list.number("apply_torque", "torque", kAny, [](T& t, double x) { t.world.apply_torque(t.box, x); });
  list.vector("apply_impulse", "impulse", [](T& t, Vec2d v) { t.world.apply_impulse(t.box, v); });
  list.vector("apply_impulse", "impulse", [](T& t, Vec2d v) { t.world.apply_impulse(t.box, v, {}); });
  list.vector("apply_impulse", "point", [](T& t, Vec2d v) { t.world.apply_impulse(t.box, {1, 1}, v); });
  list.number("apply_angular_impulse", "angular_impulse", kAny,
              [](T& t, double x) { t.world.apply_angular_impulse(t.box, x); });
  list.number("set_type", "type", {0, 2},
              [](T& t, double x) { t.world.set_type(t.box, static_cast<BodyType>(x)); });
  list.number("set_gravity_scale", "gravity_scale", kAny,
              [](T& t, double x) { t.world.set_gravity_scale(t.box, x); });
  list.subject = "shape 2 of body 'box'";
  list.number("set_density", "density", kNotNegative,
              [](T& t, double x) { t.world.set_density(t.shape, x); });
  list.number("set_geometry", "radius", kPositive,
              [](T& t, double x) { t.world.set_geometry(t.shape, Circle{x}); });
  list.vector("set_geometry", "position", [](T& t, Vec2d v) { t.world.set_geometry(t.shape, Box{1, 1}, v); });
  list.number("set_geometry", "angle", kAny, [](T& t, double x) {
    t.world.set_geometry(t.shape, Box{1, 1}, {}, x);
  });
  list.subject = "body 'box'";
  list.number("set_damping", "linear_damping", kNotNegative,
              [](T& t, double x) { t.world.set_damping(t.box, x, 0); });
  list.number("set_damping", "angular_damping", kNotNegative,
              [](T& t, double x) { t.world.set_damping(t.box, 0, x); });
  list.subject = "joint";
  list.number("set_load_events", "report_force", kNotNegative,
              [](T& t, double x) { t.world.set_load_events(t.joint, x, 0); });
  list.number("set_load_events", "report_torque", kNotNegative,
              [](T& t, double x) { t.world.set_load_events(t.joint, 0, x); });
}

template <class Real>
void add_drag_and_attraction_calls(CallList<Real>& list) {
  using T = Things<Real>;
  list.subject = "linear drag";
  list.number("apply_linear_drag", "linear", kNotNegative,
              [](T& t, double x) { apply_linear_drag(t.world, {.linear = x}, 0.1); });
  list.number("apply_linear_drag", "angular", kNotNegative,
              [](T& t, double x) { apply_linear_drag(t.world, {.angular = x}, 0.1); });
  list.number("apply_linear_drag", "dt", kPositive,
              [](T& t, double x) { apply_linear_drag(t.world, {.linear = 1}, x); });
  list.subject = "quadratic drag";
  list.number("apply_quadratic_drag", "coefficient", kNotNegative,
              [](T& t, double x) { apply_quadratic_drag(t.world, x, 0.1); });
  list.number("apply_quadratic_drag", "dt", kPositive,
              [](T& t, double x) { apply_quadratic_drag(t.world, 1, x); });
  list.subject = "attraction";
  list.vector("apply_attraction", "centre", [](T& t, Vec2d v) { apply_attraction(t.world, v, {}, 0.1); });
  list.number("apply_attraction", "strength", kAny, [](T& t, double x) {
    apply_attraction(t.world, {9, 9}, {.strength = x}, 0.1);
  });
  list.number("apply_attraction", "softening", kPositive, [](T& t, double x) {
    apply_attraction(t.world, {9, 9}, {.softening = x}, 0.1);
  });
  list.number("apply_attraction", "falloff", {0, 1}, [](T& t, double x) {
    apply_attraction(t.world, {9, 9}, {.falloff = static_cast<Attraction::Falloff>(static_cast<int>(x))},
                     0.1);
  });
  list.number("apply_attraction", "dt", kPositive, [](T& t, double x) {
    apply_attraction(t.world, {9, 9}, {}, x);
  });
  list.number("apply_attraction_to_body", "strength", kAny,
              [](T& t, double x) { apply_attraction_to_body(t.world, t.ball, {.strength = x}, 0.1); });
  list.number("apply_attraction_to_body", "softening", kPositive,
              [](T& t, double x) { apply_attraction_to_body(t.world, t.ball, {.softening = x}, 0.1); });
  list.number("apply_attraction_to_body", "dt", kPositive,
              [](T& t, double x) { apply_attraction_to_body(t.world, t.ball, {}, x); });
}

template <class Real>
void add_fluid_spring_and_blast_calls(CallList<Real>& list) {
  using T = Things<Real>;
  list.subject = "wind";
  list.vector("apply_wind", "velocity", [](T& t, Vec2d v) { apply_wind(t.world, {.velocity = v}, 0.1); });
  list.number("apply_wind", "density", kNotNegative, [](T& t, double x) {
    apply_wind(t.world, {.velocity = {1, 0}, .density = x}, 0.1);
  });
  list.number("apply_wind", "dt", kPositive, [](T& t, double x) {
    apply_wind(t.world, {.velocity = {1, 0}}, x);
  });
  list.subject = "water";
  list.number("apply_water", "level", kAny, [](T& t, double x) { apply_water(t.world, {.level = x}, 0.1); });
  list.number("apply_water", "density", kNotNegative,
              [](T& t, double x) { apply_water(t.world, {.level = 9, .density = x}, 0.1); });
  list.vector("apply_water", "velocity", [](T& t, Vec2d v) {
    apply_water(t.world, {.level = 9, .velocity = v, .linear_drag = 1}, 0.1);
  });
  list.number("apply_water", "linear_drag", kNotNegative,
              [](T& t, double x) { apply_water(t.world, {.level = 9, .linear_drag = x}, 0.1); });
  list.number("apply_water", "angular_drag", kNotNegative,
              [](T& t, double x) { apply_water(t.world, {.level = 9, .angular_drag = x}, 0.1); });
  list.number("apply_water", "dt", kPositive, [](T& t, double x) { apply_water(t.world, {.level = 9}, x); });
  list.subject = "spring";
  list.vector("apply_spring", "point_a",
              [](T& t, Vec2d v) { apply_spring(t.world, t.box, v, t.ball, {}, {}, 0.1); });
  list.vector("apply_spring", "point_b",
              [](T& t, Vec2d v) { apply_spring(t.world, t.box, {}, t.ball, v, {}, 0.1); });
  list.number("apply_spring", "stiffness", kNotNegative,
              [](T& t, double x) { apply_spring(t.world, t.box, {}, t.ball, {}, {.stiffness = x}, 0.1); });
  list.number("apply_spring", "damping", kNotNegative,
              [](T& t, double x) { apply_spring(t.world, t.box, {}, t.ball, {}, {.damping = x}, 0.1); });
  list.number("apply_spring", "rest_length", kNotNegative,
              [](T& t, double x) { apply_spring(t.world, t.box, {}, t.ball, {}, {.rest_length = x}, 0.1); });
  list.number("apply_spring", "dt", kPositive,
              [](T& t, double x) { apply_spring(t.world, t.box, {}, t.ball, {}, {}, x); });
  list.subject = "explosion";
  list.vector("explode", "centre", [](T& t, Vec2d v) { explode(t.world, {.centre = v}); });
  list.number("explode", "radius", kPositive, [](T& t, double x) {
    explode(t.world, {.centre = {9, 0}, .radius = x});
  });
  list.number("explode", "impulse", kAny, [](T& t, double x) {
    explode(t.world, {.centre = {1, 3}, .impulse = x});
  });
}

template <class Real>
void add_ray_calls(CallList<Real>& list) {
  using T = Things<Real>;
  list.subject = "ray";
  list.vector("ray_cast_closest", "origin", [](T& t, Vec2d v) {
    finite_hit(ray_cast_closest(t.world, v, {3, -3}));
  });
  list.vector("ray_cast_closest", "translation", [](T& t, Vec2d v) {
    finite_hit(ray_cast_closest(t.world, {0, 5}, v));
  });
  list.vector("ray_cast", "origin", [](T& t, Vec2d v) {
    ray_cast(t.world, v, {3, -3}, {}, [](const RayResult& hit) { return hit.fraction; });
  });
  list.vector("ray_cast", "translation", [](T& t, Vec2d v) {
    ray_cast(t.world, {0, 5}, v, {}, [](const RayResult& hit) { return hit.fraction; });
  });
  list.vector("ray_cast_all", "origin", [](T& t, Vec2d v) {
    std::vector<RayResult> hits;
    ray_cast_all(t.world, v, {3, -3}, {}, hits);
  });
  list.vector("ray_cast_all", "translation", [](T& t, Vec2d v) {
    std::vector<RayResult> hits;
    ray_cast_all(t.world, {0, 5}, v, {}, hits);
  });
}

template <class Real>
void add_cast_calls(CallList<Real>& list) {
  using T = Things<Real>;
  list.subject = "cast";
  list.vector("cast_shape_closest", "position", [](T& t, Vec2d v) {
    finite_hit(cast_shape_closest(t.world, Circle{0.5}, v, 0, {3, -3}));
  });
  list.number("cast_shape_closest", "angle", kAny, [](T& t, double x) {
    finite_hit(cast_shape_closest(t.world, Box{0.5, 1}, {0, 9}, x, {0, -9}));
  });
  list.vector("cast_shape_closest", "translation", [](T& t, Vec2d v) {
    finite_hit(cast_shape_closest(t.world, Box{0.5, 1}, {0, 9}, 1, v));
  });
  list.vector("cast_shape", "position", [](T& t, Vec2d v) {
    cast_shape(t.world, Circle{0.5}, v, 0, {3, -3}, {}, [](const CastShapeResult&) { return 1.0; });
  });
  list.number("cast_shape", "angle", kAny, [](T& t, double x) {
    cast_shape(t.world, Circle{0.5}, {0, 5}, x, {3, -3}, {}, [](const CastShapeResult&) { return 1.0; });
  });
  list.vector("cast_shape", "translation", [](T& t, Vec2d v) {
    cast_shape(t.world, Circle{0.5}, {0, 5}, 0, v, {}, [](const CastShapeResult&) { return 1.0; });
  });
}

template <class Real>
void add_place_calls(CallList<Real>& list) {
  using T = Things<Real>;
  list.subject = "overlap";
  list.vector("overlap_shape", "position", [](T& t, Vec2d v) {
    std::vector<ShapeId> found;
    overlap_shape(t.world, Circle{0.5}, v, 0, {}, found);
  });
  list.number("overlap_shape", "angle", kAny, [](T& t, double x) {
    std::vector<ShapeId> found;
    overlap_shape(t.world, Box{0.5, 2}, {}, x, {}, found);
  });
  list.vector("overlap_box", "lower", [](T& t, Vec2d v) {
    std::vector<ShapeId> found;
    overlap_box(t.world, {v, {1e12, 1e12}}, {}, found);
  });
  list.vector("overlap_box", "upper", [](T& t, Vec2d v) {
    std::vector<ShapeId> found;
    overlap_box(t.world, {{-1e12, -1e12}, v}, {}, found);
  });
  list.subject = "contains";
  list.vector("contains", "point", [](T& t, Vec2d v) { contains(t.world, t.shape, v); });
  list.subject = "shapes_at";
  list.vector("shapes_at", "point", [](T& t, Vec2d v) {
    std::vector<ShapeId> found;
    shapes_at(t.world, v, {}, found);
  });
  list.subject = "nearest";
  list.vector("nearest", "point", [](T& t, Vec2d v) {
    if (const auto hit = nearest(t.world, v, 1e12)) expect_finite(hit->point);
  });
  list.number("nearest", "max_distance", {0, std::numeric_limits<double>::infinity()}, [](T& t, double x) {
    nearest(t.world, {0, 5}, x);
  });
}

template <class Real>
void add_mover_calls(CallList<Real>& list) {
  using T = Things<Real>;
  const Capsule person{{0, 0}, {0, 1}, 0.25};
  list.subject = "mover";
  list.vector("move", "position", [=](T& t, Vec2d v) {
    expect_finite(move(t.world, person, v, {1, 0}, 0.1));
  });
  list.vector("move", "velocity", [=](T& t, Vec2d v) {
    expect_finite(move(t.world, person, {0, 5}, v, 0.1));
  });
  list.number("move", "dt", kPositive, [=](T& t, double x) {
    expect_finite(move(t.world, person, {0, 5}, {1, 0}, x));
  });
  list.vector("move", "up", [=](T& t, Vec2d v) {
    expect_finite(move(t.world, person, {0, 5}, {1, 0}, 0.1, {.up = v}));
  });
  list.number("move", "max_slope", {0, 1.5707963267948966}, [=](T& t, double x) {
    expect_finite(move(t.world, person, {0, 5}, {1, 0}, 0.1, {.max_slope = x}));
  });
  list.number("move", "step_height", kNotNegative, [=](T& t, double x) {
    expect_finite(move(t.world, person, {0, 5}, {1, 0}, 0.1, {.step_height = x}));
  });
  list.number("move", "skin", kNotNegative, [=](T& t, double x) {
    expect_finite(move(t.world, person, {0, 5}, {1, 0}, 0.1, {.skin = x}));
  });
  list.number("move", "mass", kNotNegative, [=](T& t, double x) {
    expect_finite(move(t.world, person, {0, 5}, {1, 0}, 0.1, {.mass = x}));
  });
  list.number("move", "push_force", kNotNegative, [=](T& t, double x) {
    expect_finite(move(t.world, person, {0, 5}, {1, 0}, 0.1, {.push_force = x}));
  });
  list.subject = "rollback";
  list.number("Rollback", "frames", {1, 10000},
              [](T& t, double x) { Rollback<Real>(t.world, static_cast<int>(x)); });
}

template <class Real>
std::vector<NumberCall<Real>> number_calls() {
  CallList<Real> list;
  add_world_calls(list), add_motion_calls(list), add_force_calls(list), add_drag_and_attraction_calls(list);
  add_fluid_spring_and_blast_calls(list), add_ray_calls(list), add_cast_calls(list), add_place_calls(list);
  add_mover_calls(list);
  return list.calls;
}

}  // namespace plumb::bad_input
