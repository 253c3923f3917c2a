#include "engine/world/continuous/rebound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/distance/hull_distance.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_impact.h"
#include "engine/world/contact_solver/contact_rows.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/step/contact_reading.h"
#include "engine/world/step/expected_impacts.h"

namespace plumb {
namespace {

// Returns true if no joint, locked axis or loaded contact acts on the body.
template <class Real>
bool is_free(const WorldData<Real>& w, int body, double dt) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.type != BodyType::Dynamic) return true;
  if (!record.awake || record.first_joint != kNone || record.lock_x || record.lock_y) return false;
  if (record.constraints == 0) return true;
  // Most contacts of a body in a crowd are too far away to support it, whatever its velocity.
  if (w.scratch.narrow_phase.has_contact_load[body] != kMayHold)
    return w.scratch.narrow_phase.has_contact_load[body] == 0;
  return !any_edge(w.contacts, record.first_contact, [&](const ContactRecord& contact) {
    if (contact.home != ContactHome::Graph) return false;
    const ContactConstraint<Real>& c = w.graph.at({contact.colour, contact.index});
    return was_load_bearing(w, c, static_cast<Real>(dt));
  });
}

// Sets the parabola of a body under the acceleration by gravity and loads. It does not follow from the
// displacement: contacts that push overlaps apart displace bodies too, and an impact would take that motion
// of one of two bodies for an acceleration, which ends where it stops. Damped bodies, and the Euler schemes,
// move on another parabola, (v0 + v1) dt / 2, than their acceleration says; there the displacement tells it.
template <class Real>
void set_parabola(const WorldData<Real>& w, SweptBody& swept, double dt) {
  const VelocityIncrement<Real> increment = velocity_increment_of(w, swept.body, dt);
  const Vec2d end = w.motion[swept.body].velocity.template as<double>();
  const bool exact = increment.damping_factor == 1 && w.settings.integrator == Integrator::VelocityVerlet;
  const Vec2d gain =
      exact ? increment.velocity.template as<double>() : 2 * (end - (1 / dt) * swept.displacement);
  const double rounding =
      8 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * (std::abs(end.x) + std::abs(end.y));
  if (std::abs(gain.x) + std::abs(gain.y) <= rounding) return;
  swept.delta_velocity = gain, swept.velocity = end - gain;
  swept.curve = (0.5 * dt) * gain, swept.displacement -= swept.curve;
}

// Saves the body state that is overwritten while testing an impact, and restores it if there is none.
template <class Real>
struct SavedBodyState {
  SavedBodyState(WorldData<Real>& world, const SweptBody* swept)
      : w(world), body(swept == nullptr ? kNone : swept->body) {
    if (body == kNone) return;
    position = w.position[body], rotation = w.rotation[body];
    velocity = w.motion[body].velocity, spin = w.motion[body].angular_velocity;
  }
  void restore() {
    if (body == kNone) return;
    w.position[body] = position, w.rotation[body] = rotation;
    w.motion[body].velocity = velocity, w.motion[body].angular_velocity = spin;
  }
  WorldData<Real>& w;
  int body;
  Vec2d position{};
  Rotation<Real> rotation{};
  Vec2<Real> velocity{};
  Real spin = 0;
};

template <class Real>
void set_pose(WorldData<Real>& w, const SweptBody& swept, double fraction) {
  const Rotation<double> q = swept.rotation_at(fraction);
  w.position[swept.body] = swept.position_at(fraction);
  w.rotation[swept.body] = {static_cast<Real>(q.c), static_cast<Real>(q.s)};
}

template <class Real>
void set_velocity(WorldData<Real>& w, const SweptBody& swept, double fraction) {
  w.motion[swept.body].velocity = swept.velocity_at(fraction).template as<Real>();
  w.motion[swept.body].angular_velocity = static_cast<Real>(swept.angular_velocity);
}

// Returns the speed below which an approach may be rounding of the velocities and lever arms after an impact,
// m/s. Points that have just separated must not count as approaching again.
template <class Real>
double speed_above_rounding(const WorldData<Real>& w, const ContactConstraint<Real>& c, int point) {
  const Real impulse = -c.approach[point] * c.mass[point];
  const auto of = [&](int body, Real arm, Real push) {
    const SolverBody<Real>& motion = w.motion[body];
    const Vec2<Real> velocity = motion.velocity + (motion.inverse_mass * push) * c.normal;
    const Real spin = motion.angular_velocity + motion.inverse_inertia * arm * push;
    return std::abs(c.normal.x * velocity.x) + std::abs(c.normal.y * velocity.y) +
           std::abs(spin) * w.extents[body];
  };
  const Real speed = std::max(of(c.body_a, c.arm_a[point], -impulse), of(c.body_b, c.arm_b[point], impulse));
  return static_cast<double>(8 * std::numeric_limits<Real>::epsilon() * speed);
}

