#include "engine/world/force_laws.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/forces/fluid_drag.h"
#include "engine/math/small_rotation.h"
#include "engine/scene/error.h"
#include "engine/world/forces/elastic_step.h"
#include "engine/world/forces/law_bodies.h"
#include "engine/world/state/lock.h"

namespace plumb {

void report_not_finite(const std::string& name, int body, const char* field) {
  const std::string subject = name.empty() ? "body " + std::to_string(body) : "body '" + name + "'";
  throw Error(Error::Kind::Value, subject, field, "",
              "is not finite or beyond 1e12; check what the law divides by");
}

namespace {

// Returns what a law sees of a body, `ahead` seconds from now.
template <class Real>
LawBody view_of(const WorldData<Real>& w, int body, double ahead) {
  const BodyRecord<Real>& record = w.bodies[body];
  const SolverBody<Real>& motion = w.motion[body];
  const Vec2d velocity = motion.velocity.template as<double>();
  const double angular_velocity = static_cast<double>(motion.angular_velocity);
  return {{static_cast<std::uint32_t>(body), w.bodies.generation(body)},
          w.position[body] + ahead * velocity,
          record.angle + ahead * angular_velocity,
          velocity,
          angular_velocity,
          static_cast<double>(record.mass),
          static_cast<double>(record.inertia),
          w.body_data.get(body)};
}

// Returns the weight of a body in free flight. Returns zero for a body with constraints, whose forces are not
// known before the step.
template <class Real>
Wrench<double> weight_in_flight(const WorldData<Real>& w, int body) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.constraints > 0) return {};
  return {static_cast<double>(record.mass * w.extras_of(body).gravity_scale) * w.settings.gravity, 0};
}

// Returns the sum of weight and applied forces of a body in free flight. Returns zero for a body with
// constraints, whose forces are not known before the step.
template <class Real>
Wrench<double> known_load(const WorldData<Real>& w, int body) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.constraints > 0) return {};
  const Real scale = w.extras_of(body).gravity_scale;
  const Load<Real> load = w.loads.get(body);
  const Vec2d weight = static_cast<double>(record.mass * scale) * w.settings.gravity;
  return {weight + load.force.template as<double>(), static_cast<double>(load.torque)};
}

template <class Real>
Vec2d evaluation_point(const WorldData<Real>& w, int body, double dt) {
  return w.position[body] +
         (evaluation_fraction(w, body, dt) * dt) * w.motion[body].velocity.template as<double>();
}

// A body of a spring in a step of springs.
struct SpringEnd {
  int body = 0;             ///< there
  Vec2d arm{};              ///< m
  double inverse_mass = 0;  ///< 1/kg, of the end along the direction in which it is largest
};

// Adds a body of a spring, whose end is at `end` now, to a step of springs. As scene_forces.cpp does, it uses
// x + (1/2 - c) dt v as the body's position, and the weight for its motion without the spring:
// with the pulls of other springs, those of a grid of masses feed each other.
template <class Real>
SpringEnd add_end(ElasticStep& step, const WorldData<Real>& w, int body, Vec2d end, double dt) {
  const SolverBody<Real>& motion = w.motion[body];
  const BodyRecord<Real>& record = w.bodies[body];
  const Vec2d velocity = motion.velocity.template as<double>();
  const double spin = static_cast<double>(motion.angular_velocity),
               ahead = (evaluation_fraction(w, body, dt) - 0.5) * dt;
  const double inverse_mass = static_cast<double>(motion.inverse_mass),
               inverse_inertia = static_cast<double>(motion.inverse_inertia);
  const Vec2d inverse{record.lock_x ? 0 : inverse_mass, record.lock_y ? 0 : inverse_mass};
  const int index = step.add_body({w.position[body] + ahead * velocity, inverse, inverse_inertia});
  const Vec2d arm = rotated_by(Rotation<double>{1, 0}, ahead * spin) * (end - w.position[body]);
  const Wrench<double> load = weight_in_flight(w, body);
  const Vec2d gain{inverse.x * load.force.x, inverse.y * load.force.y};
  step.set_free_motion(index, dt * (velocity + 0.5 * dt * gain),
                       dt * (spin + 0.5 * dt * inverse_inertia * load.torque));
  return {index, arm, std::max(inverse.x, inverse.y) + inverse_inertia * length_squared(arm)};
}

void check(const Attraction& law, double dt) {
  require_finite("attraction", "strength", law.strength);
  if (law.falloff != Attraction::Falloff::InverseSquare && law.falloff != Attraction::Falloff::Linear) {
    throw Error(Error::Kind::Value, "attraction", "falloff", std::to_string(static_cast<int>(law.falloff)),
                "is no member of its enumeration");
  }
  require_positive("attraction", "softening", law.softening);
  require_positive("attraction", "dt", dt);
}

}  // namespace

template <class Real>
void apply_law(BasicWorld<Real>& world, BodyLaw law, LawOptions options) {
  require_not_negative("law", "dt", options.dt);
  WorldData<Real>& w = unlocked_with_masses(world);
  const Lock<Real> lock(w);
  apply_to_bodies(w, options.wakes, [&](int body) {
    return law(view_of(w, body, options.dt > 0 ? evaluation_fraction(w, body, options.dt) * options.dt : 0));
  });
}

