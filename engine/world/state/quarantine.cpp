#include "engine/world/state/quarantine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/core/capacity.h"
#include "engine/core/text.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/world/state/bodies.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

bool is_in_range(double x) { return std::abs(x) <= kLargestNumber; }
bool is_in_range(Vec2d v) { return is_in_range(v.x) && is_in_range(v.y); }

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Replaces any NaN by one fixed NaN: sign and payload of NaNs differ between compilers.
double canonical_nan(double x) { return x == x ? x : std::numeric_limits<double>::quiet_NaN(); }

[[noreturn]] void report(const QuarantineEvent& why) {
  const std::string subject =
      "body " + (why.name.empty() ? std::to_string(why.body.index) : "'" + why.name + "'");
  const bool by_law = why.field == BadField::Force || why.field == BadField::Torque;
  throw Error(
      by_law ? Error::Kind::Value : Error::Kind::Run, subject, kBadFieldNames[static_cast<int>(why.field)],
      shortest(why.value),
      (by_law ? "is not finite or beyond 1e12 in step " : "is not finite or beyond 1e12 after step ") +
          std::to_string(why.step) +
          (by_law ? "; check what the law divides by"
                  : "; a force, a torque or a velocity is too large for this step"));
}

template <class Real>
void detach_joint(WorldData<Real>& w, JointRecord& joint) {
  if (has_quarantined_body(w, joint)) return;  // the joint stays inactive because of the other body
  if (joint.active) w.joint_set.set_active(joint.slot, false), joint.active = false;
  --w.bodies[joint.body_a].constraints, --w.bodies[joint.body_b].constraints;
  w.joint_set.reset(joint.slot);
}

template <class Real>
void reattach_joint(WorldData<Real>& w, JointRecord& joint) {
  if (has_quarantined_body(w, joint)) return;  // the joint stays inactive because of the other body
  ++w.bodies[joint.body_a].constraints, ++w.bodies[joint.body_b].constraints;
  const bool dynamic_a = w.is_dynamic(joint.body_a), dynamic_b = w.is_dynamic(joint.body_b);
  w.joint_set.set_dynamic(joint.slot, dynamic_a, dynamic_b, joint.active);
  w.joint_set.reset(joint.slot);
  wake_body(w, joint.body_a), wake_body(w, joint.body_b);
  if (!joint.active && (dynamic_a || dynamic_b))
    w.joint_set.set_active(joint.slot, true), joint.active = true;
}

// Removes a body from the simulation: until its release it is static, without contacts, joints and proxies.
template <class Real>
void remove_from_simulation(WorldData<Real>& w, int body, const QuarantineEvent& why) {
  ensure_capacity(w.quarantine, w.quarantine.size() + 1);
  QuarantinedBody entry{body, w.bodies[body].type, why};
  wake_neighbours(w, body);
  destroy_contacts_of(w, body);
  for_each_edge(w.joints, w.bodies[body].first_joint,
                [&](int, JointRecord& joint) { detach_joint(w, joint); });
  BodyRecord<Real>& record = w.bodies[body];
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) destroy_proxy(w, shape);
  if (record.awake) remove_awake(w, body);
  w.quarantine.push_back(std::move(entry));
  record.type = BodyType::Static;
  record.quarantined = true;
  w.motion[body].delta_position = {}, w.motion[body].delta_angle = 0;
  w.loads.reset(body, w.bodies.size());
  w.enlarged[body] = 0;
  w.topology_changed = true;
}

// Returns the field of a motion, or of the state to which it leads, that is not valid, with its value.
template <class Real>
std::pair<BadField, double> fault_of(const WorldData<Real>& w, int body) {
  const SolverBody<Real>& motion = w.motion[body];
  if (is_valid_motion(motion)) {
    const Vec2d end = w.position[body] + motion.delta_position.template as<double>();
    if (!is_in_range(end)) return {BadField::Position, is_in_range(end.x) ? end.y : end.x};
    return {BadField::Angle, w.bodies[body].angle + static_cast<double>(motion.delta_angle)};
  }
  for (const Real x :
       {motion.velocity.x, motion.velocity.y, motion.delta_position.x, motion.delta_position.y}) {
    if (!is_in_range(static_cast<double>(x))) return {BadField::Velocity, static_cast<double>(x)};
  }
  const bool spin = !is_in_range(static_cast<double>(motion.angular_velocity));
  return {BadField::AngularVelocity,
          static_cast<double>(spin ? motion.angular_velocity : motion.delta_angle)};
}