enum class ImpactResponse { None, Slide, Bounce };  // None: no approach; Slide: none fast enough to bounce

// Resolves an impact of two bodies: Newton's law at the touching points, with friction. `remaining_time`:
// time in which separated points must not close, s; 0: such points have their own impacts.
template <class Real>
ImpactResponse resolve_impact(WorldData<Real>& w, ContactConstraint<Real>& c, bool may_bounce, Real dt,
                              Real remaining_time) {
  ContactPair<Real> pair(w.motion.data(), c);
  const Real nearest = c.count == 2 ? std::min(c.separation[0], c.separation[1]) : c.separation[0];
  // Treat gaps due to rounding as touching: points whose impact times cannot be distinguished are resolved
  // together.
  const Real rounding =
      Real(64) * std::numeric_limits<Real>::epsilon() * (w.extents[c.body_a] + w.extents[c.body_b]);
  const Real threshold = bounce_threshold(w, static_cast<double>(dt));
  // A touching point that does not approach may still be pushed by the impulse at the other one.
  bool closed[2] = {}, approaches = false, fast = false;
  for (int i = 0; i < c.count; ++i) {
    c.normal_impulse[i] = c.max_normal_impulse[i] = 0;
    c.approach[i] = pair.normal_velocity(i);
    closed[i] = c.separation[i] <= std::max(nearest + rounding, Real(0));
    approaches = approaches || (closed[i] && c.approach[i] < 0);
    fast = fast || (closed[i] && c.approach[i] < -threshold);
  }
  if (!approaches) return ImpactResponse::None;
  fast = fast && may_bounce;
  double target_rate[2] = {};
  for (int i = 0; i < c.count; ++i) {
    target_rate[i] = std::max(fast ? -double(effective_restitution(c)) * double(c.approach[i]) : 0,
                              speed_above_rounding(w, c, i));
    if (closed[i] || !(remaining_time > 0)) continue;
    // The point may close its gap in the time left, but no more.
    target_rate[i] = -double(c.separation[i]) / double(remaining_time);
    closed[i] = true;
  }
  const ImpactImpulses impulses = solve_impact(pair.a, pair.b, c, closed, target_rate);
  const Real first = static_cast<Real>(impulses.normal[0]), second = static_cast<Real>(impulses.normal[1]),
             friction = static_cast<Real>(impulses.friction);
  if (!std::isfinite(first) || !std::isfinite(second) || !std::isfinite(friction))
    return ImpactResponse::None;
  if (impulses.jammed && !(first > 0 || second > 0)) return ImpactResponse::None;
  c.tangent_impulse = c.rolling_impulse = 0;
  if (impulses.jammed) {
    pair.apply_unrounded(impulses.normal, impulses.friction);
  } else {
    pair.apply_normal(first, second);
    pair.set_friction(friction);
  }
  pair.solve_rolling();
  c.tracking = ImpactTracking::Motion;
  pair.record_max_impulse();
  return fast ? ImpactResponse::Bounce : ImpactResponse::Slide;
}

// Takes from two bodies in contact (null: does not move) the accelerations that press them together along the
// normal, from `a` to `b`: a surface supports its body, and of two dynamic bodies each gets its part of the
// push.
template <class Real>
void share_push(const WorldData<Real>& w, SweptBody* a, SweptBody* b, Vec2d normal) {
  const auto inverse_mass = [&](const SweptBody* swept) {
    return swept == nullptr ? 0.0 : static_cast<double>(w.motion[swept->body].inverse_mass);
  };
  const auto gain = [](const SweptBody* swept) { return swept == nullptr ? Vec2d{} : swept->delta_velocity; };
  const double pressing = dot(gain(a) - gain(b), normal), sum = inverse_mass(a) + inverse_mass(b);
  if (!(pressing > 0) || !(sum > 0)) return;
  if (a != nullptr) a->delta_velocity -= (inverse_mass(a) / sum * pressing) * normal;
  if (b != nullptr) b->delta_velocity += (inverse_mass(b) / sum * pressing) * normal;
}