template <class Real>
void apply_linear_drag(BasicWorld<Real>& world, const LinearDragRates& rates, double dt, LawOptions options) {
  require_not_negative("linear drag", "linear", rates.linear);
  require_not_negative("linear drag", "angular", rates.angular);
  require_positive("linear drag", "dt", dt);
  WorldData<Real>& w = unlocked_with_masses(world);
  apply_to_bodies(w, options.wakes, [&](int body) -> Wrench<double> {
    const SolverBody<Real>& motion = w.motion[body];
    const Wrench<double> load = known_load(w, body);
    return {mean_linear_drag(motion.velocity.template as<double>(), rates.linear,
                             static_cast<double>(motion.inverse_mass), load.force, dt),
            mean_linear_drag(static_cast<double>(motion.angular_velocity), rates.angular,
                             static_cast<double>(motion.inverse_inertia), load.torque, dt)};
  });
}

template <class Real>
void apply_quadratic_drag(BasicWorld<Real>& world, double coefficient, double dt, LawOptions options) {
  require_not_negative("quadratic drag", "coefficient", coefficient);
  require_positive("quadratic drag", "dt", dt);
  WorldData<Real>& w = unlocked_with_masses(world);
  apply_to_bodies(w, options.wakes, [&](int body) -> Wrench<double> {
    const SolverBody<Real>& motion = w.motion[body];
    return {mean_quadratic_drag(motion.velocity.template as<double>(), coefficient,
                                static_cast<double>(motion.inverse_mass), known_load(w, body).force, dt),
            0};
  });
}

template <class Real>
void apply_attraction(BasicWorld<Real>& world, Vec2d centre, const Attraction& law, double dt,
                      LawOptions options) {
  check(law, dt);
  require_finite("attraction", "centre", centre);
  WorldData<Real>& w = unlocked_with_masses(world);
  apply_to_bodies(w, options.wakes, [&](int body) -> Wrench<double> {
    const double mass = static_cast<double>(w.bodies[body].mass);
    return {attraction_force(law, mass, evaluation_point(w, body, dt) - centre), 0};
  });
}

template <class Real>
void apply_attraction_to_body(BasicWorld<Real>& world, BodyId centre, const Attraction& law, double dt,
                              LawOptions options) {
  check(law, dt);
  world.position(centre);  // throws for an invalid handle
  WorldData<Real>& w = unlocked_with_masses(world);
  const int source = static_cast<int>(centre.index);
  const Vec2d source_position = evaluation_point(w, source, dt);
  WrenchList list;
  Vec2d reaction{};
  for_each_law_body(w, options.wakes, [&](int body) {
    if (body == source) return;
    const double mass = static_cast<double>(w.bodies[body].mass);
    const Vec2d force = attraction_force(law, mass, evaluation_point(w, body, dt) - source_position);
    list.add(body, {force, 0});
    if (is_sound(Wrench<double>{force, 0})) reaction -= force;
  });
  if (w.is_dynamic(source)) list.add(source, {reaction, 0});
  add_wrenches(w, list);
}

template <class Real>
void apply_spring(BasicWorld<Real>& world, BodyId a, Vec2d point_a, BodyId b, Vec2d point_b,
                  const ElasticSpring& spring, double dt, LawOptions options) {
  require_not_negative("spring", "stiffness", spring.stiffness);
  require_not_negative("spring", "damping", spring.damping);
  require_not_negative("spring", "rest_length", spring.rest_length);
  require_finite("spring", "point_a", point_a);
  require_finite("spring", "point_b", point_b);
  if (a == b) {
    throw Error(Error::Kind::Value, "spring", "b", std::to_string(b.index),
                "must be another body than a: a spring pulls two ends");
  }
  require_positive("spring", "dt", dt);
  WorldData<Real>& w = unlocked_with_masses(world);
  const Vec2d point_on_a = world.world_point(a, point_a), point_on_b = world.world_point(b, point_b);
  const int body_a = static_cast<int>(a.index), body_b = static_cast<int>(b.index);
  const bool moves_a = w.is_dynamic(body_a), moves_b = w.is_dynamic(body_b);
  const bool awake = (moves_a && w.bodies[body_a].awake) || (moves_b && w.bodies[body_b].awake);
  if (!awake && !options.wakes) return;

  thread_local ElasticStep step;  // keeps its memory from call to call
  step.clear();
  const SpringEnd on_a = add_end(step, w, body_a, point_on_a, dt),
                  on_b = add_end(step, w, body_b, point_on_b, dt);
  const double inverse_mass = on_a.inverse_mass + on_b.inverse_mass;
  if (!(inverse_mass > 0)) return;
  // A spring does not know those that other calls add to its bodies: each is limited to what one step can
  // follow, omega dt = 1.
  const double stiffness = std::min(spring.stiffness, 1 / (inverse_mass * dt * dt));
  step.add({on_a.body, on_b.body, on_a.arm, on_b.arm, spring.rest_length, stiffness, spring.damping,
            spring.pulls_only});
  step.solve(dt);
  WrenchList list;
  if (moves_a) list.add(body_a, step.wrench(on_a.body));
  if (moves_b) list.add(body_b, step.wrench(on_b.body));
  add_wrenches(w, list);
}

#define PLUMB_INSTANTIATE(Real)                                                                             \
  template void apply_law(BasicWorld<Real>&, BodyLaw, LawOptions);                                          \
  template void apply_linear_drag(BasicWorld<Real>&, const LinearDragRates&, double, LawOptions);           \
  template void apply_quadratic_drag(BasicWorld<Real>&, double, double, LawOptions);                        \
  template void apply_attraction(BasicWorld<Real>&, Vec2d, const Attraction&, double, LawOptions);          \
  template void apply_attraction_to_body(BasicWorld<Real>&, BodyId, const Attraction&, double, LawOptions); \
  template void apply_spring(BasicWorld<Real>&, BodyId, Vec2d, BodyId, Vec2d, const ElasticSpring&, double, \
                             LawOptions);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
