#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "engine/scene/scene.h"

/// A second reading of a scene's physics, written for the tests alone: what the truths are held against.
namespace plumb::scenarios::testing {

struct Rate {
  Vec2d linear{};
  double angular = 0;
};

inline double norm(Vec2d v) { return std::hypot(v.x, v.y); }

inline Vec2d turned(double angle, Vec2d v) {
  return {std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y};
}

/// A point of a body, or of the world.
struct End {
  Vec2d place{}, velocity{};
};

inline End end(const Scene& scene, std::span<const BodyState> states, std::string_view name, Vec2d anchor) {
  const auto body = find_body(scene, name);
  if (!body) return {anchor};
  const BodyState& s = states[*body];
  const Vec2d arm = turned(s.angle, anchor);
  return {s.position + arm, s.velocity + s.angular_velocity * perpendicular(arm)};
}

/// Energy of springs and attractions, J: written from the laws' definitions.
inline double potential(const Scene& scene, std::span<const BodyState> states, const ForceLaw& law) {
  if (const auto* spring = std::get_if<SpringForce>(&law)) {
    const double stretch = norm(end(scene, states, spring->body_a, spring->anchor_a).place -
                                end(scene, states, spring->body_b, spring->anchor_b).place) -
                           spring->rest_length;
    return spring->stiffness * stretch * stretch / 2;
  }
  if (const auto* pull = std::get_if<AttractionForce>(&law)) {
    const std::size_t attracted = *find_body(scene, pull->body);
    const double r =
        norm(end(scene, states, pull->centre_body, pull->centre).place - states[attracted].position);
    const double mu = pull->strength * scene.bodies[attracted].mass;
    const int n = pull->exponent;
    return n == 1 ? mu * std::log(r) : -mu / ((n - 1) * std::pow(r, n - 1));
  }
  return 0;
}

/// Newton and Euler: gravity and the scene's force laws, without joints and contacts.
inline Rate acceleration(const Scene& scene, std::size_t body, std::span<const BodyState> states,
                         double time) {
  const BodyState& state = states[body];
  const Body& of = scene.bodies[body];
  if (of.type != BodyType::Dynamic) return {};
  Vec2d force = of.mass * of.gravity_scale * scene.gravity - of.mass * of.linear_damping * state.velocity;
  double torque = -inertia_of(of) * of.angular_damping * state.angular_velocity;
  for (const ForceLaw& law : scene.forces) {
    if (const auto* drag = std::get_if<LinearDrag>(&law); drag && drag->body == of.name)
      force -= drag->coefficient * state.velocity;
    if (const auto* drag = std::get_if<QuadraticDrag>(&law); drag && drag->body == of.name)
      force -= drag->coefficient * norm(state.velocity) * state.velocity;
    if (const auto* push = std::get_if<PointForce>(&law);
        push && push->body == of.name && time >= push->start && time < push->start + push->duration) {
      const Vec2d f = push->frame == Frame::World ? push->force : turned(state.angle, push->force);
      force += f;
      torque += cross(turned(state.angle, push->point), f);
    }
    if (const auto* wave = std::get_if<SinusoidalForce>(&law); wave && wave->body == of.name) {
      const Vec2d f = std::sin(wave->angular_frequency * time + wave->phase) * wave->amplitude;
      force += f;
      torque += cross(turned(state.angle, wave->point), f);
    }
    if (const auto* spring = std::get_if<SpringForce>(&law)) {
      if (spring->body_a == of.name || spring->body_b == of.name) {
        const bool first = spring->body_a == of.name;
        const End own = end(scene, states, of.name, first ? spring->anchor_a : spring->anchor_b);
        const End far = first ? end(scene, states, spring->body_b, spring->anchor_b)
                              : end(scene, states, spring->body_a, spring->anchor_a);
        const Vec2d way = far.place - own.place, axis = 1 / norm(way) * way;
        const Vec2d f = (spring->stiffness * (norm(way) - spring->rest_length) +
                         spring->damping * dot(axis, far.velocity - own.velocity)) *
                        axis;
        force += f;
        torque += cross(own.place - state.position, f);
      }
    }
    if (const auto* pull = std::get_if<AttractionForce>(&law)) {
      if (pull->body == of.name || pull->centre_body == of.name) {
        const End centre = end(scene, states, pull->centre_body, pull->centre);
        const std::size_t attracted = *find_body(scene, pull->body);
        const Vec2d way = centre.place - states[attracted].position;
        const Vec2d f =
            pull->strength * scene.bodies[attracted].mass / std::pow(norm(way), pull->exponent + 1) * way;
        force += attracted == body ? f : -f;
        if (attracted != body) torque -= cross(centre.place - state.position, f);
      }
    }
    if (const auto* twist = std::get_if<Torque>(&law);
        twist && twist->body == of.name && time >= twist->start && time < twist->start + twist->duration)
      torque += twist->torque;
  }
  const double inertia = inertia_of(of);
  return {1 / of.mass * force, inertia > 0 ? torque / inertia : 0};
}

/// A sum, and the sum of its terms' sizes: what rounding is relative to.
struct Total {
  double value = 0, scale = 0;
  void add(double term) { value += term, scale += std::fabs(term); }
};

struct Totals {
  Total energy, momentum_x, momentum_y, angular_momentum;
};

inline Totals totals(const Scene& scene, std::span<const BodyState> states) {
  Totals sum;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    const BodyState& s = states[i];
    const Vec2d momentum = body.mass * s.velocity;
    const double spin = inertia_of(body) * s.angular_velocity;
    sum.energy.add(dot(momentum, s.velocity) / 2);
    sum.energy.add(spin * s.angular_velocity / 2);
    sum.energy.add(-body.mass * body.gravity_scale * scene.gravity.x * s.position.x);
    sum.energy.add(-body.mass * body.gravity_scale * scene.gravity.y * s.position.y);
    sum.momentum_x.add(momentum.x);
    sum.momentum_y.add(momentum.y);
    sum.angular_momentum.add(s.position.x * momentum.y);
    sum.angular_momentum.add(-s.position.y * momentum.x);
    sum.angular_momentum.add(spin);
  }
  for (const ForceLaw& law : scene.forces) {
    sum.energy.add(potential(scene, states, law));
    // A spring's length is a difference of places, which are rounded.
    if (const auto* spring = std::get_if<SpringForce>(&law)) {
      const Vec2d a = end(scene, states, spring->body_a, spring->anchor_a).place;
      const Vec2d b = end(scene, states, spring->body_b, spring->anchor_b).place;
      const double tension = spring->stiffness * std::fabs(norm(b - a) - spring->rest_length);
      sum.energy.scale += tension * (norm(a) + norm(b));
    }
  }
  return sum;
}

/// Returns true if any two bodies' shapes may meet.
inline bool has_contacts(const Scene& scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (std::size_t j = i + 1; j < scene.bodies.size(); ++j)
      for (const Shape& a : scene.bodies[i].shapes)
        for (const Shape& b : scene.bodies[j].shapes)
          if (may_touch(a.filter, b.filter)) return true;
  return false;
}

}  // namespace plumb::scenarios::testing