template <class Real>
bool is_in_range(const BodyVelocity<Real>& v) {
  return is_in_range(v.velocity.template as<double>()) &&
         is_in_range(static_cast<double>(v.angular_velocity));
}

template <class Real>
void set_rotation_from_angle(WorldData<Real>& w, int body) {
  const Rotation<double> q = rotation_of(w.bodies[body].angle);
  w.rotation[body] = {static_cast<Real>(q.c), static_cast<Real>(q.s)};
}

template <class Real>
void restore_start_state(WorldData<Real>& w, int body, const BodyVelocity<Real>& start) {
  SolverBody<Real>& motion = w.motion[body];
  const BodyVelocity<Real> valid_start = is_in_range(start) ? start : BodyVelocity<Real>{};
  motion.velocity = valid_start.velocity, motion.angular_velocity = valid_start.angular_velocity;
  motion.delta_position = {}, motion.delta_angle = 0;
  set_rotation_from_angle(w, body);
  w.bodies[body].sleep_time = 0;
  w.loads.reset(body, w.bodies.size());
  w.enlarged[body] = 0;
}

// Returns the velocity before the step of a body in free flight, which moved by the mean of this velocity and
// the present one.
template <class Real>
BodyVelocity<Real> velocity_before_flight(const SolverBody<Real>& motion, double dt) {
  const Vec2d before =
      (2 / dt) * motion.delta_position.template as<double>() - motion.velocity.template as<double>();
  const double spin =
      2 / dt * static_cast<double>(motion.delta_angle) - static_cast<double>(motion.angular_velocity);
  return {before.as<Real>(), static_cast<Real>(spin)};
}

// Resets static bodies, to which constraints pass non-finite values.
template <class Real>
void reset_static_bodies(WorldData<Real>& w) {
  for (int body = 0; body < w.bodies.size(); ++body) {
    if (!w.bodies.used(body) || w.bodies[body].type != BodyType::Static || w.bodies[body].quarantined)
      continue;
    w.motion[body] = {};
    set_rotation_from_angle(w, body);
  }
}

// Clears impulses of the body's contacts and joints, and updates separations, because these are not finite
// either.
template <class Real>
void clear_impulses(WorldData<Real>& w, int body) {
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int, const ContactRecord& contact) {
    if (contact.home != ContactHome::Graph && contact.home != ContactHome::Sleeping) return;
    ContactConstraint<Real>& c = constraint_of(w, contact);
    for (int i = 0; i < 2; ++i) {
      c.normal_impulse[i] = c.load_estimate[i] = c.max_normal_impulse[i] = c.approach[i] = 0;
      c.current_separation[i] = c.separation[i];
    }
    c.tangent_impulse = c.rolling_impulse = c.step_impulse = 0;
  });
  invalidate_manifolds(w, body);
  for_each_edge(w.joints, w.bodies[body].first_joint,
                [&](int, const JointRecord& joint) { w.joint_set.reset(joint.slot); });
}

// Moves a kinematic body by its given velocity, without contacts.
template <class Real>
void move_kinematic(WorldData<Real>& w, int body, double dt) {
  SolverBody<Real>& motion = w.motion[body];
  const Real t = static_cast<Real>(dt);
  motion.delta_position = t * motion.velocity, motion.delta_angle = t * motion.angular_velocity;
  w.position[body] += motion.delta_position.template as<double>();
  w.bodies[body].angle += static_cast<double>(motion.delta_angle);
  set_rotation_from_angle(w, body);
  const Real rotation_distance = std::abs(motion.delta_angle) * w.extents[body];
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next)
    update_proxy(w, shape, t, rotation_distance);
}

// A body with an invalid motion.
struct Fault {
  int body = 0;
  BadField field{};
  double value = 0;
  double speed = 0;          ///< m/s, before the step
  bool self_caused = false;  ///< no other body can have caused it
};