// Reduces a contact to the shapes' nearest points, along its normal. The manifold of nearly parallel edges
// has the outer corners, and may omit a corner between them that collides first.
template <class Real>
void reduce_to_nearest_points(const WorldData<Real>& w, const ContactRecord& contact,
                              ContactConstraint<Real>& c) {
  const auto rotation = [&](int body) -> Rotation<double> {
    return {static_cast<double>(w.rotation[body].c), static_cast<double>(w.rotation[body].s)};
  };
  const Convex<Real> a = w.convex(contact.shape_a), b = w.convex(contact.shape_b);
  const Rotation<double> to_a = rotation(contact.body_a).inverse(), q = rotation(contact.body_b);
  const Pose<double> b_in_a{to_a * (w.position[contact.body_b] - w.position[contact.body_a]),
                            {to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s}};
  const HullDistance nearest = hull_distance(a, b, b_in_a, nullptr);
  const double radius_a = static_cast<double>(a.radius),
               separation = nearest.separation - radius_a - static_cast<double>(b.radius);
  const Vec2d point = nearest.point_a + (radius_a + 0.5 * separation) * nearest.normal;
  ContactManifold<Real> manifold;
  manifold.normal = w.rotation[contact.body_a].inverse() * c.normal;
  manifold.count = 1;
  manifold.points[0] = {point.template as<Real>(), static_cast<Real>(separation), 0};
  prepare_contact(w, contact, manifold, c);
}

// Reports that the shapes touched. If they bounced, they are apart again at the end of the step; otherwise
// the next step decides (`update_nontouching`).
template <class Real>
void report_touch(WorldData<Real>& w, const ContactRecord& contact, const ContactConstraint<Real>& c,
                  bool bounced) {
  const ContactReading reading = reading_of(w, contact, c);
  int id = kNone;
  // Grounds have long lists.
  const int listed = w.is_dynamic(contact.body_a) ? contact.body_a : contact.body_b;
  for_each_edge(w.contacts, w.bodies[listed].first_contact, [&](int edge, const ContactRecord& record) {
    if (record.shape_a == contact.shape_a && record.shape_b == contact.shape_b) id = edge / 2;
  });
  if (id != kNone && !bounced) {
    set_touching(w, id, true);
    if (w.contacts[id].home == ContactHome::Graph) {
      ContactConstraint<Real>& held = constraint_of(w, w.contacts[id]);
      held.touching = true, held.tracking = tracking_of(w.contacts[id], held);
    }
  } else if (id == kNone || !w.contacts[id].touching) {
    w.event_buffer().begin.push_back({reading.shape_a, reading.shape_b});
    w.event_buffer().end.push_back({reading.shape_a, reading.shape_b});
  }
  const int hardest = c.count == 2 && c.approach[1] < c.approach[0] ? 1 : 0;
  if (!contact.hit_events || c.approach[hardest] > -min_hit_speed(w, c)) return;
  w.event_buffer().hits.push_back({reading.shape_a, reading.shape_b, reading.points[hardest], reading.normal,
                                   -static_cast<double>(c.approach[hardest]),
                                   static_cast<double>(c.normal_impulse[0] + c.normal_impulse[1])});
}

}  // namespace

template <class Real>
SweptBody swept_body_of(const WorldData<Real>& w, int body, double dt) {
  const SolverBody<Real>& motion = w.motion[body];
  SweptBody swept;
  swept.body = body;
  swept.displacement = motion.delta_position.template as<double>();
  swept.start = swept.step_start = w.position[body] - swept.displacement;
  swept.delta_angle = static_cast<double>(motion.delta_angle);
  swept.velocity = motion.velocity.template as<double>();
  swept.angular_velocity = static_cast<double>(motion.angular_velocity);
  const Rotation<double> q{static_cast<double>(w.rotation[body].c), static_cast<double>(w.rotation[body].s)};
  const Rotation<double> back = rotation_of(-swept.delta_angle);
  swept.rotation = {q.c * back.c - q.s * back.s, q.s * back.c + q.c * back.s};
  if (w.is_dynamic(body) && is_free(w, body, dt)) set_parabola(w, swept, dt);
  return swept;
}

template <class Real>
bool may_resolve_toi_impact(const WorldData<Real>& w, int shape, int other, double dt) {
  const ShapeRecord<Real>&a = w.shapes[shape], &b = w.shapes[other];
  if (!enabled(Switch::ImpactsInFlight)) return false;
  if (!enabled(Switch::Landings) && !(restitution_between(w, shape, other) > 0)) return false;
  if (stay_together(w, shape, other) && !are_alone(w, a.body, b.body, static_cast<Real>(dt))) return false;
  return is_free(w, a.body, dt) && is_free(w, b.body, dt);
}

template <class Real>
bool stay_together(const WorldData<Real>& w, int shape, int other) {
  return w.is_dynamic(w.shapes[shape].body) && w.is_dynamic(w.shapes[other].body) &&
         !(restitution_between(w, shape, other) > 0);
}

