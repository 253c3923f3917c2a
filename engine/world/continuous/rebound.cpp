#include "engine/world/continuous/rebound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/distance/hull_distance.h"
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

// Returns true if only gravity acts on the body.
template <class Real>
bool is_free(const WorldData<Real>& w, int body, double dt) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.type != BodyType::Dynamic) return true;
  if (!record.awake || record.first_joint != kNone) return false;
  if (record.constraints == 0) return true;
  // Most contacts of a body that flies in a crowd are too far away to hold it, whatever its velocity.
  if (w.scratch.loaded[body] != kMayHold) return w.scratch.loaded[body] == 0;
  return !any_edge(w.contacts, record.first_contact, [&](const ContactRecord& contact) {
    if (contact.home != ContactHome::Graph) return false;
    const ContactConstraint<Real>& c = w.graph.at({contact.colour, contact.index});
    return has_held(w, c, static_cast<Real>(dt));
  });
}

// For constant acceleration the displacement is (v0 + v1) dt / 2. An acceleration below rounding error counts
// as zero.
template <class Real>
void note_parabola(const BodyMotion<Real>& motion, SweptBody& flight, double dt) {
  const Vec2d end = motion.velocity.template as<double>(), gain = 2 * (end - (1 / dt) * flight.way);
  const double rounding =
      8 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * (std::abs(end.x) + std::abs(end.y));
  if (std::abs(gain.x) + std::abs(gain.y) <= rounding) return;
  flight.gain = gain, flight.velocity = end - gain;
  flight.curve = (0.5 * dt) * gain, flight.way -= flight.curve;
}