// Returns the bodies that caused a failure which constraints may have spread: those whose failure no other
// body can have caused, and those that were very fast before the step. If none was that fast, adds the
// fastest of the others.
std::vector<Fault> sources_of(const std::vector<Fault>& faults) {
  constexpr double kRunawaySpeed = 1e-3 * kLargestNumber;
  std::vector<Fault> sources;
  const Fault* fastest = nullptr;
  bool explained = false;
  for (const Fault& each : faults) {
    const bool ran_away = !each.self_caused && each.speed > kRunawaySpeed;
    explained = explained || ran_away;
    if (each.self_caused || ran_away) {
      sources.push_back(each);
    } else if (fastest == nullptr || each.speed > fastest->speed) {
      fastest = &each;
    }
  }
  if (!explained && fastest != nullptr) sources.push_back(*fastest);
  return sources;
}

}  // namespace

template <class Real>
BodyType own_type(const WorldData<Real>& w, int body) {
  if (!w.bodies[body].quarantined) return w.bodies[body].type;
  return std::find_if(w.quarantine.begin(), w.quarantine.end(),
                      [&](const QuarantinedBody& each) { return each.body == body; })
      ->type;
}

template <class Real>
QuarantinedBody& quarantine_of(WorldData<Real>& w, int body) {
  return *std::find_if(w.quarantine.begin(), w.quarantine.end(),
                       [&](const QuarantinedBody& each) { return each.body == body; });
}

template <class Real>
bool is_valid_motion(const SolverBody<Real>& motion) {
  return is_in_range(motion.velocity.template as<double>()) &&
         is_in_range(motion.delta_position.template as<double>()) &&
         is_in_range(static_cast<double>(motion.angular_velocity)) &&
         is_in_range(static_cast<double>(motion.delta_angle));
}

template <class Real>
bool stays_in_range(const WorldData<Real>& w, int body) {
  const SolverBody<Real>& motion = w.motion[body];
  return is_in_range(w.position[body] + motion.delta_position.template as<double>()) &&
         is_in_range(w.bodies[body].angle + static_cast<double>(motion.delta_angle));
}

template <class Real>
void quarantine_body(WorldData<Real>& w, int body, BadField field, double value) {
  if (w.bodies[body].quarantined) return;
  QuarantineEvent why{{static_cast<std::uint32_t>(body), w.bodies.generation(body)},
                      w.extras_of(body).name,
                      field,
                      canonical_nan(value),
                      w.steps + 1};
  if (!w.settings.quarantine) report(why);
  ensure_capacity(w.event_buffer().quarantined, w.event_buffer().quarantined.size() + 1);
  remove_from_simulation(w, body, why);
  // A body that is released and pushed beyond the limits again between two steps is reported once.
  std::vector<QuarantineEvent>& events = w.event_buffer().quarantined;
  if (!w.stepping) std::erase_if(events, [&](const QuarantineEvent& each) { return each.body == why.body; });
  events.push_back(std::move(why));
}

template <class Real>
void disable_body(WorldData<Real>& w, int body) {
  if (w.bodies[body].quarantined) return;
  remove_from_simulation(w, body,
                         {{static_cast<std::uint32_t>(body), w.bodies.generation(body)}, {}, BadField::None});
}

template <class Real>
void enable_body(WorldData<Real>& w, int body) {
  if (!w.bodies[body].quarantined || quarantine_of(w, body).why.field != BadField::None) return;
  release_body(w, body);
  wake_body(w, body);
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next)
    wake_touched(w, shape);
}

template <class Real>
void release_body(WorldData<Real>& w, int body) {
  BodyRecord<Real>& record = w.bodies[body];
  std::size_t shapes = 0;
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) ++shapes;
  w.tree_of(own_type(w, body)).reserve_more(shapes);
  ensure_capacity(w.move_buffer, w.move_buffer.size() + shapes);
  ensure_capacity(w.awake, w.awake.size() + 1);
  record.type = own_type(w, body);
  record.quarantined = false;
  std::erase_if(w.quarantine, [&](const QuarantinedBody& each) { return each.body == body; });
  w.topology_changed = true;  // its joints are active again, also those of a static body
  if (record.type == BodyType::Static) w.motion[body] = {};
  if (record.type != BodyType::Static) add_awake(w, body);
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) create_proxy(w, shape);
  w.enlarged[body] = 1;
  for_each_edge(w.joints, record.first_joint, [&](int, JointRecord& joint) { reattach_joint(w, joint); });
}