template <class Real>
ToiResponse resolve_toi_impact(WorldData<Real>& w, SweptBody& a, int shape, SweptBody* b, int other,
                               double fraction, double dt, bool is_last) {
  SavedBodyState<Real> saved_a(w, &a), saved_b(w, b);
  set_pose(w, a, fraction), set_velocity(w, a, fraction);
  if (b) set_pose(w, *b, fraction), set_velocity(w, *b, fraction);
  const ContactRecord contact = contact_of(w, shape, other);
  ContactConstraint<Real> c = constraint_between(w, contact);
  // Ends a cascade of impacts that loses energy each time.
  const bool may_bounce = a.impacts < tuning::kMaxBouncesPerStep || c.restitution == 1;
  const Real remaining_time = is_last ? static_cast<Real>((1 - fraction) * dt) : Real(0);
  ImpactResponse response = c.count > 0
                                ? resolve_impact(w, c, may_bounce, static_cast<Real>(dt), remaining_time)
                                : ImpactResponse::None;
  if (response == ImpactResponse::None && c.count > 0) {
    reduce_to_nearest_points(w, contact, c);
    response = resolve_impact(w, c, may_bounce, static_cast<Real>(dt), remaining_time);
  }
  // Between the impacts of bodies that stay together they may overlap a little.
  Real overlap = 0;
  if (c.count > 0 && stay_together(w, shape, other)) {
    overlap = std::max(-c.separation[0], Real(0));
    if (c.count == 2) overlap = std::max(overlap, -c.separation[1]);
    if (overlap > 0) overlap += rounding_overlap(w, contact.body_a, contact.body_b);
  }
  Real approach = 0;
  for (int i = 0; i < c.count; ++i)
    if (response != ImpactResponse::None && c.max_normal_impulse[i] > 0)
      approach = std::max(approach, -c.approach[i]);
  if (response == ImpactResponse::None && overlap > 0) response = ImpactResponse::Slide;
  // Velocities beyond the range of numbers: the bodies stop here, and the next step's solver and quarantine
  // handle them.
  for (const int body : {contact.body_a, contact.body_b})
    if (w.is_dynamic(body) && !is_valid_motion(w.motion[body])) response = ImpactResponse::None;
  if (response != ImpactResponse::None)
    report_touch(w, contact, c, response == ImpactResponse::Bounce && c.restitution > 0);
  const Vec2d normal = c.normal.template as<double>();
  if (response == ImpactResponse::Slide) {
    const bool in_order = a.body == contact.body_a;
    share_push(w, in_order ? &a : b, in_order ? b : &a, normal);
  }
  const auto continue_from = [&](SweptBody* swept, SavedBodyState<Real>& saved) {
    if (swept == nullptr || response == ImpactResponse::None || !w.is_dynamic(swept->body))
      return saved.restore();
    const SolverBody<Real>& motion = w.motion[swept->body];
    swept->continue_from(fraction, motion.velocity.template as<double>(),
                         static_cast<double>(motion.angular_velocity), dt);
    if (overlap > 0) {
      const Real inverse = w.motion[contact.body_a].inverse_mass + w.motion[contact.body_b].inverse_mass;
      const double side = swept->body == contact.body_a ? -1 : 1;
      const Vec2d out = (side * static_cast<double>(overlap * motion.inverse_mass / inverse)) * normal;
      const BodyLocks locks = w.bodies[swept->body].locks();
      if (!locks.x) swept->start.x += out.x;
      if (!locks.y) swept->start.y += out.y;
    }
  };
  continue_from(&a, saved_a);
  continue_from(b, saved_b);
  return {response != ImpactResponse::None, static_cast<double>(approach)};
}

template <class Real>
void commit_sweep(WorldData<Real>& w, const SweptBody& swept) {
  SolverBody<Real>& motion = w.motion[swept.body];
  const double turned = swept.delta_angle_before + swept.delta_angle;
  w.bodies[swept.body].angle += turned - static_cast<double>(motion.delta_angle);
  set_pose(w, swept, 1);
  motion.delta_position = (w.position[swept.body] - swept.step_start).template as<Real>();
  motion.delta_angle = static_cast<Real>(turned);
  if (swept.impacts == 0) return;
  motion.velocity = swept.velocity_at(1).template as<Real>();
  motion.angular_velocity = static_cast<Real>(swept.angular_velocity);
  // Recompute the sleep timer, which was updated with the velocity before the impact.
  BodyRecord<Real>& record = w.bodies[swept.body];
  if (!is_still(w, record, motion, w.extents[swept.body], Real(0))) record.sleep_time = 0;
}

#define PLUMB_FOR(Real)                                                                               \
  template SweptBody swept_body_of(const WorldData<Real>&, int, double);                              \
  template bool may_resolve_toi_impact(const WorldData<Real>&, int, int, double);                     \
  template bool stay_together(const WorldData<Real>&, int, int);                                      \
  template ToiResponse resolve_toi_impact(WorldData<Real>&, SweptBody&, int, SweptBody*, int, double, \
                                          double, bool);                                              \
  template void commit_sweep(WorldData<Real>&, const SweptBody&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