// Saves the body state that is overwritten while testing an impact, and restores it if there is none.
template <class Real>
struct Kept {
  Kept(WorldData<Real>& world, const SweptBody* flight)
      : w(world), body(flight == nullptr ? kNone : flight->body) {
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
void place(WorldData<Real>& w, const SweptBody& flight, double fraction) {
  const Rotation<double> q = flight.rotation_at(fraction);
  w.position[flight.body] = flight.start_at(fraction);
  w.rotation[flight.body] = {static_cast<Real>(q.c), static_cast<Real>(q.s)};
}

template <class Real>
void set_velocity(WorldData<Real>& w, const SweptBody& flight, double fraction) {
  w.motion[flight.body].velocity = flight.velocity_at(fraction).template as<Real>();
  w.motion[flight.body].angular_velocity = static_cast<Real>(flight.angular_velocity);
}

// Returns a speed below which an approach may be rounding, m/s, because velocities after an impact and their
// arms are rounded. Points that have just separated must not count as approaching again.
template <class Real>
double speed_above_rounding(const WorldData<Real>& w, const ContactConstraint<Real>& c, int point) {
  const Real impulse = -c.approach[point] * c.mass[point];
  const auto of = [&](int body, Real arm, Real push) {
    const BodyMotion<Real>& motion = w.motion[body];
    const Vec2<Real> velocity = motion.velocity + (motion.inverse_mass * push) * c.normal;
    const Real spin = motion.angular_velocity + motion.inverse_inertia * arm * push;
    return std::abs(c.normal.x * velocity.x) + std::abs(c.normal.y * velocity.y) +
           std::abs(spin) * w.extents[body];
  };
  const Real speed = of(c.body_a, c.arm_a[point], -impulse) + of(c.body_b, c.arm_b[point], impulse);
  return static_cast<double>(8 * std::numeric_limits<Real>::epsilon() * speed);
}

enum class Throw { None, Slide, Bounce };  // None: no approach; Slide: none fast enough to bounce

// Resolves an impact of two bodies: Newton's law at the touching points, with friction. `left`: time in which
// separated points must not close, s; 0: such points have their own impacts.
template <class Real>
Throw throw_back(WorldData<Real>& w, ContactConstraint<Real>& c, bool may_bounce, Real dt, Real left) {
  ContactPair<Real> pair(w.motion.data(), c);
  const Real nearest = c.count == 2 ? std::min(c.separation[0], c.separation[1]) : c.separation[0];
  // Treat gaps due to rounding as touching: points whose impact times cannot be distinguished are resolved
  // together.
  const Real rounding =
      Real(64) * std::numeric_limits<Real>::epsilon() * (w.extents[c.body_a] + w.extents[c.body_b]);
  const Real threshold = bounce_threshold(w, static_cast<double>(dt));
  // A touching point that does not approach may still be pushed by the impulse at the other one.
  bool closed[2] = {}, strikes = false, fast = false;
  for (int i = 0; i < c.count; ++i) {
    c.normal_impulse[i] = c.peak_impulse[i] = 0;
    c.approach[i] = pair.normal_rate(i);
    closed[i] = c.separation[i] <= nearest + rounding;
    strikes = strikes || (closed[i] && c.approach[i] < 0);
    fast = fast || (closed[i] && c.approach[i] < -threshold);
  }
  if (!strikes) return Throw::None;
  fast = fast && may_bounce;
  double wanted[2] = {};
  for (int i = 0; i < c.count; ++i) {
    wanted[i] =
        std::max(fast ? -double(c.restitution) * double(c.approach[i]) : 0, speed_above_rounding(w, c, i));
    if (closed[i] || !(left > 0)) continue;
    // The point may close its gap in the time left, but no more.
    wanted[i] = -double(c.separation[i]) / double(left);
    closed[i] = true;
  }
  const ContactImpulses impulses = impact_of(pair.a, pair.b, c, closed, wanted);
  const Real first = static_cast<Real>(impulses.normal[0]), second = static_cast<Real>(impulses.normal[1]),
             friction = static_cast<Real>(impulses.friction);
  if (!std::isfinite(first) || !std::isfinite(second) || !std::isfinite(friction)) return Throw::None;
  c.tangent_impulse = c.rolling_impulse = 0;
  pair.push(first, second);
  pair.rub(friction);
  pair.resist_rolling();
  c.watched = Watch::Motion;
  pair.note_peaks();
  return fast ? Throw::Bounce : Throw::Slide;
}

// Reduces a contact to the shapes' nearest points, along its normal. For nearly parallel edges the manifold
// has the corners on both sides of the centre of mass, and may omit a corner between them that strikes first.
template <class Real>
void take_nearest_points(const WorldData<Real>& w, const ContactRecord& contact, ContactConstraint<Real>& c) {
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
void report(WorldData<Real>& w, const ContactRecord& contact, const ContactConstraint<Real>& c,
            bool thrown_apart) {
  const ContactReading reading = reading_of(w, contact, c);
  int id = kNone;
  // Grounds have long lists.
  const int listed = w.is_dynamic(contact.body_a) ? contact.body_a : contact.body_b;
  for_each_edge(w.contacts, w.bodies[listed].first_contact, [&](int edge, const ContactRecord& record) {
    if (record.shape_a == contact.shape_a && record.shape_b == contact.shape_b) id = edge / 2;
  });
  if (id != kNone && !thrown_apart) {
    set_touching(w, id, true);
    if (w.contacts[id].home == ContactHome::Graph) {
      ContactConstraint<Real>& held = constraint_of(w, w.contacts[id]);
      held.touching = true, held.watched = watch_of(w.contacts[id], held);
    }
  } else if (id == kNone || !w.contacts[id].touching) {
    w.log().begin.push_back({reading.shape_a, reading.shape_b});
    w.log().end.push_back({reading.shape_a, reading.shape_b});
  }
  const int hardest = c.count == 2 && c.approach[1] < c.approach[0] ? 1 : 0;
  if (!contact.hit_events || c.approach[hardest] > -least_hit_speed(w, c)) return;
  w.log().hits.push_back({reading.shape_a, reading.shape_b, reading.points[hardest], reading.normal,
                          -static_cast<double>(c.approach[hardest]),
                          static_cast<double>(c.normal_impulse[0] + c.normal_impulse[1])});
}

}  // namespace

template <class Real>
SweptBody flight_of(const WorldData<Real>& w, int body, double dt) {
  const BodyMotion<Real>& motion = w.motion[body];
  SweptBody flight;
  flight.body = body;
  flight.way = motion.moved.template as<double>();
  flight.start = flight.first = w.position[body] - flight.way;
  flight.turn = static_cast<double>(motion.turned);
  flight.velocity = motion.velocity.template as<double>();
  flight.angular_velocity = static_cast<double>(motion.angular_velocity);
  const Rotation<double> q{static_cast<double>(w.rotation[body].c), static_cast<double>(w.rotation[body].s)};
  const Rotation<double> back = rotation_of(-flight.turn);
  flight.rotation = {q.c * back.c - q.s * back.s, q.s * back.c + q.c * back.s};
  if (w.is_dynamic(body) && is_free(w, body, dt)) note_parabola(motion, flight, dt);
  return flight;
}

template <class Real>
bool may_rebound(const WorldData<Real>& w, int shape, int other, double dt) {
  const ShapeRecord<Real>&a = w.shapes[shape], &b = w.shapes[other];
  if (a.pre_solve || b.pre_solve) return false;
  // Without restitution two dynamic bodies move on together, which their contact handles at less cost.
  const bool both = w.is_dynamic(a.body) && w.is_dynamic(b.body);
  if (both && !(restitution_between(w, shape, other) > 0)) return false;
  return is_free(w, a.body, dt) && is_free(w, b.body, dt);
}

template <class Real>
bool rebound(WorldData<Real>& w, SweptBody& a, int shape, SweptBody* b, int other, double fraction, double dt,
             bool is_last) {
  Kept<Real> kept_a(w, &a), kept_b(w, b);
  place(w, a, fraction), set_velocity(w, a, fraction);
  if (b) place(w, *b, fraction), set_velocity(w, *b, fraction);
  const ContactRecord contact = contact_of(w, shape, other);
  ContactConstraint<Real> c = constraint_between(w, contact);
  // Ends a cascade of impacts that loses energy each time.
  const bool may_bounce = a.impacts < tuning::kBouncesInFlight || c.restitution == 1;
  const Real left = is_last ? static_cast<Real>((1 - fraction) * dt) : Real(0);
  Throw thrown = c.count > 0 ? throw_back(w, c, may_bounce, static_cast<Real>(dt), left) : Throw::None;
  if (thrown == Throw::None && c.count > 0) {
    take_nearest_points(w, contact, c);
    thrown = throw_back(w, c, may_bounce, static_cast<Real>(dt), left);
  }
  // Velocities beyond the range of numbers: the bodies stop here, and the next step's solver and quarantine
  // handle them.
  for (const int body : {contact.body_a, contact.body_b})
    if (w.is_dynamic(body) && !is_sound_motion(w.motion[body])) thrown = Throw::None;
  if (thrown != Throw::None) report(w, contact, c, thrown == Throw::Bounce && c.restitution > 0);
  const Vec2d normal = c.normal.template as<double>();
  const auto go_on = [&](SweptBody* flight, Kept<Real>& kept) {
    if (flight == nullptr || thrown == Throw::None || !w.is_dynamic(flight->body)) return kept.restore();
    const BodyMotion<Real>& motion = w.motion[flight->body];
    // The surface supports the body against the acceleration that presses it.
    if (thrown == Throw::Slide) {
      const double side = flight->body == contact.body_a ? 1 : -1;
      flight->gain -= (side * std::max(side * dot(flight->gain, normal), 0.0)) * normal;
    }
    flight->go_on(fraction, motion.velocity.template as<double>(),
                  static_cast<double>(motion.angular_velocity), dt);
  };
  go_on(&a, kept_a);
  go_on(b, kept_b);
  return thrown != Throw::None;
}

template <class Real>
void land(WorldData<Real>& w, const SweptBody& flight) {
  BodyMotion<Real>& motion = w.motion[flight.body];
  const double turned = flight.turned_before + flight.turn;
  w.bodies[flight.body].angle += turned - static_cast<double>(motion.turned);
  place(w, flight, 1);
  motion.moved = (w.position[flight.body] - flight.first).template as<Real>();
  motion.turned = static_cast<Real>(turned);
  if (flight.impacts == 0) return;
  motion.velocity = flight.velocity_at(1).template as<Real>();
  motion.angular_velocity = static_cast<Real>(flight.angular_velocity);
  // Recompute the sleep timer, which was updated with the velocity before the impact.
  BodyRecord<Real>& record = w.bodies[flight.body];
  if (!is_still(w, record, motion, w.extents[flight.body], Real(0))) record.sleep_time = 0;
}

#define PLUMB_FOR(Real)                                                                            \
  template SweptBody flight_of(const WorldData<Real>&, int, double);                               \
  template bool may_rebound(const WorldData<Real>&, int, int, double);                             \
  template bool rebound(WorldData<Real>&, SweptBody&, int, SweptBody*, int, double, double, bool); \
  template void land(WorldData<Real>&, const SweptBody&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