template <class Real>
void apply_body_impulse(WorldData<Real>& w, int body, Vec2d impulse, double angular_impulse) {
  SolverBody<Real>& motion = w.motion[body];
  const SolverBody<Real> before = motion;
  motion.apply(impulse.as<Real>(), static_cast<Real>(angular_impulse));
  if (!w.settings.quarantine || is_in_range(BodyVelocity<Real>{motion.velocity, motion.angular_velocity}))
    return;
  const auto [field, value] = fault_of(w, body);
  motion = before;
  quarantine_body(w, body, field, value);
}

template <class Real>
void quarantine_overloaded(WorldData<Real>& w, double dt) {
  std::vector<int>& overloaded = w.scratch.nonfinite_bodies;
  overloaded.clear();
  const auto velocity_change = [&](int body, const Load<Real>& load) -> std::pair<Vec2d, double> {
    const SolverBody<Real>& motion = w.motion[body];
    return {dt * static_cast<double>(motion.inverse_mass) * load.force.template as<double>(),
            dt * static_cast<double>(motion.inverse_inertia) * static_cast<double>(load.torque)};
  };
  for (const int body : w.awake) {
    const Load<Real> load = w.loads.get(body);
    if (load.force == Vec2<Real>{} && load.torque == 0) continue;
    const auto [velocity, spin] = velocity_change(body, load);
    if (!is_in_range(velocity) || !is_in_range(dt * velocity) || !is_in_range(spin) ||
        !is_in_range(dt * spin))
      overloaded.push_back(body);
  }
  for (const int body : overloaded) {
    const Load<Real> load = w.loads.get(body);
    const auto [velocity, spin] = velocity_change(body, load);
    if (!is_in_range(velocity.x) || !is_in_range(dt * velocity.x)) {
      quarantine_body(w, body, BadField::Velocity, velocity.x);
    } else if (!is_in_range(velocity.y) || !is_in_range(dt * velocity.y)) {
      quarantine_body(w, body, BadField::Velocity, velocity.y);
    } else {
      quarantine_body(w, body, BadField::AngularVelocity, spin);
    }
  }
}

template <class Real>
void quarantine_diverged(WorldData<Real>& w, double dt) {
  const std::vector<VelocityIncrement<Real>>& increments = w.scratch.solver.velocity_increments;
  std::vector<Fault> faults;
  bool shared = false;
  std::size_t next_increment = 0;  // both lists are in the order of `awake`
  for (const int body : w.scratch.nonfinite_bodies) {
    const int awake_index = w.bodies[body].awake_index;
    while (next_increment < increments.size() &&
           w.bodies[increments[next_increment].body].awake_index < awake_index)
      ++next_increment;
    const bool has_increment = next_increment < increments.size() && increments[next_increment].body == body;
    const SolverBody<Real> motion = w.motion[body];
    const auto [field, value] = fault_of(w, body);
    const BodyVelocity<Real> start = has_increment ? w.scratch.solver.start_velocities[next_increment]
                                                   : velocity_before_flight(motion, dt);
    restore_start_state(w, body, start);
    const bool self_caused = !has_increment || is_finite_motion(motion);
    shared = shared || !self_caused;
    if (!self_caused) clear_impulses(w, body);
    if (!self_caused && w.bodies[body].type == BodyType::Kinematic) {
      move_kinematic(w, body, dt);
      continue;
    }
    const double speed =
        is_in_range(start) ? std::sqrt(length_squared(start.velocity.template as<double>())) : kInfinity;
    faults.push_back({body, field, value, speed, self_caused});
  }
  if (shared) reset_static_bodies(w);
  w.topology_changed = true;
  for (const Fault& each : sources_of(faults)) quarantine_body(w, each.body, each.field, each.value);
}

#define PLUMB_FOR(Real)                                                   \
  template BodyType own_type(const WorldData<Real>&, int);                \
  template QuarantinedBody& quarantine_of(WorldData<Real>&, int);         \
  template bool is_valid_motion(const SolverBody<Real>&);                 \
  template bool stays_in_range(const WorldData<Real>&, int);              \
  template void apply_body_impulse(WorldData<Real>&, int, Vec2d, double); \
  template void quarantine_body(WorldData<Real>&, int, BadField, double); \
  template void release_body(WorldData<Real>&, int);                      \
  template void disable_body(WorldData<Real>&, int);                      \
  template void enable_body(WorldData<Real>&, int);                       \
  template void quarantine_overloaded(WorldData<Real>&, double);          \
  template void quarantine_diverged(WorldData<Real>&, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
